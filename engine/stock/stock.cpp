#include "stock/stock.h"

#include <utility>

#include "base/check.h"
#include "stock/stock_grid_internal.h"

namespace swarf::stock {

struct Stock::Impl {
  LevelSet level_set;
};

Stock::Stock(const Box& box_W, double voxel_mm) {
  SWARF_CHECK(voxel_mm > 0.0 && box_W.size().minCoeff() > 0.0, "a stock needs a voxel size and a volume");
  impl_ = std::make_unique<Impl>(Impl{make_box(box_W, voxel_mm)});
}
Stock::Stock(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Stock::~Stock() = default;
Stock::Stock(Stock&&) noexcept = default;
Stock& Stock::operator=(Stock&&) noexcept = default;

void Stock::cut(std::span<const Sweep> sweeps, const CutterSolid& cutter) {
  cut_level_set(impl_->level_set, sweeps, cutter);
}

double Stock::voxel_mm() const {
  return impl_->level_set.voxel;
}
const Box& Stock::box() const {
  return impl_->level_set.box;
}
double Stock::volume_mm3() const {
  return volume(impl_->level_set);
}
double Stock::distance_mm(const Vec3& point_W) const {
  return trilinear(impl_->level_set, point_W);
}
const LevelSet& Stock::level_set() const {
  return impl_->level_set;
}
uint64_t Stock::hash() const {
  return state_hash(impl_->level_set);
}
size_t Stock::memory_bytes() const {
  const LeafMap& map = impl_->level_set.map;
  return impl_->level_set.grid->memUsage() +
         map.size() * (sizeof(LeafState) + sizeof(LeafNode*) + sizeof(map.cuts[0]));
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
Stock Stock::load(const std::string& path, StockMetadata* metadata) {
  StockMetadata found;
  Stock stock(std::make_unique<Impl>(Impl{read_level_set(path, found)}));
  if (metadata != nullptr) *metadata = std::move(found);
  return stock;
}

size_t Stock::memory_estimate(const Box& box_W, double voxel_mm) {
  // A surface element is met by leaves of (8 voxel)^2 face area; the band is 6 voxels thick, so a leaf
  // position along the surface's normal is touched with probability (8 + 6) / 8.
  constexpr double kLeafBytes = 2200.0;   // 512 floats, mask, node; measured 2168 per leaf
  constexpr double kLayers = 14.0 / 8.0;  // leaves per face of a leaf
  constexpr double kNewSurface = 0.5;     // of the box's area, while it is cut
  constexpr double kMapBytes =
      sizeof(LeafState) + sizeof(uint32_t) + 2.0 * sizeof(LeafNode*);  // twice: while the box is made
  const Vec3 d = box_W.size();
  const double area = 2.0 * (d.x() * d.y() + d.y() * d.z() + d.z() * d.x());
  const double leaf_mm = 8.0 * voxel_mm;
  const double leaves = kLayers * area * (1.0 + kNewSurface) / (leaf_mm * leaf_mm);
  const double positions = (d / leaf_mm + Vec3::Constant(2.0)).prod();
  return static_cast<size_t>(leaves * kLeafBytes + positions * kMapBytes);
}

}  // namespace swarf::stock
