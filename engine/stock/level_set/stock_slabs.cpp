#include "stock/stock_slabs.h"

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include "base/check.h"
#include "stock/level_set/leaf_kernel.h"
#include "stock/level_set/stock_grid_internal.h"

namespace swarf::stock {
namespace {

constexpr size_t kShrinking = 4;  // how much smaller the last slabs are

/// Of planes of a map, by column, x before y: 1 where the tiles are held.
std::vector<uint8_t> held_columns(const LeafMap& map, int first, int last, const TileSet& held) {
  std::vector<uint8_t> columns;
  for (int i = map.lower.x() + first; i < map.lower.x() + last; ++i)
    for (int j = map.lower.y(); j < map.lower.y() + map.dimension.y(); ++j)
      columns.push_back(held.holds_column(i, j) ? 1 : 0);
  return columns;
}

/// Planes [first, last); leaves of columns that are held without their values.
void add_planes(const LevelSet& set, int first, int last, const TileSet& held, BytesWriter& out) {
  const LeafMap& map = set.map;
  const size_t begin = map.index(first, 0, 0), end = map.index(last, 0, 0);
  const std::vector<uint8_t> columns = held_columns(map, first, last, held);
  const auto is_sent = [&](size_t n) {
    return map.states[n] == LeafState::kLeaf && columns[map.column(n - begin)] == 0;
  };
  size_t sent = 0;
  for (size_t n = begin; n < end; ++n) sent += is_sent(n) ? 1 : 0;
  constexpr size_t kHead = 256;  // bytes, for what is neither by position nor by column
  out.reserve(kHead + columns.size() + (end - begin) + sent * kLeafVoxels * sizeof(float));
  out.add(set.voxel);
  out.add(set.rounding_mm);
  for (const int n : {map.lower.x() + first, map.lower.y(), map.lower.z()}) out.add(n);
  for (const int n : {last - first, map.dimension.y(), map.dimension.z()}) out.add(n);
  out.add_all(std::span(columns));
  out.add_all(std::span(map.states).subspan(begin, end - begin));
  out.align<float>();
  for (size_t n = begin; n < end; ++n)
    if (is_sent(n)) out.add_all(std::span<const float>(set.values(n), kLeafVoxels));
}

/// To look at, without a tree: values stand in the message and in `own`, which must outlive it.
LevelSet take_planes(BytesReader& in, const LevelSet& own) {
  LevelSet set;
  set.voxel = in.get<double>();
  set.rounding_mm = in.get<double>();
  for (int a = 0; a < 3; ++a) set.map.lower[a] = in.get<int>();
  for (int a = 0; a < 3; ++a) set.map.dimension[a] = in.get<int>();
  const size_t count = set.map.index(set.map.dimension.x(), 0, 0);
  const auto held = in.look_at<uint8_t>(count / static_cast<size_t>(set.map.dimension.z()));
  set.map.states.resize(count);
  in.get_all(std::span(set.map.states));
  set.lent.assign(count, nullptr);
  const size_t own_begin = own.map.index(set.map.lower.x() - own.map.lower.x(), 0, 0);
  for (size_t n = 0; n < count; ++n) {
    if (set.map.states[n] != LeafState::kLeaf) continue;
    if (held[set.map.column(n)] == 0) {
      set.lent[n] = in.look_at<float>(kLeafVoxels).data();
      continue;
    }
    SWARF_CHECK(own.map.states.at(own_begin + n) == LeafState::kLeaf, "what is held is what it is held for");
    set.lent[n] = own.values(own_begin + n);
  }
  return set;
}

}  // namespace

SlabProofs::SlabProofs(const Stock& stock, double slack_mm, size_t slabs)
    : stock_(stock), slack_mm_(slack_mm), volumes_(stock.level_set().map.size()), ranges_(volumes_.size()) {
  const LeafMap& map = stock.level_set().map;
  const auto leaves_of = [&](int plane) {
    const auto begin = map.states.begin() + static_cast<ptrdiff_t>(begin_of(plane));
    const auto end = map.states.begin() + static_cast<ptrdiff_t>(begin_of(plane + 1));
    return static_cast<size_t>(std::count(begin, end, LeafState::kLeaf));
  };
  const size_t all = stock.leaves(), usual = all / std::max<size_t>(1, slabs);
  size_t before = 0, leaves = 0;  // in the slabs before this one, in this one
  slabs_.push_back({0, 0, ""});
  for (int plane = 0; plane < map.dimension.x(); ++plane) {
    // Who takes the last ones is waited for: the last quarter is dealt out in ever smaller ones.
    const size_t each =
        std::clamp(kShrinking * (all - before) / std::max<size_t>(1, slabs), usual / kShrinking, usual);
    if (leaves >= std::max<size_t>(1, each)) {
      slabs_.push_back({plane, plane, ""});
      before += std::exchange(leaves, 0);
    }
    leaves += leaves_of(plane);
    slabs_.back().last = plane + 1;
  }
}

size_t SlabProofs::begin_of(int plane) const {
  return stock_.level_set().map.index(plane, 0, 0);
}

void SlabProofs::add_request(size_t slab, const TileSet& held, BytesWriter& out) const {
  const LevelSet& set = stock_.level_set();
  const Slab& own = slabs_[slab];
  const int first = std::max(own.first - 1, 0), last = std::min(own.last + 1, set.map.dimension.x());
  out.add(slack_mm_);
  out.add(own.first - first);
  out.add(own.last - first);
  add_planes(set, first, last, held, out);
}

Bytes SlabProofs::answer(BytesReader& in, const Stock& own) {
  const auto slack_mm = in.get<double>();
  const int first = in.get<int>(), last = in.get<int>();
  const LevelSet set = take_planes(in, own.level_set());
  const size_t begin = set.map.index(first, 0, 0), end = set.map.index(last, 0, 0);
  BytesWriter out;
  out.add_list(volumes(set, begin, end));
  out.add_list(volume_ranges(set, slack_mm, begin, end));
  out.add_text(broken_step(set, begin, end));
  return out.take();
}

void SlabProofs::take(size_t slab, const Bytes& answer) {
  BytesReader in(answer);
  const auto begin = static_cast<ptrdiff_t>(begin_of(slabs_[slab].first));
  std::ranges::copy(in.get_list<double>(), volumes_.begin() + begin);
  std::ranges::copy(in.get_list<VolumeRange>(), ranges_.begin() + begin);
  slabs_[slab].broken_step = in.get_text();
}

void SlabProofs::prove(size_t slab) {
  const LevelSet& set = stock_.level_set();
  const size_t begin = begin_of(slabs_[slab].first), end = begin_of(slabs_[slab].last);
  const auto to = static_cast<ptrdiff_t>(begin);
  std::ranges::copy(volumes(set, begin, end), volumes_.begin() + to);
  std::ranges::copy(volume_ranges(set, slack_mm_, begin, end), ranges_.begin() + to);
  slabs_[slab].broken_step = broken_step(set, begin, end);
}

StockProof SlabProofs::result() const {
  const LevelSet& set = stock_.level_set();
  StockProof proof{sum_of(set, volumes_), sum_of(set, ranges_), ""};
  for (const Slab& slab : slabs_)
    if (proof.broken_step.empty()) proof.broken_step = slab.broken_step;
  return proof;
}

}  // namespace swarf::stock
