#include "measure/seen_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"

namespace swarf::measure {
namespace {

/// Places along one ray; of a ray that is longer they lie farther apart.
constexpr double kMostPlaces = 256.0;
/// Of distances to cells: their borders are known to some roundings of a part of some metres.
constexpr double kBorderShare = 1.0 - 1e-6;

/// A cell and those beside it, those that are likely to hold the nearest place first.
constexpr std::array<std::array<int32_t, 3>, 27> cells_around() {
  std::array<std::array<int32_t, 3>, 27> cells{};
  size_t count = 0;
  for (int32_t apart = 0; apart <= 3; ++apart)
    for (int32_t i = 0; i < 27; ++i) {
      const std::array<int32_t, 3> step{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
      if (step[0] * step[0] + step[1] * step[1] + step[2] * step[2] == apart) cells[count++] = step;
    }
  return cells;
}
constexpr auto kAround = cells_around();

}  // namespace

size_t SeenSurface::CellHash::operator()(const Cell& cell) const {
  uint64_t hash = 0;
  for (const int32_t c : cell) hash = (hash ^ static_cast<uint32_t>(c)) * 0x9e3779b97f4a7c15ULL;
  return hash ^ (hash >> 29);
}

SeenSurface::SeenSurface(const stock::SurfaceDexels& dexels, double slack_mm)
    : dexels_(dexels), slack_mm_(slack_mm) {
  SWARF_CHECK(dexels.field().surface != nullptr, "feet are found on a parametric design");
  const auto& points = dexels.points();
  const auto nu = static_cast<size_t>(dexels.nu());
  double step = 0.0;
  for (size_t i = 0; i < points.size(); ++i) {
    if ((i + 1) % nu != 0) step = std::max(step, (points[i + 1] - points[i]).norm());
    if (i + nu < points.size()) step = std::max(step, (points[i + nu] - points[i]).norm());
  }
  cell_mm_ = step + slack_mm;
  first_cell_.fill(std::numeric_limits<int32_t>::max());
  last_cell_.fill(std::numeric_limits<int32_t>::min());
  tops_mm_ = dexels.heights_mm();
  for (uint32_t n = 0; n < points.size(); ++n) add(n, 0.0, tops_mm_[n]);
  dexels.each_above([&](uint32_t ray, const stock::MaterialAbove& m) {
    if (m.high - m.low < stock::kSliver) return;
    add(ray, m.low, m.high);
    tops_mm_[ray] = m.high;
  });
}

void SeenSurface::add(uint32_t ray, double low_mm, double high_mm) {
  const double places = std::clamp(std::ceil(std::abs(high_mm - low_mm) / cell_mm_), 1.0, kMostPlaces);
  for (double k = 0.0; k <= places; k += 1.0) {
    const double height = low_mm + k / places * (high_mm - low_mm);
    const Vec3 point = dexels_.points()[ray] + height * dexels_.normals()[ray];
    const Cell cell = cell_of(point);
    cells_[cell].push_back({point, ray});
    for (size_t i = 0; i < 3; ++i) {
      first_cell_[i] = std::min(first_cell_[i], cell[i]);
      last_cell_[i] = std::max(last_cell_[i], cell[i]);
    }
  }
}

SeenSurface::Cell SeenSurface::cell_of(const Vec3& point) const {
  const Vec3 cell = (point / cell_mm_).array().floor();
  return {static_cast<int32_t>(cell.x()), static_cast<int32_t>(cell.y()), static_cast<int32_t>(cell.z())};
}

std::optional<uint32_t> SeenSurface::nearest_ray(const Vec3& point) const {
  const Cell centre = cell_of(point);
  for (size_t k = 0; k < 3; ++k)
    if (centre[k] < first_cell_[k] - 1 || centre[k] > last_cell_[k] + 1) return {};
  const Vec3 in_cell = point - cell_mm_ * Vec3(centre[0], centre[1], centre[2]);
  std::optional<uint32_t> nearest;
  double best = std::numeric_limits<double>::infinity();
  for (const Cell& step : kAround) {
    double nearer = 0.0;  // than this, squared, nothing of the cell beside lies
    for (int k = 0; k < 3; ++k) {
      const double off = step[static_cast<size_t>(k)] < 0   ? in_cell[k]
                         : step[static_cast<size_t>(k)] > 0 ? cell_mm_ - in_cell[k]
                                                            : 0.0;
      nearer += off * off;
    }
    if (nearer * kBorderShare > best) continue;
    const auto found = cells_.find({centre[0] + step[0], centre[1] + step[1], centre[2] + step[2]});
    if (found == cells_.end()) continue;
    for (const Place& place : found->second) {
      const double distance = (place.point - point).squaredNorm();
      if (distance > best || (distance == best && place.ray >= *nearest)) continue;
      best = distance;
      nearest = place.ray;
    }
  }
  return nearest;
}

std::array<double, 2> SeenSurface::heights_around(const Foot& foot) const {
  const auto& u = dexels_.field().u_lines;
  const auto& v = dexels_.field().v_lines;
  const auto line = [](const std::vector<double>& lines, double at) {
    const auto above = std::upper_bound(lines.begin() + 1, lines.end() - 1, at);
    return static_cast<size_t>(above - lines.begin()) - 1;
  };
  const size_t iu = line(u, foot.u), iv = line(v, foot.v);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (size_t row = iv - std::min<size_t>(iv, 1); row < std::min(iv + 3, v.size()); ++row) {
    for (size_t column = iu - std::min<size_t>(iu, 1); column < std::min(iu + 3, u.size()); ++column) {
      const size_t ray = row * u.size() + column;
      low = std::min(low, dexels_.heights_mm()[ray]);
      high = std::max(high, tops_mm_[ray]);
    }
  }
  return {low, high};
}

std::optional<Foot> SeenSurface::foot_of(const Vec3& point) const {
  const auto ray = nearest_ray(point);
  if (!ray) return {};
  return foot_near(dexels_, *ray, point);
}

std::optional<Seen> SeenSurface::at(const Vec3& point, const Vec3& normal) const {
  const std::optional<Foot> foot = foot_of(point);
  if (!foot) return {};
  const double own = foot->height_mm;
  const auto [low, high] = heights_around(*foot);
  if (own < std::min(low, 0.0) - slack_mm_ || own > std::max(high, 0.0) + slack_mm_) return {};
  const bool along = normal.dot(foot->normal) >= kFaceCosine;
  const double rays = height_at(dexels_, foot->u, foot->v);
  if (along && std::abs(own - rays) <= slack_mm_) return Seen{*foot, rays, true};
  // Beside the design's own height only the face counts: the block's side walls begin there.
  if (std::abs(own) <= slack_mm_ || (std::abs(low) <= slack_mm_ && std::abs(high) <= slack_mm_)) return {};
  return Seen{*foot, own, false};
}

}  // namespace swarf::measure
