#include "toolpath/pass_family.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "toolpath/constant_scallop.h"
#include "toolpath/isoparametric.h"
#include "toolpath/lin_koren.h"

namespace swarf::toolpath {
namespace {

/// Places along the last boundary at which the remaining material is looked at.
constexpr int kBoundarySamples = 256;
/// A cusp on the last boundary may exceed the scallop by this share before another pass is spent on it.
constexpr double kSpareShare = 1e-3;

/// Distance from a pass to the last boundary at t, square to the pass, mm.
double distance_to_boundary(const Area& area, const CubicSpline& pass, double t) {
  const PassSurface surface = area.pass_surface();
  const GraphPoint g = graph_point(surface, pass, t);
  const Vec3 gap = surface.point(t, area.end_w) - g.p;
  return (gap - g.dp * g.dp.dot(gap) / g.dp.squaredNorm()).norm();
}

/// Height of the material that a pass leaves on the last boundary at t.
double left_on_boundary(const Area& area, const CubicSpline& pass, double t) {
  const PassSurface surface = area.pass_surface();
  const surface::Shape edge = surface::shape_at(surface.at(t, area.end_w), surface.outward_sign());
  if (area.ball()) return canal_height(area, pass, edge.point, edge.normal, t).height_mm;
  if (area.lean.on_normal()) return envelope_height(area, pass, edge.point, edge.normal, t).height_mm;
  // A pass of the same kind, as far beyond the boundary, would leave a cusp of this height on it.
  const Vec2 feed = edge.in_tangent(graph_point(surface, pass, t).dp).normalized();
  const double wanted = interval_at(area, edge, feed, IntervalRule::kExact).usable();
  return area.scallop_mm * std::pow(2.0 * distance_to_boundary(area, pass, t) / wanted, 2);
}

/// True where a pass leaves more than the scallop between itself and the last boundary; on a flat surface,
/// where there is no scallop, when the boundary is out of the cutter's reach.
bool open_at(const Area& area, const CubicSpline& pass, double t) {
  if (area.beyond_end(pass.at(t).w)) return false;
  // Not a number where a ball passes beside the boundary.
  return !(left_on_boundary(area, pass, t) <= area.scallop_mm * (1.0 + kSpareShare)) ||
         distance_to_boundary(area, pass, t) > area.clean_mm() * (1.0 + kSpareShare);
}

/// The parts of 0..1 where the next pass is needed, each one sample longer than seen.
std::vector<Span> open_spans(const Area& area, const CubicSpline& pass) {
  std::vector<Span> spans;
  constexpr double kStep = 1.0 / kBoundarySamples;
  for (int i = 0; i <= kBoundarySamples; ++i) {
    const double t = i * kStep;
    if (!open_at(area, pass, t)) continue;
    const Span here{std::max(0.0, t - kStep), std::min(1.0, t + kStep)};
    if (!spans.empty() && here.t_low <= spans.back().t_high) {
      spans.back().t_high = here.t_high;
    } else {
      spans.push_back(here);
    }
  }
  return spans;
}

std::vector<Span> lengthened(const Area& area, const CubicSpline& w, const std::vector<Span>& spans,
                             double overrun_mm) {
  std::vector<Span> result;
  for (const Span& span : spans) {
    const Span longer = with_overrun(area, w, span, overrun_mm);
    if (!result.empty() && longer.t_low <= result.back().t_high) {
      result.back().t_high = longer.t_high;
    } else {
      result.push_back(longer);
    }
  }
  return result;
}

/// Keeps a pass on the part where the surface does not continue beyond the last boundary.
CubicSpline held_at_boundary(const Area& area, const CubicSpline& w) {
  std::vector<double> values(area.grid.size());
  for (int j = 0; j < area.grid.size(); ++j) {
    const double value = w.at(area.grid.t(j)).w;
    values[j] = area.beyond_end(value) ? area.end_w : value;
  }
  return {area.grid.first, area.grid.step, std::move(values)};
}

FamilyPass measured_pass(const Area& area, const CubicSpline& previous, CubicSpline w,
                         const std::vector<Span>& open, double overrun_mm) {
  FamilyPass pass;
  pass.interval_mm = 2.0 * area.end.radius();
  for (const Span& span : open) {
    const Strip strip = measure_strip(area, previous, w, span.t_low, span.t_high);
    pass.interval_mm = std::min(pass.interval_mm, strip.chord_min_mm);
    pass.scallop_theory_mm = std::max(pass.scallop_theory_mm, strip.scallop_max_mm);
  }
  pass.spans = lengthened(area, w, open, overrun_mm);
  pass.w = std::move(w);
  return pass;
}

FamilyPass first_pass(const Area& area, double overrun_mm) {
  FamilyPass pass;
  pass.w = CubicSpline::constant(area.start_w);
  pass.spans = {with_overrun(area, pass.w, {}, overrun_mm)};
  return pass;
}

Family plan_isoparametric(const Area& area, double overrun_mm) {
  Family family;
  family.passes.push_back(first_pass(area, overrun_mm));
  family.unreachable = beyond_reach(area, family.passes.back().w, IntervalRule::kExact);
  if (!family.unreachable.empty()) return family;
  const std::vector<double> constants = isoparametric_passes(area);
  for (size_t i = 1; i < constants.size() && family.unreachable.empty(); ++i) {
    CubicSpline w = CubicSpline::constant(constants[i]);
    family.unreachable = beyond_reach(area, w, IntervalRule::kExact);
    const CubicSpline previous = family.passes.back().w;
    family.passes.push_back(
        measured_pass(strip_behind(area, i - 1), previous, std::move(w), {Span{}}, overrun_mm));
  }
  return family;
}

}  // namespace

Span with_overrun(const Area& area, const CubicSpline& w, Span span, double overrun_mm) {
  const SurfaceCurve curve{area.along_u, w};
  return {std::max(area.grid.first, travel_along(*area.surface, curve, span.t_low, -overrun_mm)),
          std::min(area.grid.last(), travel_along(*area.surface, curve, span.t_high, overrun_mm))};
}

std::vector<ReachProblem> beyond_reach(const Area& area, const CubicSpline& w, IntervalRule rule) {
  constexpr double kRounding = 1e-9;
  const PassSurface surface = area.pass_surface();
  std::vector<ReachProblem> worst;
  for (int i = 0; i <= kBoundarySamples; ++i) {
    const double t = static_cast<double>(i) / kBoundarySamples;
    const double across = w.at(t).w;
    if (across < 0.0 || across > 1.0) continue;
    const PassFrame frame = pass_frame(surface, w, t);
    const Interval interval = interval_at(area, frame.shape, frame.unit_feed, rule);
    const double ratio = interval.chord_mm / interval.reach_mm;
    if (ratio <= 1.0 + kRounding) continue;
    if (!worst.empty() && ratio <= worst[0].interval.chord_mm / worst[0].interval.reach_mm) continue;
    worst = {{surface.u(t, across), surface.v(t, across), interval}};
  }
  return worst;
}

Family plan_family(const Area& area, Planner planner, double overrun_mm) {
  if (planner == Planner::kIsoparametric) return plan_isoparametric(area, overrun_mm);
  const bool paper = planner == Planner::kLinKoren;
  Family family;
  family.passes.push_back(first_pass(area, overrun_mm));
  while (true) {
    const CubicSpline previous = family.passes.back().w;
    family.unreachable = beyond_reach(area, previous, paper ? IntervalRule::kPaper : IntervalRule::kExact);
    const Area strip = strip_behind(area, family.passes.size() - 1);
    const std::vector<Span> open = open_spans(strip, previous);
    if (open.empty() || !family.unreachable.empty()) return family;
    NextPass next = paper ? next_lin_koren(strip, previous) : next_constant_scallop(strip, previous);
    family.outcome = next.outcome;
    family.failed_t = next.t;
    if (next.outcome != NextPass::kOk) return family;
    if (!area.continues_across) next.w = held_at_boundary(area, next.w);
    family.passes.push_back(measured_pass(strip, previous, std::move(next.w), open, overrun_mm));
  }
}

}  // namespace swarf::toolpath
