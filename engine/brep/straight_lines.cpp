#include "brep/straight_lines.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "surface/nurbs.h"

namespace swarf::brep {
namespace {

/// Poles at both ends of the lines, as points; nothing where lines are no lines or their weights differ.
std::optional<std::vector<std::array<Vec3, 2>>> ends_of_lines(const surface::BezierGrid& grid, int along) {
  const bool is_v = along == 1;
  if ((is_v ? grid.degree_v : grid.degree_u) != 1) return {};
  if ((is_v ? grid.breaks_v : grid.breaks_u).size() != 2) return {};
  const auto across = static_cast<size_t>(is_v ? grid.degree_u : grid.degree_v) + 1;
  std::vector<std::array<Vec3, 2>> ends;
  for (size_t first = 0; first < grid.poles.size(); first += 2 * across) {
    for (size_t i = 0; i < across; ++i) {
      const auto& a = grid.poles[first + (is_v ? 2 * i : i)];
      const auto& b = grid.poles[first + (is_v ? 2 * i + 1 : i + across)];
      constexpr double kSameWeight = 1e-13;
      if (std::abs(a.w() - b.w()) > kSameWeight * std::abs(a.w())) return {};
      ends.push_back({Vec3(a.head<3>() / a.w()), Vec3(b.head<3>() / b.w())});
    }
  }
  return ends;
}

/// Whether the ends of one side are those of the other, moved and drawn smaller.
bool move_alike(const std::vector<std::array<Vec3, 2>>& ends) {
  const auto from_first = [&](size_t i, size_t side) -> Vec3 { return ends[i][side] - ends[0][side]; };
  std::array<std::pair<double, size_t>, 2> farthest{};
  for (size_t side = 0; side < 2; ++side)
    for (size_t i = 0; i < ends.size(); ++i)
      farthest[side] = std::max(farthest[side], {from_first(i, side).norm(), i});
  const size_t large = farthest[0].first >= farthest[1].first ? 0 : 1, i = farthest[large].second;
  if (!(farthest[large].first > 0.0)) return false;
  const double ratio =
      from_first(i, large).dot(from_first(i, 1 - large)) / from_first(i, large).squaredNorm();
  constexpr double kSame = 1e-9;  // mm
  if (ratio < -kSame) return false;
  for (size_t n = 0; n < ends.size(); ++n)
    if ((from_first(n, 1 - large) - ratio * from_first(n, large)).norm() > kSame) return false;
  return true;
}

}  // namespace

std::optional<int> straight_lines(const surface::Surface& surface) {
  const auto* nurbs = dynamic_cast<const surface::NurbsSurface*>(&surface);
  if (nurbs == nullptr) return {};
  for (const int along : {1, 0}) {
    const auto ends = ends_of_lines(nurbs->grid(), along);
    if (ends && move_alike(*ends)) return along;
  }
  return {};
}

double straight_bound(const surface::Surface& surface, int along, const Vec2& from, const Vec2& to) {
  const Vec2 low = from.cwiseMin(to).cwiseMax(Vec2::Zero()), high = from.cwiseMax(to).cwiseMin(Vec2::Ones());
  // Along a line the second derivative across is linear: it is greatest at an end.
  double bend = 0.0;
  for (const double at : {low[along], high[along]}) {
    Vec2 begin = low, end = high;
    begin[along] = end[along] = at;
    const surface::BendBounds bends = surface.bend_bounds(begin, end);
    bend = std::max(bend, (along == 1 ? bends.uu : bends.vv).most());
  }
  const double across = (high - low)[1 - along];
  return bend * across * across / 8.0;
}

double straight_bound(const surface::Surface& surface, int along, const std::array<Vec2, 3>& x,
                      const std::array<Vec3, 3>& facet) {
  double corners = 0.0;
  std::array<Vec2, 3> own = x;
  for (size_t k = 0; k < 3; ++k) {
    const surface::Derivatives d = surface.derivatives(x[k].x(), x[k].y());
    corners = std::max(corners, (d.S - facet[k]).norm());
    // The apex of a cone has any parameter across.
    constexpr double kApex = 1e-6;
    const Eigen::Index across = 1 - along;
    if ((along == 1 ? d.Su : d.Sv).norm() < kApex * (along == 1 ? d.Sv : d.Su).norm())
      own[k][across] = 0.5 * (x[(k + 1) % 3][across] + x[(k + 2) % 3][across]);
  }
  return corners + straight_bound(surface, along, own[0].cwiseMin(own[1]).cwiseMin(own[2]),
                                  own[0].cwiseMax(own[1]).cwiseMax(own[2]));
}

}  // namespace swarf::brep
