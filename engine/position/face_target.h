// Where a tool comes to rest on the trimmed faces of CAD files (theory 3).
//
// Over what the loops enclose, the height f that the places ask for is greatest where its derivative
// vanishes, which the patches' cells find and prove, or on a loop. So the loops are asked first, as edges; a
// cell that they cross is then left out where f rises all over it in one direction, and halved otherwise
// until its pieces lie on one side of them or cannot be higher.
#pragma once

#include <vector>

#include "position/face_edges.h"
#include "position/mesh_target.h"
#include "position/part.h"
#include "position/patch_target.h"

namespace swarf::position {

/// Faces that stop a tool from both sides. Adjoining faces leave no gap between them but that of their edges.
///
/// Heights are within kPatchProof_mm below the truth of faces whose loops are moved as face_edges.h says.
/// Rest::number: the face; kEdge and kVertex: on a loop, or on the border of the square.
class FaceTarget {
 public:
  /// Throws as PatchTarget and face_edges().
  explicit FaceTarget(const std::vector<surface::Face>& faces, const CellOptions& options = {});

  /// Raises `best`, as PatchTarget and MeshTarget do; `near.triangle` counts edges.
  void raise(const ToolProfile& profile, const GuideLine& line, Rest& best, Near& near,
             PatchWork& work) const;

  const PatchTarget& patches() const { return patches_; }
  size_t edges() const { return spans_.size(); }

 private:
  FaceTarget(const std::vector<surface::Face>& faces, FaceEdges edges, const CellOptions& options);

  PatchTarget patches_;
  MeshTarget edges_;
  std::vector<EdgeSpan> spans_;
};

/// Faces as patches with their domains.
std::vector<Patch> patches_of(const std::vector<surface::Face>& faces);

}  // namespace swarf::position
