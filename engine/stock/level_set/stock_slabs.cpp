#include "stock/stock_slabs.h"

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include "stock/level_set/leaf_kernel.h"
#include "stock/level_set/stock_grid_internal.h"

namespace swarf::stock {
namespace {

/// Some planes of a stock, without a tree: to look at.
struct Planes {
  LevelSet set;
  std::unique_ptr<float[]>
      values;  ///< of all leaves, in one piece: making leaves takes longer than reading them
};

constexpr size_t kShrinking = 4;  // how much smaller the last slabs are

void add_planes(const LevelSet& set, int first, int last, BytesWriter& out) {
  const LeafMap& map = set.map;
  const size_t begin = map.index(first, 0, 0), end = map.index(last, 0, 0);
  out.add(set.voxel);
  out.add(set.rounding_mm);
  for (const int n : {map.lower.x() + first, map.lower.y(), map.lower.z()}) out.add(n);
  for (const int n : {last - first, map.dimension.y(), map.dimension.z()}) out.add(n);
  out.add_all(std::span(map.states).subspan(begin, end - begin));
  for (size_t n = begin; n < end; ++n)
    if (map.states[n] == LeafState::kLeaf) out.add_all(std::span<const float>(set.values(n), kLeafVoxels));
}

Planes take_planes(BytesReader& in) {
  Planes planes;
  LevelSet& set = planes.set;
  set.voxel = in.get<double>();
  set.rounding_mm = in.get<double>();
  for (int a = 0; a < 3; ++a) set.map.lower[a] = in.get<int>();
  for (int a = 0; a < 3; ++a) set.map.dimension[a] = in.get<int>();
  const size_t count = set.map.index(set.map.dimension.x(), 0, 0);
  set.map.states.resize(count);
  in.get_all(std::span(set.map.states));
  set.lent.assign(count, nullptr);
  const auto leaves = static_cast<size_t>(std::ranges::count(set.map.states, LeafState::kLeaf));
  planes.values = std::make_unique_for_overwrite<float[]>(leaves * kLeafVoxels);
  const std::span values(planes.values.get(), leaves * kLeafVoxels);
  in.get_all(values);
  const float* next = values.data();
  for (size_t n = 0; n < count; ++n) {
    if (set.map.states[n] != LeafState::kLeaf) continue;
    set.lent[n] = next;
    next += kLeafVoxels;
  }
  return planes;
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

void SlabProofs::add_request(size_t slab, BytesWriter& out) const {
  const LevelSet& set = stock_.level_set();
  const Slab& own = slabs_[slab];
  const int first = std::max(own.first - 1, 0), last = std::min(own.last + 1, set.map.dimension.x());
  out.add(slack_mm_);
  out.add(own.first - first);
  out.add(own.last - first);
  add_planes(set, first, last, out);
}

Bytes prove_slab(BytesReader& in) {
  const auto slack_mm = in.get<double>();
  const int first = in.get<int>(), last = in.get<int>();
  const Planes planes = take_planes(in);
  const LevelSet& set = planes.set;
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
