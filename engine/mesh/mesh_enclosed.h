// What of a mesh nobody sees from outside: facets within its own bodies.
#pragma once

#include <cstdint>
#include <vector>

#include "base/frames.h"
#include "mesh/tri_mesh.h"

namespace swarf::mesh {

struct Enclosed {
  std::vector<uint8_t> facets;  ///< per triangle: 1 where it lies within another shell
  std::vector<Box> around;      ///< of the shells that enclose any, mm
};

/// Facets that lie wholly within another shell of the mesh which is closed and evenly oriented: screws as far
/// as they are sunk, the foot of a rib in the casting. A facet lies within a shell when it touches none of
/// its facets (exact, see mesh_crossing.h) and the shell winds around it.
///
/// Shells of more than 16 000 facets neither enclose anything here nor are looked for in others.
///
/// From a place around which no such shell winds, as any outside the boxes `around`, they are never seen: on
/// the way to one the shell's outside is met first. If that place of the shell lies within another, that
/// one's outside is nearer still; at the nearest a facet is met that lies within none. So the mesh without
/// them looks the same, with or without the backs of facets, and casts the same shadow. Only by a section, or
/// to an eye within a body, do they show.
/// Parallel; the same for any number of threads.
Enclosed find_enclosed(const TriMesh& mesh);

}  // namespace swarf::mesh
