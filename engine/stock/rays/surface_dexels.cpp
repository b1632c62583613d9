#include "stock/rays/surface_dexels.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/check.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "stock/rays/dexel_tiles.h"
#include "stock/rays/free_ranges.h"

namespace swarf::stock {
namespace {

constexpr size_t kTilesPerTask = 4;

/// Height at which the ray leaves the box for good. A design point outside the box lacks material: the height
/// is that of the box below it, or minus the distance to the box when the ray misses it.
double height_of_box(const Box& box, const Vec3& point, const Vec3& normal) {
  double enter = -std::numeric_limits<double>::infinity(), leave = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 3; ++a) {
    if (normal[a] == 0.0) {
      if (point[a] < box.lower[a] || point[a] > box.upper[a])
        leave = -std::numeric_limits<double>::infinity();
      continue;
    }
    const double s0 = (box.lower[a] - point[a]) / normal[a], s1 = (box.upper[a] - point[a]) / normal[a];
    enter = std::max(enter, std::min(s0, s1));
    leave = std::min(leave, std::max(s0, s1));
  }
  constexpr double kOnFace =
      1e-9;  // mm; design edges often lie on the box, and rounding must not move them out
  const bool hit = enter <= leave && enter <= kOnFace;
  return hit ? leave : -(point - point.cwiseMax(box.lower).cwiseMin(box.upper)).norm();
}

bool is_in(Share share, size_t tile) {
  return tile % static_cast<size_t>(share.count) == static_cast<size_t>(share.index);
}

/// Of where the rays are and how they are put into tiles.
uint64_t rays_hash(const RayField& field) {
  Hash hash;
  for (const auto* list : {&field.points, &field.normals})
    for (const Vec3& v : *list)
      for (int a = 0; a < 3; ++a) hash.add(v[a]);
  for (const uint32_t ray : field.order) hash.add(uint64_t{ray});
  hash.add(uint64_t{field.tiles.size()});
  return hash.value();
}

}  // namespace

SurfaceDexels::SurfaceDexels(RayFieldPtr field)
    : field_(std::move(field)),
      heights_(field_->size(), 0.0),
      blocks_(field_->size(), kUncut),
      above_(field_->tiles.size()) {}

SurfaceDexels::SurfaceDexels(RayFieldPtr field, const Box& stock_box, std::span<const double> ranges_mm)
    : SurfaceDexels(std::move(field)) {
  SWARF_CHECK(ranges_mm.empty() || ranges_mm.size() == heights_.size(), "one range per ray");
  for (size_t n = 0; n < heights_.size(); ++n) {
    heights_[n] = height_of_box(stock_box, field_->points[n], field_->normals[n]);
    if (!ranges_mm.empty()) heights_[n] = std::min(heights_[n], ranges_mm[n]);
  }
}

SurfaceDexels::SurfaceDexels(RayFieldPtr field, const RawShape& raw, std::span<const double> ranges_mm)
    : SurfaceDexels(std::move(field)) {
  if (raw.is_box()) {
    *this = SurfaceDexels(field_, raw.box(), ranges_mm);
    return;
  }
  SWARF_CHECK(ranges_mm.empty() || ranges_mm.size() == heights_.size(), "one range per ray");
  parallel_chunks(field_->tiles.size(), kTilesPerTask, [&](size_t begin, size_t end) {
    for (size_t tile = begin; tile < end; ++tile) fill_tile(tile, raw, ranges_mm);
  });
}

void SurfaceDexels::fill_tile(size_t tile, const RawShape& raw, std::span<const double> ranges_mm) {
  const RayTile& rays = field_->tiles[tile];
  for (uint32_t n = 0; n < rays.count; ++n) {
    const size_t ray = field_->order[rays.begin + n];
    const double range = ranges_mm.empty() ? std::numeric_limits<double>::infinity() : ranges_mm[ray];
    const RawColumn column = raw_column(raw, field_->points[ray], field_->normals[ray]);
    heights_[ray] = std::min(column.height_mm, range);
    for (const RawInterval& one : column.above) {
      if (one.low < range) above_[tile].push_back({n, kUncut, kUncut, one.low, std::min(one.high, range)});
    }
  }
}

SurfaceDexels::SurfaceDexels(const surface::SurfacePtr& surface, double pitch_mm, const Box& stock_box)
    : SurfaceDexels(rays_on_surface(surface, pitch_mm), stock_box, {}) {
  const std::vector<double> ranges = free_ranges({&field_, 1}, 0);
  for (size_t n = 0; n < heights_.size(); ++n) heights_[n] = std::min(heights_[n], ranges[n]);
}

void SurfaceDexels::limit_depths() {
  constexpr size_t kRaysPerTask = 1024;
  parallel_chunks(heights_.size(), kRaysPerTask, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n)
      heights_[n] = -field_->own_depth(field_->points[n], field_->normals[n], -heights_[n]);
  });
}

void SurfaceDexels::cut(std::span<const Sweep> sweeps, const CutterSolid& cutter, Share share) {
  const SweepChain chain = make_chain(sweeps, cutter);
  const size_t tiles = field_->tiles.size();
  std::vector<uint64_t> updates((tiles + kTilesPerTask - 1) / kTilesPerTask, 0);
  const Material material{*field_, heights_, blocks_, above_};
  parallel_chunks(tiles, kTilesPerTask, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n)
      if (is_in(share, n)) updates[begin / kTilesPerTask] += cut_tile(material, n, chain);
  });
  for (const uint64_t count : updates) ray_updates_ += count;
}

Bytes SurfaceDexels::tiles_of(Share share) const {
  BytesWriter out;
  out.add(rays_hash(*field_));
  out.add(ray_updates_);
  for (size_t tile = 0; tile < field_->tiles.size(); ++tile) {
    if (!is_in(share, tile)) continue;
    const RayTile& rays = field_->tiles[tile];
    for (uint32_t n = 0; n < rays.count; ++n) {
      const size_t ray = field_->order[rays.begin + n];
      out.add(heights_[ray]);
      out.add(blocks_[ray]);
    }
    out.add_list(above_[tile]);
  }
  return out.take();
}

bool SurfaceDexels::take_tiles(const Bytes& told, Share share) {
  BytesReader in(told);
  if (in.get<uint64_t>() != rays_hash(*field_)) return false;
  ray_updates_ += in.get<uint64_t>();
  for (size_t tile = 0; tile < field_->tiles.size(); ++tile) {
    if (!is_in(share, tile)) continue;
    const RayTile& rays = field_->tiles[tile];
    for (uint32_t n = 0; n < rays.count; ++n) {
      const size_t ray = field_->order[rays.begin + n];
      heights_[ray] = in.get<double>();
      blocks_[ray] = in.get<uint32_t>();
    }
    above_[tile] = in.get_list<MaterialAbove>();
  }
  return true;
}

void SurfaceDexels::each_above(const std::function<void(uint32_t, const MaterialAbove&)>& visit) const {
  for (size_t tile = 0; tile < above_.size(); ++tile) {
    for (const MaterialAbove& m : above_[tile]) visit(field_->order[field_->tiles[tile].begin + m.ray], m);
  }
}

}  // namespace swarf::stock
