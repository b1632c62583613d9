#include "stock/stock.h"

#include <algorithm>
#include <utility>

#include "base/check.h"
#include "stock/level_set/leaf_kernel.h"
#include "stock/level_set/stock_grid_internal.h"

namespace swarf::stock {

namespace {

/// Of LeafMap, for each leaf position.
constexpr size_t kMapBytes = sizeof(LeafState) + sizeof(LeafNode*) + sizeof(LeafFloor) +
                             sizeof(decltype(LeafMap::cuts)::value_type) +
                             sizeof(decltype(LeafMap::marks)::value_type);

}  // namespace

Stock::Stock(const Box& box_W, double voxel_mm) {
  SWARF_CHECK(voxel_mm > 0.0 && box_W.size().minCoeff() > 0.0, "a stock needs a voxel size and a volume");
  impl_ = std::make_unique<Impl>(Impl{make_box(box_W, voxel_mm)});
}
Stock::Stock(const RawShape& raw, double voxel_mm, const Spill* spill) {
  SWARF_CHECK(voxel_mm > 0.0 && raw.box().size().minCoeff() > 0.0, "a stock needs a voxel size and a volume");
  impl_ = std::make_unique<Impl>(Impl{make_raw(raw, voxel_mm, {}, spill)});
}
Stock::Stock(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Stock::~Stock() = default;
Stock::Stock(Stock&&) noexcept = default;
Stock& Stock::operator=(Stock&&) noexcept = default;

void Stock::cut(std::span<const Sweep> sweeps, const CutterSolid& cutter) {
  impl_->hash.reset();
  cut_level_set(impl_->level_set, sweeps, cutter);
}

void Stock::begin_spill(const Spill& spill) {
  stock::begin_spill(impl_->level_set, spill);
}
bool Stock::spills() const {
  return impl_->level_set.spilled != nullptr;
}
TileGrid Stock::tiles_of(const Box& box_W, double voxel_mm) {
  return stock::tiles_of(map_extent(box_W, voxel_mm), voxel_mm);
}
void Stock::make_room(std::span<const uint32_t> next_use) {
  stock::make_room(impl_->level_set, next_use);
}
size_t Stock::leaves_on_disk() const {
  return spills() ? impl_->level_set.spilled->file.slots() : 0;
}

double Stock::voxel_mm() const {
  return impl_->level_set.voxel;
}
const Box& Stock::box() const {
  return impl_->level_set.box;
}
const RawShape& Stock::raw() const {
  SWARF_CHECK(impl_->level_set.raw.has_value(), "the raw stock of a file without its shape is not known");
  return *impl_->level_set.raw;
}
double Stock::volume_mm3() const {
  const LevelSet& set = impl_->level_set;
  return sum_of(set, volumes(set, 0, set.map.size()));
}
VolumeRange Stock::volume_between(double slack_mm) const {
  const LevelSet& set = impl_->level_set;
  return sum_of(set, volume_ranges(set, slack_mm, 0, set.map.size()));
}
double Stock::rounding_mm() const {
  return impl_->level_set.rounding_mm;
}
double Stock::distance_mm(const Vec3& point_W) const {
  return trilinear(impl_->level_set, point_W);
}
const LevelSet& Stock::level_set() const {
  return impl_->level_set;
}
uint64_t Stock::hash() const {
  if (!impl_->hash) impl_->hash = state_hash(impl_->level_set);
  return *impl_->hash;
}
size_t Stock::memory_bytes() const {
  return impl_->level_set.grid->memUsage() + impl_->level_set.map.size() * kMapBytes;
}
const CutStatistics& Stock::statistics() const {
  return impl_->level_set.statistics;
}
std::string Stock::check(CheckLevel level) const {
  return broken_invariant(impl_->level_set, level);
}
std::string Stock::check_since(const Stock& earlier) const {
  return gained_material(impl_->level_set, earlier.impl_->level_set);
}
Stock Stock::clone() const {
  return Stock(std::make_unique<Impl>(Impl{deep_copy(impl_->level_set)}));
}

void Stock::save(const std::string& path, const StockMetadata& metadata) const {
  write_level_set(impl_->level_set, path, metadata);
}
Stock Stock::load(const std::string& path, StockMetadata* metadata, const RawShape* raw) {
  StockMetadata found;
  Stock stock(std::make_unique<Impl>(Impl{read_level_set(path, found)}));
  if (raw != nullptr) stock.impl_->level_set.raw = *raw;
  if (metadata != nullptr) *metadata = std::move(found);
  return stock;
}

double Stock::air_radius_mm(const Vec3& point_W) const {
  return air_radius(impl_->level_set, point_W);
}

std::vector<Vec3> Stock::air_points(double below_mm) const {
  return stock::air_points(impl_->level_set, below_mm);
}

size_t Stock::leaves() const {
  return impl_->level_set.grid->tree().leafCount();
}

size_t Stock::memory_for(const Box& box_W, double voxel_mm, double leaves) {
  constexpr double kLeafBytes = 2200.0;             // 512 floats, mask, node; measured 2168 per leaf
  constexpr double kTransient = sizeof(LeafNode*);  // per position while the box is made
  constexpr double kPositionBytes = kMapBytes + kTransient;
  const double positions = (box_W.size() / (kLeafSide * voxel_mm) + Vec3::Constant(2.0)).prod();
  constexpr double kEverything = 1e18;  // what is more has no number of bytes
  return static_cast<size_t>(std::min(leaves * kLeafBytes + positions * kPositionBytes, kEverything));
}

size_t Stock::memory_estimate(const Box& box_W, double voxel_mm) {
  return memory_estimate(RawShape::of_box(box_W), voxel_mm);
}

size_t Stock::memory_estimate(const RawShape& raw, double voxel_mm) {
  // A surface element is met by leaves of (8 voxel)^2 face area; the band is 6 voxels thick, so a leaf
  // position along the surface's normal is touched with probability (8 + 6) / 8.
  constexpr double kLayers = (kLeafSide + 2.0 * kBandVoxels) / kLeafSide;
  const double leaf_mm = kLeafSide * voxel_mm;
  // Edges and corners are met by more leaves than their share of the faces, and the tree has inner nodes.
  constexpr double kRest = 1.3;
  const double leaves = kLayers * raw.area_mm2() / (leaf_mm * leaf_mm);
  return static_cast<size_t>(kRest * static_cast<double>(memory_for(raw.box(), voxel_mm, leaves)));
}

}  // namespace swarf::stock
