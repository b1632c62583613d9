// Whether the bodies of a mesh lie in each other as material and cavities do.
#pragma once

#include <optional>
#include <string>

#include "base/diagnostics.h"
#include "base/frames.h"
#include "mesh/tri_mesh.h"

namespace swarf::mesh {

/// A connected shell that does not belong where it lies.
struct MisplacedBody {
  Vec3 place = Vec3::Zero();  ///< on it, mm
  double volume_mm3 = 0.0;    ///< that it encloses; negative: it is turned inward, like a cavity
  int around = 0;             ///< how many bodies (less cavities) enclose it
};

/// The first shell of a closed, evenly oriented mesh that breaks the rule by which the surface bounds a
/// solid: outside it the mesh must wind zero times around, inside once. So a shell turned outward lies in no
/// other body (or in its cavity), one turned inward in exactly one. The winding of all other shells around a
/// point in the middle of the shell's largest facet is the sum of their solid angles (van Oosterom & Strackee
/// 1983). Bodies that touch there are let pass; shells must not cross. Parallel; the same for any number of
/// threads.
std::optional<MisplacedBody> find_misplaced_body(const TriMesh& mesh);

/// The same as an error "mesh-nested-bodies" of file `path`. `name`: what the text calls the mesh.
void check_bodies(const TriMesh& mesh, const std::string& path, Diagnostics& diagnostics,
                  const std::string& name);

/// An error "mesh-bodies-overlap" where shells run through each other, or lie flat against each other: faces
/// between them are none of the solid. Closed meshes. Parallel, as find_crossings().
void check_apart(const TriMesh& mesh, const std::string& path, Diagnostics& diagnostics,
                 const std::string& name);

}  // namespace swarf::mesh
