// Whether a mesh runs through itself.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "base/frames.h"
#include "mesh/signed_distance.h"

namespace swarf::mesh {

struct Crossings {
  size_t pairs = 0;  ///< of facets that cross or overlap
  uint32_t first = 0, second = 0;
  Vec3 place = Vec3::Zero();  ///< a corner of the first pair's first facet, mm
};

/// Pairs of facets of which an edge of one passes through the other, or which lie in one plane and overlap:
/// facets that only touch (a common corner or edge, a corner on a face) do not count. Positions
/// are rounded to about 1e-10 of the largest coordinate; with that the signs of all determinants are exact
/// (double with its error bound, then 113 bits).
/// Parallel; the same result for any number of threads.
Crossings find_crossings(const SignedDistance& mesh);
/// Of the pairs of which `asked` says true alone. `tree`: of the mesh, whose vertices are welded or not.
Crossings find_crossings(const TriMesh& mesh, const MeshDistance& tree,
                         const std::function<bool(uint32_t, uint32_t)>& asked);

/// All pairs of facets that have a place in common, if only a corner (the lesser number first, ascending),
/// and some that nearly have, among those of which `asked` says true. `tree`: of the mesh, whose vertices are
/// welded or not. Positions are rounded as above.
std::vector<std::array<uint32_t, 2>> touching_pairs(const TriMesh& mesh, const MeshDistance& tree,
                                                    const std::function<bool(uint32_t, uint32_t)>& asked);

/// Whether the edge p-q passes from one side of (a, b, c) to the other, through its inside or border.
bool edge_crosses(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace swarf::mesh
