#include "toolpath/constant_scallop.h"

#include <algorithm>
#include <cmath>

#include "toolpath/chebyshev.h"
#include "toolpath/offset_walk.h"

namespace swarf::toolpath {
namespace {

/// Newton in one variable with an approximate second derivative, kept on the grid.
constexpr int kMaxInnerSteps = 20;
constexpr double kInnerDone = 1e-7;  ///< mm along the pass; the height depends on it quadratically

/// A function of one parameter at s: its value, its slope, its second derivative (leading term) and |d/ds|.
struct Local {
  double value, slope, bend, speed;
};

/// Least value of `local(s)` near the start.
template <class Function>
EnvelopeHeight least_height(const Grid& grid, double s, const Function& local) {
  EnvelopeHeight result;
  result.s = std::clamp(s, grid.first, grid.last());
  for (int i = 0; i < kMaxInnerSteps; ++i) {
    const Local f = local(result.s);
    result.height_mm = f.value;
    // Straight along the feed: all planes are the same one, and any s will do.
    if (!(f.bend > 0.0)) break;
    const double wanted = result.s - f.slope / f.bend;
    const double s_new = std::clamp(wanted, grid.first, grid.last());
    result.outside = s_new != wanted;
    const double moved = std::abs(s_new - result.s) * f.speed;
    result.s = s_new;
    if (moved < kInnerDone) break;
  }
  return result;
}

/// Height of the tangent plane at q (normal vector m_q, any length) over the ridge point nearest to it.
EnvelopeHeight plane_over_ridge(const Area& area, const CubicSpline& ridge, const Vec3& q, const Vec3& m_q,
                                double s_start) {
  const PassSurface surface = area.pass_surface();
  return least_height(area.grid, s_start, [&](double s) -> Local {
    const GraphPoint r = graph_point(surface, ridge, s);
    const NormalJet jet = normal_along(surface, r.d, ridge.at(s).dw);
    const double length = jet.m.norm();
    const Vec3 n = jet.m / length;
    const Vec3 dn = (jet.dm - n * n.dot(jet.dm)) / length;
    const double over = (q - r.p).dot(m_q);
    const double rise = n.dot(m_q);
    return {over / rise, (-r.dp.dot(m_q) * rise - over * dn.dot(m_q)) / (rise * rise), r.dp.dot(dn),
            r.dp.norm()};
  });
}

/// Height along the unit `n` over a point at which a ball with its centre `gap` away from the point begins:
/// the lower crossing of the line with the sphere. NaN where the line passes beside it.
double below_ball(const Vec3& gap, const Vec3& n, double r) {
  const double up = gap.dot(n);
  return up - std::sqrt(r * r - (gap - up * n).squaredNorm());
}

/// The point of the pass' surface at s, its unit outward normal and their derivatives along the pass.
struct NormalPoint {
  Vec3 p, dp, n, dn;
};
NormalPoint normal_point(const Area& area, const CubicSpline& pass, double s) {
  const PassSurface surface = area.pass_surface();
  const GraphPoint g = graph_point(surface, pass, s);
  const NormalJet jet = normal_along(surface, g.d, pass.at(s).dw);
  const double length = jet.m.norm();
  const Vec3 n = jet.m / length;
  return {g.p, g.dp, n, (jet.dm - n * n.dot(jet.dm)) / length};
}

/// Height of the ball with the centre c over the ridge's foot on the surface, where it is lowest.
EnvelopeHeight ball_over_ridge(const Area& area, const CubicSpline& ridge, const Vec3& c, double s_start) {
  return least_height(area.grid, s_start, [&](double s) -> Local {
    const NormalPoint at = normal_point(area, ridge, s);
    const double x = below_ball(c - at.p, at.n, area.end.corner_mm);
    // |p + x n - c| = r, differentiated by s: x' from g.(p' + x n' + x' n) = 0.
    const Vec3 g = at.p + x * at.n - c;
    const double depth = -g.dot(at.n);
    const Vec3 level = at.dp + x * at.dn;
    const double dx = g.dot(level) / depth;
    return {x, dx, (level + dx * at.n).squaredNorm() / depth + at.dp.dot(at.dn), at.dp.norm()};
  });
}

struct Level {
  double w = 0.0;
  EnvelopeHeight at;
  bool found = false;
};

/// The w beyond `base` where height(w, s) = target. Heights grow with the square of the distance, so the
/// distance is corrected by the square root of the ratio; every step gains about two digits.
template <class Height>
Level level_point(double base, double advance, double farthest, double s_start, double target,
                  const Height& height) {
  constexpr int kMaxSteps = 40;
  constexpr double kDone = 1e-10;  // relative
  Level level;
  level.at.s = s_start;
  for (int i = 0; i < kMaxSteps; ++i) {
    level.w = base + advance;
    level.at = height(level.w, level.at.s);
    const double ratio = std::sqrt(target / level.at.height_mm);
    if (!std::isfinite(ratio) || std::abs(advance) > farthest) return level;
    if (std::abs(ratio - 1.0) < kDone) {
      level.found = true;
      return level;
    }
    advance *= ratio;
  }
  return level;
}

/// Advance in w that leaves half the interval between `pass` and the cusp.
double half_advance(const Area& area, const CubicSpline& pass, double t) {
  const PassSurface surface = area.pass_surface();
  const GraphPoint g = graph_point(surface, pass, t);
  const surface::Shape shape = surface::shape_at(g.d, surface.outward_sign());
  const Vec2 feed = shape.in_tangent(g.dp).normalized();
  const double across = (g.d.Sv - g.dp * g.dp.dot(g.d.Sv) / g.dp.squaredNorm()).norm();
  return 0.5 * area.forward() * interval_at(area, shape, feed, IntervalRule::kExact).usable() / across;
}

/// Where the surface does not continue beyond the last boundary: the boundary itself, if the height there is
/// not yet the wanted one.
template <class Height>
Level held_at_end(const Area& area, double base, double t, double s_start, const Height& height) {
  Level level;
  if (area.continues_across) return level;
  level.w = area.end_w;
  level.at.s = t;
  if (!area.beyond_end(base)) level.at = height(area.end_w, s_start);
  level.found = level.at.height_mm < area.scallop_mm;
  return level;
}

/// The curve beyond `pass` on which height(t, w, s) equals the area's scallop, at the grid's abscissae.
template <class Height>
GridPoints level_curve(const Area& area, const CubicSpline& pass, const Height& height) {
  const Grid& grid = area.grid;
  GridPoints points(grid.size());
  double shift = 0.0;  // of the foot, as found at the neighbour
  for (int j = 0; j < grid.size(); ++j) {
    const double t = grid.t(j);
    const double base = pass.at(t).w;
    const auto here = [&](double w, double s) { return height(t, w, s); };
    Level level = held_at_end(area, base, t, t + shift, here);
    if (!level.found) {
      // Four times the expected distance is a runaway, not a solution.
      const double advance = half_advance(area, pass, t);
      level = level_point(base, advance, 4.0 * std::abs(advance), t + shift, area.scallop_mm, here);
    }
    if (!level.found) continue;
    shift = level.at.s - t;
    points.w[j] = level.w;
    points.foot[j] = level.at.s;
    // Without a margin the pass truly ends at the grid's border, and its last bottom is the one that counts.
    const bool usable = !level.at.outside || !area.continues_along;
    points.outcome[j] = usable ? PointOutcome::kSolved : PointOutcome::kFootOutside;
  }
  return points;
}

NextPass next_of_ball(const Area& area, const CubicSpline& previous) {
  const PassSurface surface = area.pass_surface();
  const auto normal = [&](const surface::Derivatives& d) -> Vec3 {
    return surface.outward_sign() * d.Su.cross(d.Sv).normalized();
  };
  const auto left_by_previous = [&](double t, double w, double s) {
    const surface::Derivatives d = surface.at(t, w);
    return canal_height(area, previous, d.S, normal(d), s);
  };
  NextPass ridge = graph_of(area, previous, level_curve(area, previous, left_by_previous));
  if (ridge.outcome != NextPass::kOk) return ridge;
  const auto left_on_ridge = [&](double t, double w, double s) {
    const surface::Derivatives d = surface.at(t, w);
    return ball_over_ridge(area, ridge.w, d.S + area.end.corner_mm * normal(d), s);
  };
  return graph_of(area, ridge.w, level_curve(area, ridge.w, left_on_ridge));
}

NextPass next_exact(const Area& area, const CubicSpline& previous) {
  const PassSurface surface = area.pass_surface();
  const auto left_by_previous = [&](double t, double w, double s) {
    const surface::Derivatives d = surface.at(t, w);
    const Vec3 normal = surface.outward_sign() * d.Su.cross(d.Sv).normalized();
    return envelope_height(area, previous, d.S, normal, s);
  };
  NextPass ridge = graph_of(area, previous, level_curve(area, previous, left_by_previous));
  if (ridge.outcome != NextPass::kOk) return ridge;
  const auto left_on_ridge = [&](double t, double w, double s) {
    const surface::Derivatives d = surface.at(t, w);
    return plane_over_ridge(area, ridge.w, d.S, surface.outward_sign() * d.Su.cross(d.Sv), s);
  };
  return graph_of(area, ridge.w, level_curve(area, ridge.w, left_on_ridge));
}

/// Chord wanted at each abscissa of the grid: by formula at mid strip, with the feed of the previous pass.
/// `next` is the last guess of the next pass.
std::vector<double> formula_chords(const Area& area, const CubicSpline& previous, const CubicSpline& next) {
  const PassSurface surface = area.pass_surface();
  std::vector<double> chords(area.grid.size());
  for (int j = 0; j < area.grid.size(); ++j) {
    const double t = area.grid.t(j);
    const GraphPoint g = graph_point(surface, previous, t);
    const surface::Derivatives middle = surface.at(t, 0.5 * (previous.at(t).w + next.at(t).w));
    const surface::Shape shape = surface::shape_at(middle, surface.outward_sign());
    chords[j] = interval_at(area, shape, shape.in_tangent(g.dp).normalized(), IntervalRule::kExact).usable();
  }
  return chords;
}

/// The chord of a leaned tool depends on the direction of the previous pass. Point by point that would make
/// every pass sharpen the waves of the one before (the ridge of a wavy pass truly does), so the chords pass
/// through a polynomial of this degree, lowered until it lies nowhere above them within the part.
constexpr int kChordDegree = 10;

NextPass next_by_formula(const Area& area, const CubicSpline& previous) {
  constexpr int kRounds = 3;  // mid strip moves by a hundredth of the chord error: two digits each
  NextPass next{NextPass::kOk, 0.0, previous};
  for (int i = 0; i < kRounds && next.outcome == NextPass::kOk; ++i) {
    const Chebyshev chord =
        fitted_from_below(area.grid, formula_chords(area, previous, next.w), kChordDegree);
    next = graph_of(area, previous, offset_walk(area, previous, [&](double s) { return chord.at(s); }));
  }
  return next;
}

bool flat_along(const Area& area, const CubicSpline& pass) {
  const PassSurface surface = area.pass_surface();
  for (int j = 0; j < area.grid.size(); ++j) {
    const PassFrame frame = pass_frame(surface, pass, area.grid.t(j));
    if (!interval_at(area, frame.shape, frame.unit_feed, IntervalRule::kExact).flat) return false;
  }
  return true;
}

}  // namespace

EnvelopeHeight envelope_height(const Area& area, const CubicSpline& pass, const Vec3& point,
                               const Vec3& normal, double s_start) {
  const PassSurface surface = area.pass_surface();
  return least_height(area.grid, s_start, [&](double s) -> Local {
    const GraphPoint g = graph_point(surface, pass, s);
    const NormalJet jet = normal_along(surface, g.d, pass.at(s).dw);
    const double over = (g.p - point).dot(jet.m);
    const double rise = normal.dot(jet.m);
    // p'.m = 0: the tangent plane contains the feed.
    const double slope = ((g.p - point).dot(jet.dm) * rise - over * normal.dot(jet.dm)) / (rise * rise);
    return {over / rise, slope, g.dp.dot(jet.dm) / rise, g.dp.norm()};
  });
}

EnvelopeHeight canal_height(const Area& area, const CubicSpline& pass, const Vec3& point, const Vec3& normal,
                            double s_start) {
  const double r = area.end.corner_mm;
  return least_height(area.grid, s_start, [&](double s) -> Local {
    const NormalPoint at = normal_point(area, pass, s);
    const Vec3 c = at.p + r * at.n;
    const Vec3 dc = at.dp + r * at.dn;
    const double x = below_ball(c - point, normal, r);
    const Vec3 g = point + x * normal - c;
    const double depth = -g.dot(normal);
    const double dx = -g.dot(dc) / depth;
    return {x, dx, (dc - dx * normal).squaredNorm() / depth - at.dn.dot(dc), at.dp.norm()};
  });
}

NextPass next_constant_scallop(const Area& area, const CubicSpline& previous) {
  if (area.ball()) return next_of_ball(area, previous);
  if (area.lean.on_normal() && !flat_along(area, previous)) return next_exact(area, previous);
  return next_by_formula(area, previous);
}

}  // namespace swarf::toolpath
