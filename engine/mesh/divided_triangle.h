// A triangle whose sides carry vertices, as triangles. Internal to this folder.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/tri_mesh.h"

namespace swarf::mesh {

/// `on[k]`: vertices on the side from corner k to the next, in that order. At each step the ear is cut whose
/// diagonal joins the most equal values (TriMesh::deviation_um up to +-`saturates`), the shortest of several:
/// strips between places of equal values stay strips.
std::vector<std::array<uint32_t, 3>> divided_triangle(const TriMesh& mesh,
                                                      const std::array<uint32_t, 3>& corners,
                                                      const std::array<std::vector<uint32_t>, 3>& on,
                                                      double saturates);

}  // namespace swarf::mesh
