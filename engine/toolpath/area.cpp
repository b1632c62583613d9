#include "toolpath/area.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/minima.h"
#include "toolpath/nose_strip.h"

namespace swarf::toolpath {
namespace {

/// A cusp or gouge below this is rounding, not geometry: one nanometre.
constexpr double kNegligibleHeight = 1e-6;
/// Samples along a pass for extremes over it; they are smooth functions of t.
constexpr int kSamples = 128;
/// Samples of the surface's continuation, along an edge and away from it.
constexpr int kEdgeSamples = 33;
constexpr int kOutwardSamples = 5;

/// Foot of the perpendicular from q to the pass, from a start nearby: (q - p).p' = 0 by Newton.
double foot_on_pass(const PassSurface& surface, const CubicSpline& w, const Vec3& q, double t) {
  constexpr int kMaxSteps = 20;
  constexpr double kDone = 1e-9;  // mm: the chord depends on it quadratically
  for (int i = 0; i < kMaxSteps; ++i) {
    const GraphPoint g = graph_point(surface, w, t);
    const Vec3 gap = q - g.p;
    const double step = gap.dot(g.dp) / (g.dp.squaredNorm() - gap.dot(g.ddp));
    t += step;
    if (std::abs(step) * g.dp.norm() < kDone) break;
  }
  return t;
}

double scallop_of(const Area& area, const surface::Shape& shape, const Vec2& feed, double chord) {
  const ContactEnd& end = area.end;
  if (area.ball()) return ball_scallop(ball_curvature(shape.K, feed, end.corner_mm), chord, end.corner_mm);
  if (!area.lean.on_normal() && end.corner_mm > 0.0)
    return nose_scallop(shape.K, feed, chord, area.lean, end, area.rim_sides);
  if (!area.lean.on_normal())
    return leaned_scallop(leaned_curvature(shape.K, feed, area.lean), chord, area.lean, end.flat_mm,
                          area.rim_sides);
  const double curvature = strip_curvature(shape.K, feed);
  return curvature > 0.0 ? scallop_for_chord(1.0 / curvature, chord) : 0.0;
}

/// Chords of leaned tools end at the rim.
Interval leaned_interval(const Area& area, const surface::Shape& shape, const Vec2& feed) {
  const double h = area.scallop_mm;
  const double chord = area.end.corner_mm > 0.0
                           ? nose_chord(shape.K, feed, h, area.lean, area.end, area.rim_sides)
                           : leaned_chord(leaned_curvature(shape.K, feed, area.lean), h, area.lean,
                                          area.end.flat_mm, area.rim_sides);
  return {chord, chord, 0.0, false};
}

Interval ball_interval(const Area& area, const surface::Shape& shape, const Vec2& feed, IntervalRule rule) {
  const double r = area.end.corner_mm;
  const double k =
      rule == IntervalRule::kPaper ? cross_curvature(shape.K, feed) : ball_curvature(shape.K, feed, r);
  const double reach = ball_reach(k, r);
  // The cusp stands no higher than the equator: (R + h)^2 + r^2 <= (R + r)^2.
  const double h = area.scallop_mm;
  const bool reached = h * (2.0 + h * k) <= 2.0 * r;
  return {reached ? ball_chord(k, h, r) : std::numeric_limits<double>::infinity(), reach, k, false};
}

/// Samples |S_t x S_w| over a rectangle of pass parameters; also says whether the tool gouges anywhere in it.
struct Regularity {
  double least_area = std::numeric_limits<double>::infinity();
  bool gouges = false;
};
Regularity regularity(const Area& area, const Vec2& t_range, const Vec2& w_range, int n_t, int n_w) {
  const PassSurface surface = area.pass_surface();
  Regularity result;
  for (int i = 0; i < n_t; ++i) {
    for (int j = 0; j < n_w; ++j) {
      const double t = t_range[0] + (t_range[1] - t_range[0]) * i / (n_t - 1);
      const double w = w_range[0] + (w_range[1] - w_range[0]) * j / (n_w - 1);
      const surface::Derivatives d = surface.at(t, w);
      const double element = d.Su.cross(d.Sv).norm();
      result.least_area = std::min(result.least_area, element);
      result.gouges = result.gouges || !(element > 0.0) ||
                      gouges(surface::shape_at(d, surface.outward_sign()), area.lean, area.end);
    }
  }
  return result;
}

/// Least |S_t| (or |S_w|) along an edge, to turn millimetres into parameters on the safe side.
double least_speed_along(const Area& area, double t_edge) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kEdgeSamples; ++i) {
    const double w = static_cast<double>(i) / (kEdgeSamples - 1);
    least = std::min(least, area.pass_surface().at(t_edge, w).Su.norm());
  }
  return least;
}
double least_speed_across(const Area& area) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kEdgeSamples; ++i) {
    const double t = static_cast<double>(i) / (kEdgeSamples - 1);
    least = std::min(least, area.pass_surface().at(t, area.end_w).Sv.norm());
  }
  return least;
}

/// Longest usable interval along a line w = const.
double longest_interval(const Area& area, double w) {
  double longest = 0.0;
  for (int i = 0; i < kEdgeSamples; ++i) {
    const PassFrame frame = pass_frame(area.pass_surface(), CubicSpline::constant(w),
                                       static_cast<double>(i) / (kEdgeSamples - 1));
    longest =
        std::max(longest, interval_at(area, frame.shape, frame.unit_feed, IntervalRule::kExact).usable());
  }
  return longest;
}

}  // namespace

Area strip_behind(Area area, size_t k) {
  if (!area.zigzag) return area;
  const bool next_is_left_of_t = area.forward() * area.pass_surface().outward_sign() > 0.0;
  area.rim_sides = next_is_left_of_t == (k % 2 == 0) ? RimSides::kBothLeft : RimSides::kBothRight;
  return area;
}

bool gouges(const surface::Shape& shape, const Lean& lean, const ContactEnd& end) {
  const double concave = -surface::principal_curvatures(shape).low;
  // A tool over a hollow of curvature k sinks in by k r^2 / 2 at most.
  const double rounding = 2.0 * kNegligibleHeight / (end.radius() * end.radius());
  const double hollow = concave - rounding;
  return end.corner_mm * hollow > 1.0 ||
         end.flat_mm * hollow > std::sin(lean.angle) * (1.0 - end.corner_mm * hollow);
}

Interval interval_at(const Area& area, const surface::Shape& shape, const Vec2& feed, IntervalRule rule) {
  if (area.ball()) return ball_interval(area, shape, feed, rule);
  if (!area.lean.on_normal()) return leaned_interval(area, shape, feed);
  const double r = area.end.flat_mm;  // the corner of a bull nose is not counted on
  const double h = area.scallop_mm;
  Interval interval;
  const bool paper = rule == IntervalRule::kPaper;
  const double curvature = paper ? cross_curvature(shape.K, feed) : strip_curvature(shape.K, feed);
  interval.curvature = std::max(0.0, curvature);
  const double R = 1.0 / interval.curvature;
  interval.flat = 0.5 * r * r * interval.curvature < kNegligibleHeight;
  interval.reach_mm =
      reach_limit(2.0 * r, R, h) / (paper || interval.flat ? 1.0 : conjugate_stretch(shape.K, feed));
  interval.chord_mm = interval.flat ? interval.reach_mm : chord_for_scallop(R, h);
  return interval;
}

PassFrame pass_frame(const PassSurface& surface, const CubicSpline& w, double t) {
  const GraphPoint g = graph_point(surface, w, t);
  PassFrame frame{surface::shape_at(g.d, surface.outward_sign()), {}};
  frame.unit_feed = frame.shape.in_tangent(g.dp).normalized();
  return frame;
}

MinimumInterval minimum_interval(const Area& area, const CubicSpline& w, IntervalRule rule) {
  const PassSurface surface = area.pass_surface();
  const auto chord = [&](double t) {
    const PassFrame frame = pass_frame(surface, w, t);
    return interval_at(area, frame.shape, frame.unit_feed, rule).usable();
  };
  const Minimum least = least_sampled(chord, 0.0, 1.0, kSamples);
  return {least.value, least.at};
}

Strip measure_strip(const Area& area, const CubicSpline& previous, const CubicSpline& next, double t_low,
                    double t_high) {
  const PassSurface surface = area.pass_surface();
  const int n = std::max(8, static_cast<int>(std::ceil(kSamples * (t_high - t_low))));
  Strip strip{std::numeric_limits<double>::infinity(), 0.0, 0.0};
  for (int i = 0; i <= n; ++i) {
    const double t = t_low + (t_high - t_low) * i / n;
    const double w = next.at(t).w;
    const Vec3 q = surface.point(t, w);
    const double s = foot_on_pass(surface, previous, q, t);
    const double w_middle = 0.5 * (w + previous.at(s).w);
    if (area.beyond_end(w_middle)) continue;
    const GraphPoint before = graph_point(surface, previous, s);
    const surface::Shape shape =
        surface::shape_at(surface.at(0.5 * (s + t), w_middle), surface.outward_sign());
    const Vec3 feed = before.dp.normalized() + graph_point(surface, next, t).dp.normalized();
    const double chord = (q - before.p).norm();
    strip.chord_min_mm = std::min(strip.chord_min_mm, chord);
    strip.chord_max_mm = std::max(strip.chord_max_mm, chord);
    strip.scallop_max_mm =
        std::max(strip.scallop_max_mm, scallop_of(area, shape, shape.in_tangent(feed).normalized(), chord));
  }
  return strip;
}

void extend_beyond_edges(Area& area, double overrun_mm) {
  const Regularity inside = regularity(area, {0.0, 1.0}, {0.0, 1.0}, kEdgeSamples, kEdgeSamples);
  // "Well away from zero" is measured by the part itself: half of what it has at its worst.
  const auto regular = [&](const Vec2& t_range, const Vec2& w_range, int n_t, int n_w) {
    const Regularity found = regularity(area, t_range, w_range, n_t, n_w);
    return !found.gouges && found.least_area >= 0.5 * inside.least_area;
  };
  const double interval = std::max(longest_interval(area, area.start_w), longest_interval(area, area.end_w));
  const double low_speed = least_speed_along(area, 0.0);
  const double high_speed = least_speed_along(area, 1.0);
  area.continues_along = false;
  area.grid.first = 0.0;
  double last = 1.0;
  for (const double margin_mm : {overrun_mm + interval, overrun_mm}) {
    const double low = -margin_mm / low_speed;
    const double high = 1.0 + margin_mm / high_speed;
    if (margin_mm > 0.0 && regular({low, 0.0}, {0.0, 1.0}, kOutwardSamples, kEdgeSamples) &&
        regular({1.0, high}, {0.0, 1.0}, kOutwardSamples, kEdgeSamples)) {
      area.continues_along = true;
      area.grid.first = low;
      last = high;
      break;
    }
  }
  area.grid.step = (last - area.grid.first) / area.grid.intervals;
  const double across = interval / least_speed_across(area);
  area.continues_across = regular({area.grid.first, last}, {area.end_w, area.end_w + area.forward() * across},
                                  kEdgeSamples, kOutwardSamples);
}

}  // namespace swarf::toolpath
