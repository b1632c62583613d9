// The level set of any raw stock: its exact distance at every grid point of the band. Where the middle of a
// cube of leaf positions lies farther from the surface than the cube and the band reach, all of it is air or
// solid: a distance is 1-Lipschitz.
#include <algorithm>
#include <cmath>
#include <memory>

#include "base/check.h"
#include "base/parallel.h"
#include "stock/level_set/leaf_kernel.h"
#include "stock/level_set/stock_grid_internal.h"

namespace swarf::stock {
namespace {

constexpr int kBlockLeaves = kPlanesAtOnce;  // leaf positions along a side of such a cube

/// Cubes of leaf positions that cover some planes of the map, z fastest.
struct LeafBlocks {
  int plane, count[2];

  LeafBlocks(const LeafMap& map, int first_plane) : plane(first_plane) {
    for (int a = 0; a < 2; ++a) count[a] = (map.dimension[a + 1] + kBlockLeaves - 1) / kBlockLeaves;
  }
  size_t size() const { return static_cast<size_t>(count[0]) * count[1]; }
  openvdb::Coord first(size_t block) const {
    return {plane, static_cast<int>(block / count[1]) * kBlockLeaves,
            static_cast<int>(block % count[1]) * kBlockLeaves};
  }
};

/// Rows back and forth, so that each point lies beside the one before: how far that one was from the surface
/// tells how far to look.
void fill_raw_leaf(LeafNode& leaf, const LevelSet& set) {
  float* values = leaf.buffer().data();
  const double h = set.voxel;
  const openvdb::Coord& origin = leaf.origin();
  double before = std::numeric_limits<double>::infinity();
  for (int row = 0; row < kLeafSide * kLeafSide; ++row) {
    const int i = row / kLeafSide, j = i % 2 == 0 ? row % kLeafSide : kLeafSide - 1 - row % kLeafSide;
    for (int step = 0; step < kLeafSide; ++step) {
      const int k = row % 2 == 0 ? step : kLeafSide - 1 - step;
      const Vec3 point = h * Vec3(origin.x() + i, origin.y() + j, origin.z() + k);
      constexpr double kSlack = 1e-6;  // mm: of the rounding of both
      before = std::abs(before) + h + kSlack;
      const double within = before;
      before = set.raw->at(point, within).distance_mm;
      SWARF_CHECK(std::isfinite(before), "a distance changes by no more than the way");
      values[i * 64 + j * 8 + k] = std::clamp(static_cast<float>(before), -set.band(), set.band());
    }
  }
}

LeafState raw_leaf(const LevelSet& set, size_t index, std::unique_ptr<LeafNode>& made) {
  const double reach = set.leaf_radius() + set.band();
  const double centre = set.raw->distance_mm(set.leaf_centre(index));
  if (std::abs(centre) > reach) return centre < 0.0 ? LeafState::kSolid : LeafState::kAir;
  made = std::make_unique<LeafNode>(set.map.origin(index), 0.0F, false);
  fill_raw_leaf(*made, set);
  const LeafState state = settle_leaf(*made, set.band());
  if (state != LeafState::kLeaf) made.reset();
  return state;
}

void fill_block(LevelSet& set, const openvdb::Coord& first, MadeLeaves& made) {
  const LeafMap& map = set.map;
  const double side = kBlockLeaves * kLeafSide;
  const Vec3 low =
      kLeafSide * Vec3(map.lower.x() + first.x(), map.lower.y() + first.y(), map.lower.z() + first.z());
  const double centre = set.raw->distance_mm(set.voxel * (low + Vec3::Constant(0.5 * (side - 1.0))));
  const double reach = 0.5 * std::sqrt(3.0) * (side - 1.0) * set.voxel + set.band();
  for (int i = first.x(); i < std::min(first.x() + kBlockLeaves, map.dimension.x()); ++i)
    for (int j = first.y(); j < std::min(first.y() + kBlockLeaves, map.dimension.y()); ++j)
      for (int k = first.z(); k < std::min(first.z() + kBlockLeaves, map.dimension.z()); ++k) {
        const size_t n = map.index(i, j, k);
        if (!set.owns(n)) {
          set.map.states[n] = LeafState::kAir;
        } else if (std::abs(centre) > reach) {
          set.map.states[n] = centre < 0.0 ? LeafState::kSolid : LeafState::kAir;
        } else {
          set.map.states[n] = raw_leaf(set, n, made.at(n));
        }
      }
}

}  // namespace

LevelSet make_raw(const RawShape& raw, double voxel, const TileSet& own, const Spill* spill) {
  if (raw.is_box()) return make_box(raw.box(), voxel, own, spill);
  LevelSet set;
  set.box = raw.box();
  set.raw = raw;
  set.voxel = voxel;
  set.grid = empty_grid(voxel);
  set.map = empty_map(set.box, voxel);
  keep_columns(set, own);
  if (spill != nullptr) begin_spill(set, *spill);
  fill_map(set, [&](int first, int, MadeLeaves& made) {
    const LeafBlocks blocks(set.map, first);
    parallel_chunks(blocks.size(), 1, [&](size_t begin, size_t end) {
      for (size_t b = begin; b < end; ++b) fill_block(set, blocks.first(b), made);
    });
  });
  return set;
}

}  // namespace swarf::stock
