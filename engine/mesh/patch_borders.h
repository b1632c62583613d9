// Where the patches of a mesh meet whose creases are split (split_creases). Internal to this folder.
#pragma once

#include <cstdint>
#include <vector>

#include "base/frames.h"
#include "mesh/tri_mesh.h"

namespace swarf::mesh {

/// By vertex. A patch are triangles that share vertices.
struct PatchBorders {
  std::vector<uint32_t> welded;    ///< the first vertex at the same position
  std::vector<uint8_t> on_crease;  ///< another vertex has the same position
  /// From the vertex into its patch, perpendicular to the borders there and as far as from each of them; zero
  /// inside of a patch, mm.
  std::vector<Vec3> inset;
};

/// `inset_mm`: length of the insets.
PatchBorders patch_borders(const TriMesh& mesh, double inset_mm);

/// Of the side of a triangle, whichever way it runs.
inline uint64_t side_key(uint32_t a, uint32_t b) {
  return uint64_t{a < b ? a : b} << 32 | (a < b ? b : a);
}

}  // namespace swarf::mesh
