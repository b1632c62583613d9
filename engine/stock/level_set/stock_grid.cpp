#include <algorithm>
#include <cmath>
#include <memory>

#include "base/parallel.h"
#include "stock/level_set/lane_kernel.h"
#include "stock/level_set/leaf_kernel.h"
#include "stock/level_set/stock_grid_internal.h"

namespace openvdb {
OPENVDB_USE_VERSION_NAMESPACE
namespace OPENVDB_VERSION_NAME {
template class Grid<FloatTree>;
namespace tree {
template class Tree<FloatTree::RootNodeType>;
}
}  // namespace OPENVDB_VERSION_NAME
}  // namespace openvdb

namespace swarf::stock {
namespace {

constexpr size_t kLeavesPerTask = 512;

/// Euclidean signed distance to the box.
double box_distance(const Box& box, const Vec3& point) {
  const Vec3 q = (point - box.centre()).cwiseAbs() - 0.5 * box.size();
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

/// Beside one face the distance is the greatest of those beyond the faces: the root of a square that was
/// rounded is the number itself, so these are the bits of the formula for all leaves.
void fill_beside_face(float* values, const double (&q)[3][kLeafSide], float band) {
  for (int i = 0; i < kLeafSide; ++i)
    for (int j = 0; j < kLeafSide; ++j) {
      const double across = std::max(q[0][i], q[1][j]);
      for (int k = 0; k < kLeafSide; ++k)
        *values++ = std::clamp(static_cast<float>(std::max(across, q[2][k])), -band, band);
    }
}

void fill_leaf(LeafNode& leaf, const Box& box, double voxel, float band) {
  float* values = leaf.buffer().data();
  const Vec3 centre = box.centre(), half = 0.5 * box.size();
  double q[3][kLeafSide];  // distance beyond the box's faces, by axis
  for (int a = 0; a < 3; ++a) {
    for (int i = 0; i < kLeafSide; ++i) {
      q[a][i] = std::abs((leaf.origin()[a] + i) * voxel - centre[a]) - half[a];
    }
  }
  const auto is_beyond = [&](const double(&beyond)[kLeafSide]) {
    return std::max(beyond[0], beyond[kLeafSide - 1]) > 0.0;  // greatest at one of its ends
  };
  if (is_beyond(q[0]) + is_beyond(q[1]) + is_beyond(q[2]) <= 1) {
    fill_beside_face(values, q, band);
    return;
  }
  for (int n = 0; n < kLeafVoxels; ++n) {
    const double x = q[0][n / 64], y = q[1][n / 8 % 8], z = q[2][n % 8];
    const double inside = std::min(std::max({x, y, z}), 0.0);
    const double ox = std::max(x, 0.0), oy = std::max(y, 0.0), oz = std::max(z, 0.0);
    const double distance = std::sqrt(ox * ox + oy * oy + oz * oz) + inside;
    values[n] = std::clamp(static_cast<float>(distance), -band, band);
  }
}

/// The state of one leaf position of a fresh box; a leaf is handed over in `made`.
LeafState box_leaf(const LevelSet& set, size_t index, std::unique_ptr<LeafNode>& made) {
  if (!set.owns(index)) return LeafState::kAir;
  const double centre = box_distance(set.box, set.leaf_centre(index));
  const double reach = set.leaf_radius() + set.band();
  if (std::abs(centre) > reach) return centre < 0.0 ? LeafState::kSolid : LeafState::kAir;
  made = std::make_unique<LeafNode>(set.map.origin(index), 0.0F, false);
  fill_leaf(*made, set.box, set.voxel, set.band());
  const LeafState state = settle_leaf(*made, set.band());
  if (state != LeafState::kLeaf) made.reset();
  return state;
}

void take_leaves(LevelSet& set, MadeLeaves& made) {
  for (size_t n = 0; n < made.leaves.size(); ++n) {
    if (!made.leaves[n]) continue;
    set.map.leaves[made.begin + n] = made.leaves[n].get();
    set.grid->tree().addLeaf(made.leaves[n].release());
  }
}

/// Solid at a voxel that belongs to no leaf.
bool is_solid(const LevelSet& set, const openvdb::Coord& voxel) {
  const openvdb::Coord place = (voxel >> 3) - set.map.lower;
  const bool known = openvdb::CoordBBox({0, 0, 0}, set.map.dimension.offsetBy(-1)).isInside(place);
  return known && set.map.states[set.map.index(place.x(), place.y(), place.z())] == LeafState::kSolid;
}

/// The tree between its leaves: a node without leaves below it is all air or all solid.
void sign_tiles(LevelSet& set) {
  using Node = openvdb::FloatTree::RootNodeType::ChildNodeType;
  auto& tree = set.grid->tree();
  const openvdb::Coord lower = openvdb::Coord(set.map.lower) << 3,
                       upper = lower + (openvdb::Coord(set.map.dimension) << 3).offsetBy(-1);
  const openvdb::Coord first = lower & ~(static_cast<int>(Node::DIM) - 1);
  for (int i = first.x(); i <= upper.x(); i += Node::DIM)
    for (int j = first.y(); j <= upper.y(); j += Node::DIM)
      for (int k = first.z(); k <= upper.z(); k += Node::DIM)
        if (tree.probeConstNode<Node>({i, j, k}) == nullptr && is_solid(set, {i, j, k}))
          tree.addTile(Node::LEVEL + 1, {i, j, k}, -set.band(), false);
  auto tile = tree.beginValueAll();
  tile.setMaxDepth(openvdb::FloatTree::ValueAllIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) tile.setValue(is_solid(set, tile.getCoord()) ? -set.band() : set.band());
}

/// Where the tiles of others are left out, a node without leaves may be solid in part: position by position.
void sign_positions(LevelSet& set) {
  constexpr openvdb::Index kLeafLevel = 1;  // a tile that replaces one leaf
  openvdb::tree::ValueAccessor<openvdb::FloatTree> near(set.grid->tree());
  for (size_t n = 0; n < set.map.size(); ++n) {
    if (set.map.states[n] == LeafState::kLeaf) continue;
    const float value = set.map.states[n] == LeafState::kSolid ? -set.band() : set.band();
    const openvdb::Coord origin = set.map.origin(n);
    if (near.getValue(origin) != value) near.addTile(kLeafLevel, origin, value, false);
  }
}

int leaf_floor(double voxels) {
  return static_cast<int>(std::floor(voxels / kLeafSide));
}

}  // namespace

openvdb::Coord LeafMap::origin(size_t index) const {
  const auto k = static_cast<int>(index % dimension.z());
  const auto j = static_cast<int>(index / dimension.z() % dimension.y());
  const auto i = static_cast<int>(index / dimension.z() / dimension.y());
  return {(lower.x() + i) * kLeafSide, (lower.y() + j) * kLeafSide, (lower.z() + k) * kLeafSide};
}

void LeafMap::lower_top(size_t index) {
  uint32_t& top = tops[column(index)];
  const LeafState* const states_of_column =
      states.data() + column(index) * static_cast<size_t>(dimension.z());
  while (top > 0 && states_of_column[top - 1] == LeafState::kAir) --top;
}

void LeafMap::raise_top(size_t index) {
  uint32_t& top = tops[column(index)];
  top = std::max(top, static_cast<uint32_t>(index % static_cast<size_t>(dimension.z())) + 1);
}

Vec3 LevelSet::leaf_centre(size_t index) const {
  const openvdb::Coord origin = map.origin(index);
  const double half = 0.5 * (kLeafSide - 1);
  return Vec3(origin.x() + half, origin.y() + half, origin.z() + half) * voxel;
}

double LevelSet::leaf_radius() const {
  return std::sqrt(3.0) * 0.5 * (kLeafSide - 1) * voxel;
}

float LevelSet::value(const openvdb::Coord& ijk) const {
  const int i = (ijk.x() >> 3) - map.lower.x(), j = (ijk.y() >> 3) - map.lower.y(),
            k = (ijk.z() >> 3) - map.lower.z();
  const bool known =
      i >= 0 && j >= 0 && k >= 0 && i < map.dimension.x() && j < map.dimension.y() && k < map.dimension.z();
  if (!known) return band();
  const size_t index = map.index(i, j, k);
  if (map.states[index] != LeafState::kLeaf) {
    return map.states[index] == LeafState::kSolid ? -band() : band();
  }
  return values(index)[LeafNode::coordToOffset(ijk)];
}

LeafMap map_extent(const Box& box, double voxel) {
  LeafMap map;
  const double margin = kBandVoxels + 1.0;  // beyond the band all is air
  openvdb::Coord upper;
  for (int a = 0; a < 3; ++a) {
    map.lower[a] = leaf_floor(box.lower[a] / voxel - margin);
    upper[a] = leaf_floor(box.upper[a] / voxel + margin);
    map.dimension[a] = upper[a] - map.lower[a] + 1;
  }
  return map;
}

LeafMap empty_map(const Box& box, double voxel) {
  LeafMap map = map_extent(box, voxel);
  const size_t count = static_cast<size_t>(map.dimension.x()) * map.dimension.y() * map.dimension.z();
  map.states.assign(count, LeafState::kAir);
  map.leaves.assign(count, nullptr);
  map.floors.assign(count, {static_cast<float>(-kBandVoxels * voxel), {}});
  map.cuts.assign(count, 0);
  map.marks.assign(count, 0);
  map.tops.assign(static_cast<size_t>(map.dimension.x()) * map.dimension.y() + kLanes,
                  static_cast<uint32_t>(map.dimension.z()));
  return map;
}

openvdb::FloatGrid::Ptr empty_grid(double voxel) {
  static const bool initialised = (openvdb::initialize(), true);
  static_cast<void>(initialised);
  auto grid = openvdb::FloatGrid::create(static_cast<float>(kBandVoxels * voxel));
  grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  grid->setName("stock");
  return grid;
}

LeafState settle_leaf(LeafNode& leaf, float band) {
  static const LeafSummary summary = leaf_kernel_variants().front().summary;
  uint64_t active[kLeafVoxels / 64];
  const LeafRange range = summary(leaf.buffer().data(), band, active);
  for (int word = 0; word < kLeafVoxels / 64; ++word) {
    leaf.getValueMask().getWord<openvdb::Index64>(word) = active[word];
  }
  return range.least >= band       ? LeafState::kAir
         : range.greatest <= -band ? LeafState::kSolid
                                   : LeafState::kLeaf;
}

void fill_map(LevelSet& set, const std::function<void(int, int, MadeLeaves&)>& fill) {
  const int planes = set.map.dimension.x();
  for (int first = 0; first < planes; first += kPlanesAtOnce) {
    const int last = std::min(first + kPlanesAtOnce, planes);
    MadeLeaves made{set.map.index(first, 0, 0), {}};
    made.leaves.resize(set.map.index(last, 0, 0) - made.begin);
    fill(first, last, made);
    take_leaves(set, made);
    if (set.spilled) make_room(set, {});
  }
  for (size_t column = 0; column < set.map.size(); column += static_cast<size_t>(set.map.dimension.z()))
    set.map.lower_top(column);
  sign_tiles(set);
  if (!set.others.empty()) sign_positions(set);
}

LevelSet make_box(const Box& box, double voxel, const TileSet& own, const Spill* spill) {
  LevelSet set;
  set.box = box;
  set.raw = RawShape::of_box(box);
  set.voxel = voxel;
  set.grid = empty_grid(voxel);
  set.map = empty_map(box, voxel);
  keep_columns(set, own);
  if (spill != nullptr) begin_spill(set, *spill);
  fill_map(set, [&](int, int, MadeLeaves& made) {
    parallel_chunks(made.leaves.size(), kLeavesPerTask, [&](size_t begin, size_t end) {
      for (size_t n = made.begin + begin; n < made.begin + end; ++n)
        set.map.states[n] = box_leaf(set, n, made.at(n));
    });
  });
  return set;
}

}  // namespace swarf::stock
