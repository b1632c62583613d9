#include "toolpath/offset_walk.h"

#include <cmath>

namespace swarf::toolpath {
namespace {

struct Match {
  double s = 0.0, w = 0.0;
  bool found = false;
};

/// First guess: from the point of the same t straight across the surface.
Match first_guess(const Area& area, const CubicSpline& previous, double t, const ChordRule& rule) {
  const GraphPoint g = graph_point(area.pass_surface(), previous, t);
  const Vec3& across = g.d.Sv;
  const double slope = across.dot(g.dp) / g.dp.squaredNorm();
  const double w = previous.at(t).w;
  const double advance = area.forward() * rule(t) / (across - slope * g.dp).norm();
  return {t + slope * advance, w + advance, false};
}

Match solve_point(const Area& area, const CubicSpline& previous, double t, const ChordRule& rule) {
  constexpr int kMaxSteps = 30;
  constexpr double kDone = 1e-10;  // mm
  const PassSurface surface = area.pass_surface();
  Match match = first_guess(area, previous, t, rule);
  for (int i = 0; i < kMaxSteps; ++i) {
    const GraphPoint g = graph_point(surface, previous, match.s);
    const surface::Derivatives d = surface.at(t, match.w);
    const Vec3 gap = d.S - g.p;
    const double chord = rule(match.s);
    const Vec2 residual(gap.dot(g.dp), gap.squaredNorm() - chord * chord);
    Mat2 jacobian;
    jacobian << gap.dot(g.ddp) - g.dp.squaredNorm(), d.Sv.dot(g.dp), -2.0 * gap.dot(g.dp),
        2.0 * gap.dot(d.Sv);
    const double determinant = jacobian.determinant();
    const Vec2 step(-(jacobian(1, 1) * residual[0] - jacobian(0, 1) * residual[1]) / determinant,
                    -(jacobian(0, 0) * residual[1] - jacobian(1, 0) * residual[0]) / determinant);
    if (!step.allFinite()) return match;
    match.s += step[0];
    match.w += step[1];
    if (std::abs(step[0]) * g.dp.norm() + std::abs(step[1]) * d.Sv.norm() < kDone) {
      match.found = true;
      return match;
    }
  }
  return match;
}

}  // namespace

GridPoints offset_walk(const Area& area, const CubicSpline& previous, const ChordRule& chord) {
  const Grid& grid = area.grid;
  GridPoints points(grid.size());
  for (int j = 0; j < grid.size(); ++j) {
    const Match match = solve_point(area, previous, grid.t(j), chord);
    if (!match.found) continue;
    points.w[j] = match.w;
    points.foot[j] = match.s;
    const bool inside = match.s >= grid.first && match.s <= grid.last();
    points.outcome[j] = inside ? PointOutcome::kSolved : PointOutcome::kFootOutside;
  }
  return points;
}

}  // namespace swarf::toolpath
