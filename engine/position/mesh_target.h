// Where a tool comes to rest on a triangle mesh, exactly.
#pragma once

#include "mesh/tri_mesh.h"
#include "position/rest.h"
#include "position/sphere_tree.h"
#include "position/tool_profile.h"

namespace swarf::position {

/// The mesh as it is: its facets, edges and vertices, not the smooth surface that they may stand for. Facets
/// stop a tool from both sides (triangle_rest.h).
///
/// Rest::number: kFace: the triangle; kEdge: 3 triangle + the place of the corner at which the side starts;
/// kVertex: 3 triangle + the place of the corner. Of triangles that meet there one.
class MeshTarget {
 public:
  /// Throws as SphereTree. An empty mesh stops no tool.
  explicit MeshTarget(const TriMesh& mesh) : tree_(mesh) {}

  /// Raises `best` to where the mesh stops the tool, if that is higher. `near`: what was touched last, as
  /// this mesh counts it, -1 none: asked first, since what cannot be higher is left out. It is set where the
  /// mesh raises `best`. The height is the same bits whatever `near` is; of several contacts at the same
  /// height the one found first stays, so the contact may depend on it, and is the same for the same call.
  /// Allocates nothing; may be called from several threads.
  void raise(const ToolProfile& profile, const GuideLine& line, Rest& best, int& near) const;

  const SphereTree& tree() const { return tree_; }

 private:
  SphereTree tree_;
};

}  // namespace swarf::position
