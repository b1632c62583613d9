// The connected shells that a mesh consists of.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/frames.h"
#include "mesh/mesh_check.h"

namespace swarf::mesh {

/// Facets that hang together by edges which exactly two of them share.
struct Shell {
  std::vector<uint32_t> facets;  ///< of the welded mesh, ascending; at least one
  Box box;                       ///< mm
};

/// In the order of their first facets. `across`: facets_across() of the mesh.
std::vector<Shell> shells_of(const WeldedMesh& mesh, const std::vector<uint32_t>& across);

std::array<Vec3, 3> corners_of(const WeldedMesh& mesh, uint32_t facet);

/// Borders count.
bool holds(const Box& box, const Vec3& p);

/// How often the shell winds around a point, by its solid angle there (van Oosterom & Strackee 1983): 1
/// inside a body, -1 inside a cavity, 0 outside; any number of a shell that is open.
double winding(const WeldedMesh& mesh, const Shell& shell, const Vec3& p);

}  // namespace swarf::mesh
