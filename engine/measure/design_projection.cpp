#include "measure/design_projection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/check.h"

namespace swarf::measure {
namespace {

constexpr int kNewtonSteps =
    4;  // from a ray a pitch away, quadratic convergence is down to rounding in three
constexpr double kEdgeSlack = 1e-6;  // in u, v: a point exactly on the edge must not fall off by rounding

struct GridPlace {
  int iu, iv;
  double fu, fv;  ///< fractions inside the cell
};

/// The interval of the grid's lines that holds t, and how far inside.
std::pair<int, double> interval_of(const std::vector<double>& lines, double t) {
  const double inside = std::clamp(t, 0.0, 1.0);
  const auto above = std::upper_bound(lines.begin() + 1, lines.end() - 1, inside);
  const double low = *(above - 1);
  return {static_cast<int>(above - lines.begin()) - 1, (inside - low) / (*above - low)};
}

GridPlace place_of(const stock::SurfaceDexels& dexels, double u, double v) {
  const auto [iu, fu] = interval_of(dexels.field().u_lines, u);
  const auto [iv, fv] = interval_of(dexels.field().v_lines, v);
  return {iu, iv, fu, fv};
}

}  // namespace

size_t DesignProjection::CellHash::operator()(const Cell& cell) const {
  uint64_t hash = 0;
  for (const int32_t c : cell) hash = (hash ^ static_cast<uint32_t>(c)) * 0x9e3779b97f4a7c15ULL;
  return hash ^ (hash >> 29);
}

DesignProjection::DesignProjection(const stock::SurfaceDexels& dexels, double reach_mm)
    : dexels_(dexels), reach_mm_(reach_mm) {
  SWARF_CHECK(dexels.field().surface != nullptr, "projection needs a parametric design");
  // A cell as wide as the reach or the widest grid step, so that the 27 cells around a point hold its nearest
  // ray.
  double step = 0.0;
  const auto& points = dexels.points();
  const auto nu = static_cast<size_t>(dexels.nu());
  for (size_t i = 0; i < points.size(); ++i) {
    if ((i + 1) % nu != 0) step = std::max(step, (points[i + 1] - points[i]).norm());
    if (i + nu < points.size()) step = std::max(step, (points[i + nu] - points[i]).norm());
  }
  cell_mm_ = std::max(reach_mm, 0.0) + step;
  for (size_t i = 0; i < points.size(); ++i) cells_[cell_of(points[i])].push_back(static_cast<uint32_t>(i));
}

DesignProjection::Cell DesignProjection::cell_of(const Vec3& point) const {
  return {static_cast<int32_t>(std::floor(point.x() / cell_mm_)),
          static_cast<int32_t>(std::floor(point.y() / cell_mm_)),
          static_cast<int32_t>(std::floor(point.z() / cell_mm_))};
}

int64_t DesignProjection::nearest_ray(const Vec3& point) const {
  const Cell centre = cell_of(point);
  int64_t nearest = -1;
  double best = std::numeric_limits<double>::infinity();
  for (int32_t i = 0; i < 27; ++i) {
    const auto found = cells_.find({centre[0] + i % 3 - 1, centre[1] + i / 3 % 3 - 1, centre[2] + i / 9 - 1});
    if (found == cells_.end()) continue;
    for (const uint32_t ray : found->second) {
      const double distance = (dexels_.points()[ray] - point).squaredNorm();
      if (distance < best) {
        best = distance;
        nearest = ray;
      }
    }
  }
  return nearest;
}

std::optional<Foot> foot_near(const stock::SurfaceDexels& dexels, uint32_t ray, const Vec3& point) {
  const int at = static_cast<int>(ray);
  double u = dexels.u(at % dexels.nu());
  double v = dexels.v(at / dexels.nu());
  surface::Derivatives d = dexels.surface().derivatives(u, v);
  for (int step = 0; step < kNewtonSteps; ++step) {
    // Gradient and Hessian of |S - point|^2 / 2.
    const Vec3 r = d.S - point;
    const double gu = r.dot(d.Su);
    const double gv = r.dot(d.Sv);
    const double huu = d.Su.dot(d.Su) + r.dot(d.Suu);
    const double huv = d.Su.dot(d.Sv) + r.dot(d.Suv);
    const double hvv = d.Sv.dot(d.Sv) + r.dot(d.Svv);
    const double det = huu * hvv - huv * huv;
    if (det <= 0.0) return {};  // beyond the centre of curvature: no unique foot
    u -= (hvv * gu - huv * gv) / det;
    v -= (huu * gv - huv * gu) / det;
    d = dexels.surface().derivatives(u, v);
  }
  if (u < -kEdgeSlack || u > 1.0 + kEdgeSlack || v < -kEdgeSlack || v > 1.0 + kEdgeSlack) return {};
  Foot foot{u, v, 0.0, surface::outward_normal(dexels.surface(), d, {u, v}), 0.0};
  foot.height_mm = (point - d.S).dot(foot.normal);
  foot.to_edge_mm = std::min(std::min(u, 1.0 - u) * d.Su.norm(), std::min(v, 1.0 - v) * d.Sv.norm());
  return foot;
}

std::optional<Foot> DesignProjection::project(const Vec3& point) const {
  const int64_t ray = nearest_ray(point);
  if (ray < 0) return {};
  const std::optional<Foot> foot = foot_near(dexels_, static_cast<uint32_t>(ray), point);
  if (!foot || std::abs(foot->height_mm) > reach_mm_) return {};
  return foot;
}

double height_at(const stock::SurfaceDexels& dexels, double u, double v) {
  const GridPlace p = place_of(dexels, u, v);
  const auto height = [&](int iu, int iv) {
    return dexels
        .heights_mm()[static_cast<size_t>(iv) * static_cast<size_t>(dexels.nu()) + static_cast<size_t>(iu)];
  };
  const double low = (1.0 - p.fu) * height(p.iu, p.iv) + p.fu * height(p.iu + 1, p.iv);
  const double high = (1.0 - p.fu) * height(p.iu, p.iv + 1) + p.fu * height(p.iu + 1, p.iv + 1);
  return (1.0 - p.fv) * low + p.fv * high;
}

uint32_t block_at(const stock::SurfaceDexels& dexels, double u, double v) {
  const GridPlace p = place_of(dexels, u, v);
  const auto iu = static_cast<size_t>(p.iu) + (p.fu > 0.5 ? 1U : 0U);
  const auto iv = static_cast<size_t>(p.iv) + (p.fv > 0.5 ? 1U : 0U);
  return dexels.blocks()[iv * static_cast<size_t>(dexels.nu()) + iu];
}

}  // namespace swarf::measure
