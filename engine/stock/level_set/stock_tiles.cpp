#include "stock/stock_tiles.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <span>

#include "base/check.h"
#include "stock/level_set/leaf_kernel.h"
#include "stock/level_set/stock_grid_internal.h"

namespace swarf::stock {
namespace {

int tile_floor(int leaf) {
  return (leaf >= 0 ? leaf : leaf - kTileLeaves + 1) / kTileLeaves;
}

/// Tiles of one rank go on by so many from row to row: coprime to the number of ranks, so that rows and
/// columns of tiles both hold every rank equally often; near its golden section, so that they do not line up.
int row_step(int count) {
  constexpr double kGolden = 1.618033988749895;
  int step = std::max(1, static_cast<int>(std::lround(count / kGolden)));
  while (std::gcd(step, count) != 1) ++step;
  return step;
}

/// Of all columns of the map, x before y: 1 where the tiles are not of the set.
std::vector<uint8_t> columns_of_others(const LevelSet& set, const TileSet& own) {
  const LeafMap& map = set.map;
  std::vector<uint8_t> others;
  for (int i = map.lower.x(); i < map.lower.x() + map.dimension.x(); ++i)
    for (int j = map.lower.y(); j < map.lower.y() + map.dimension.y(); ++j)
      others.push_back(own.holds_column(i, j) ? 0 : 1);
  return others;
}

/// `in`: where its values stand.
void set_leaf(LevelSet& set, size_t leaf, BytesReader& in) {
  LeafNode* node = set.map.leaves[leaf];
  if (node == nullptr) {
    auto made = std::make_unique<LeafNode>(set.map.origin(leaf), set.band(), false);
    node = set.map.leaves[leaf] = made.get();
    set.grid->tree().addLeaf(made.release());
  }
  set.forget_spilled(leaf);
  in.get_all(std::span<float>(node->buffer().data(), kLeafVoxels));
  SWARF_CHECK(settle_leaf(*node, set.band()) == LeafState::kLeaf, "a leaf that was sent is one");
}

void set_tile(LevelSet& set, size_t leaf, LeafState state) {
  constexpr openvdb::Index kLeafLevel = 1;  // a tile that replaces one leaf
  const float value = state == LeafState::kSolid ? -set.band() : set.band();
  set.forget_spilled(leaf);
  set.grid->tree().addTile(kLeafLevel, set.map.origin(leaf), value, false);
  set.map.leaves[leaf] = nullptr;
}

/// What is told of a position before its values; without gaps between its members.
struct ToldPosition {
  uint64_t leaf;
  LeafFloor floor;
  uint32_t cuts;
  uint32_t state;  ///< LeafState
};
static_assert(sizeof(ToldPosition) == sizeof(uint64_t) + sizeof(LeafFloor) + 2 * sizeof(uint32_t));

void add_position(const LevelSet& set, size_t leaf, BytesWriter& out) {
  const LeafMap& map = set.map;
  out.add(ToldPosition{leaf, map.floors[leaf], map.cuts[leaf], static_cast<uint32_t>(map.states[leaf])});
  if (map.states[leaf] == LeafState::kLeaf)
    out.add_all(std::span<const float>(set.values(leaf), kLeafVoxels));
}

/// The floor that holds of every leaf. One that lies lower at the centre and rises to a side says more.
bool is_as_loaded(const LeafFloor& floor, float band) {
  return floor.value == -band && std::ranges::all_of(floor.slope, [](float rise) { return rise == 0.0F; });
}

/// One piece is told while the one before is taken over: the first is waited for.
constexpr size_t kToldBytes = size_t{2} << 20U;
/// With the position that goes beyond.
constexpr size_t kMostTold =
    kToldBytes + sizeof(ToldPosition) + static_cast<size_t>(kLeafVoxels) * sizeof(float);

void add_counts(const CutStatistics& counts, double rounding_mm, BytesWriter& out) {
  out.add(counts);
  out.add(rounding_mm);
}

/// Leaves of columns that are another's from now on.
void drop_leaves(LevelSet& set, const std::vector<uint8_t>& others) {
  for (size_t n = 0; n < set.map.size(); ++n) {
    if (set.map.states[n] != LeafState::kLeaf || others[set.map.column(n)] == 0) continue;
    set_tile(set, n, LeafState::kAir);
    set.map.states[n] = LeafState::kAir;
  }
}

}  // namespace

int owner_of_column(int i, int j, int count) {
  const int turn = (tile_floor(i) + row_step(count) * (tile_floor(j) % count)) % count;
  return turn < 0 ? turn + count : turn;
}

/// Of the tiles of one owner in a row along x every count-th is one: they are numbered through, and shifted
/// from row to row.
int part_of_column(int i, int j, int count) {
  constexpr int kShift = 3;
  const int tile = tile_floor(i);
  const int number = (tile >= 0 ? tile : tile - count + 1) / count;
  return ((number + kShift * tile_floor(j)) % kTileParts + kTileParts) % kTileParts;
}

bool TileSet::all() const {
  return std::ranges::all_of(parts, [](uint32_t of_share) { return of_share == kAllParts; });
}

bool TileSet::holds_column(int i, int j) const {
  const auto count = static_cast<int>(parts.size());
  const uint32_t of_share = parts[static_cast<size_t>(owner_of_column(i, j, count))];
  return (of_share >> static_cast<unsigned>(part_of_column(i, j, count)) & 1U) != 0;
}

TileSet TileSet::others() const {
  TileSet rest = *this;
  for (uint32_t& of_share : rest.parts) of_share ^= kAllParts;
  return rest;
}

void keep_columns(LevelSet& set, const TileSet& own) {
  set.others = own.all() ? std::vector<uint8_t>{} : columns_of_others(set, own);
}

Stock StockTiles::own_tiles(const RawShape& raw, double voxel_mm, const TileSet& own) {
  return Stock(std::make_unique<Stock::Impl>(Stock::Impl{make_raw(raw, voxel_mm, own)}));
}

StockTiles::StockTiles(Stock& stock, const TileSet& own)
    : stock_(stock), known_(stock.level_set().map.cuts), told_(stock.statistics()) {
  keep_columns(stock.impl_->level_set, own);
}

std::optional<Bytes> StockTiles::next_changes() {
  return next_of(nullptr);
}

std::optional<Bytes> StockTiles::next_left(const TileSet& kept) {
  LevelSet& set = stock_.impl_->level_set;
  std::vector<uint8_t> others = columns_of_others(set, kept);
  if (auto piece = next_of(&others)) return piece;
  stock_.impl_->hash.reset();
  drop_leaves(set, others);
  set.others = std::move(others);
  return std::nullopt;
}

/// `wanted`: of columns, if given, those that are told; 1 by column.
std::optional<Bytes> StockTiles::next_of(const std::vector<uint8_t>* wanted) {
  const LevelSet& set = stock_.level_set();
  BytesWriter out;
  out.reserve(kMostTold);
  CutStatistics more = set.statistics;
  more.voxel_updates -= told_.voxel_updates;
  more.leaf_visits -= told_.leaf_visits;
  add_counts(more, set.rounding_mm, out);
  const bool counted = more.voxel_updates != 0;
  const size_t counts = out.size();
  told_ = set.statistics;
  while (next_ < set.map.size() && out.size() < kToldBytes) {
    const size_t column = set.map.column(next_),
                 end = (column + 1) * static_cast<size_t>(set.map.dimension.z());
    if (!set.owns(next_) || (wanted != nullptr && (*wanted)[column] == 0)) next_ = end;
    for (; next_ < end; ++next_) {
      // Who cuts on must know as much: a cut that changed no value may have raised the floor.
      const bool seen = wanted != nullptr && !is_as_loaded(set.map.floors[next_], set.band());
      if (set.map.cuts[next_] == known_[next_] && !seen) continue;
      add_position(set, next_, out);
      known_[next_] = set.map.cuts[next_];
    }
  }
  if (counted || out.size() > counts) return out.take();
  next_ = 0;
  return std::nullopt;
}

std::optional<Bytes> StockTiles::next_tiles(const Stock& stock, const TileSet& tiles, size_t& from) {
  const LevelSet& set = stock.level_set();
  const std::vector<uint8_t> others = columns_of_others(set, tiles);
  BytesWriter out;
  out.reserve(kMostTold);
  add_counts({}, set.rounding_mm, out);
  const size_t counts = out.size();
  for (; from < set.map.size() && out.size() < kToldBytes; ++from)
    if (others[set.map.column(from)] == 0) add_position(set, from, out);
  return out.size() > counts ? std::optional(out.take()) : std::nullopt;
}

void StockTiles::apply(std::span<const std::byte> changes) {
  stock_.impl_->hash.reset();
  LevelSet& set = stock_.impl_->level_set;
  CutStatistics& statistics = set.statistics;
  BytesReader in(changes);
  const auto more = in.get<CutStatistics>();
  statistics.sweeps = std::max(statistics.sweeps, more.sweeps);
  statistics.voxel_updates += more.voxel_updates;
  statistics.leaf_visits += more.leaf_visits;
  statistics.seconds = std::max(statistics.seconds, more.seconds);
  told_.voxel_updates += more.voxel_updates;
  told_.leaf_visits += more.leaf_visits;
  set.rounding_mm = std::max(set.rounding_mm, in.get<double>());
  while (!in.at_end()) take_position(in);
}

void StockTiles::count_as(const CutStatistics& counts) {
  stock_.impl_->level_set.statistics = counts;
}

void StockTiles::take_position(BytesReader& in) {
  LevelSet& set = stock_.impl_->level_set;
  const auto told = in.get<ToldPosition>();
  const size_t leaf = told.leaf;
  SWARF_CHECK(leaf < set.map.size(), "positions of one map");
  const auto state = static_cast<LeafState>(told.state);
  set.map.floors[leaf] = told.floor;
  known_[leaf] = set.map.cuts[leaf] = told.cuts;
  if (state == LeafState::kLeaf) {
    set_leaf(set, leaf, in);
  } else if (state != set.map.states[leaf]) {
    set_tile(set, leaf, state);
  }
  set.map.states[leaf] = state;
  if (state != LeafState::kAir) set.map.raise_top(leaf);
}

}  // namespace swarf::stock
