#include "toolpath/alarms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace swarf::toolpath {
namespace {

/// Places per direction at which curvatures are looked at.
constexpr int kGrid = 33;

struct WorstPlace {
  double t = 0.0, w = 0.0;
  double concave = 0.0;  ///< greatest concave curvature, 1/mm
  double convex = 0.0;   ///< greatest convex curvature at the same place
};

WorstPlace most_concave(const Area& area, double w_low, double w_high) {
  const PassSurface surface = area.pass_surface();
  WorstPlace worst;
  for (int i = 0; i < kGrid; ++i) {
    for (int j = 0; j < kGrid; ++j) {
      const double t = static_cast<double>(i) / (kGrid - 1);
      const double w = w_low + (w_high - w_low) * j / (kGrid - 1);
      const surface::Shape shape = surface::shape_at(surface.at(t, w), surface.outward_sign());
      const surface::PrincipalCurvatures k = surface::principal_curvatures(shape);
      if (-k.low > worst.concave) worst = {t, w, -k.low, k.high};
    }
  }
  return worst;
}

double round_up(double value, double unit) {
  return std::ceil(value / unit) * unit;
}

std::string lean_advice(const WorstPlace& worst, const ContactEnd& end) {
  const double left = 1.0 - end.corner_mm * worst.concave;
  const double sine = end.flat_mm * worst.concave / left;
  if (left <= 0.0 || sine >= 1.0)
    return fmt::format(
        "no lean lets a cutter of radius {:.6g} mm into a hollow of radius {:.6g} mm; use a cutter "
        "below {:.6g} mm diameter{}",
        end.radius(), 1.0 / worst.concave, 2.0 / worst.concave, end.ball() ? "" : " with lead");
  // By the hundredth of a degree upwards, so that the advice itself passes the check.
  return fmt::format("lean the tool by at least {:.2f} degrees, {}, for example with lead I{:.2f}",
                     round_up(deg_from_rad(std::asin(sine)), 0.01),
                     end.corner_mm > 0.0 ? "asin(flat / (Rc - corner))" : "asin(r / Rc)",
                     round_up(deg_from_rad(std::asin(sine)), 0.01));
}

/// A scallop in mm rounded down to three digits, so that it still works.
double round_down(double h) {
  const double unit = std::pow(10.0, std::floor(std::log10(h)) - 2.0);
  return std::floor(h / unit) * unit;
}

const char* end_name(const ContactEnd& end) {
  if (end.ball()) return "ball end";
  return end.corner_mm > 0.0 ? "bull nose" : "flat end";
}

/// How deep a tool on the normal sinks into a hollow of radius Rc, wider than the tool: a flat end with its
/// rim, measured along the axis; a bull nose with the place of its corner that lies farthest from the middle.
double depth_on_normal(const ContactEnd& end, double Rc) {
  const double r = end.flat_mm;
  if (end.corner_mm == 0.0) return r * r / (Rc + std::sqrt(Rc * Rc - r * r));
  return std::hypot(r, Rc - end.corner_mm) + end.corner_mm - Rc;
}

void report_reach(const Area& area, const ReachProblem& problem, const OperationContext& context,
                  Diagnostics& diagnostics) {
  const double D = context.diameter_mm;
  std::string fix = "take a larger cutter";
  if (area.ball()) {
    fix = "take a smaller scallop E or a larger cutter";
  } else if (area.lean.on_normal()) {
    // Flattest place of the part: what works there works everywhere.
    double flattest = problem.interval.curvature;
    for (int i = 0; i < kGrid; ++i) {
      const CubicSpline w = CubicSpline::constant(static_cast<double>(i) / (kGrid - 1));
      for (int j = 0; j < kGrid; ++j) {
        const PassFrame frame = pass_frame(area.pass_surface(), w, static_cast<double>(j) / (kGrid - 1));
        const Interval there = interval_at(area, frame.shape, frame.unit_feed, IntervalRule::kExact);
        if (!there.flat) flattest = std::min(flattest, there.curvature);
      }
    }
    const double chord_share =
        problem.interval.reach_mm * (1.0 + area.scallop_mm * problem.interval.curvature) / D;
    const double largest = largest_reachable_scallop(D * chord_share, 1.0 / flattest);
    fix = fmt::format("the largest scallop that works with this cutter is about E{:.3g} mm; or {}",
                      round_down(largest), fix);
  } else {
    fix = "take a smaller scallop E, a larger cutter, or less tilt";
  }
  diagnostics.error(
      "interval-beyond-cutter", context.operation->where,
      fmt::format(
          "surface P{} at u={:.4f}, v={:.4f}: a scallop of {:.6g} mm asks for a path interval of {:.6g} mm, "
          "but the cutter of {:.6g} mm diameter reaches the cusp only up to {:.6g} mm",
          context.surface_number, problem.u, problem.v, area.scallop_mm, problem.interval.chord_mm, D,
          problem.interval.reach_mm),
      fix);
}

}  // namespace

bool check_gouging(const Area& area, double w_low, double w_high, const OperationContext& context,
                   Diagnostics& diagnostics) {
  const WorstPlace worst = most_concave(area, w_low, w_high);
  const PassSurface surface = area.pass_surface();
  if (!gouges(surface::shape_at(surface.at(worst.t, worst.w), surface.outward_sign()), area.lean, area.end))
    return true;
  const double Rc = 1.0 / worst.concave;
  std::string what = fmt::format(
      "surface P{} is {} at u={:.4f}, v={:.4f} (concave radius {:.6g} mm); the {} of {:.6g} mm "
      "diameter ",
      context.surface_number, worst.convex > 0.0 ? "a saddle" : "concave", surface.u(worst.t, worst.w),
      surface.v(worst.t, worst.w), Rc, end_name(area.end), context.diameter_mm);
  if (area.ball())
    what += "does not fit in";
  else if (!area.lean.on_normal())
    what +=
        fmt::format("leaned by {:.2f} degrees gouges with its heel or flank", deg_from_rad(area.lean.angle));
  else if (Rc > area.end.radius())
    what += fmt::format("standing on the normal gouges {:.6g} mm deep", depth_on_normal(area.end, Rc));
  else
    what += "standing on the normal does not fit in";
  diagnostics.error("saddle-or-concave", context.operation->where, what, lean_advice(worst, area.end));
  return false;
}

bool check_lean(const Area& area, const OperationContext& context, Diagnostics& diagnostics) {
  // Beyond 60 degrees of yaw the swept rim is narrower than the radius and the cusps become saw teeth, which
  // the parabola of theory 1.1 does not describe.
  constexpr double kLeastCosine = 0.5;
  if (area.ball() || area.lean.on_normal() || std::abs(std::cos(area.lean.yaw)) >= kLeastCosine) return true;
  // tan(yaw) = sin(tilt) / tan(lead).
  const double least_lead =
      std::atan(std::abs(std::sin(context.operation->tilt_rad)) / std::tan(std::acos(kLeastCosine)));
  diagnostics.error(
      "tilt-without-lead", context.operation->where,
      fmt::format(
          "tilt J{:.6g} with lead I{:.6g} degrees cuts with the corner of the flat end: saw teeth instead of "
          "scallops",
          deg_from_rad(context.operation->tilt_rad), deg_from_rad(context.operation->lead_rad)),
      fmt::format("give a lead of at least {:.2f} degrees beside this tilt, or no tilt",
                  round_up(deg_from_rad(least_lead), 0.01)));
  return false;
}

bool check_pass_count(const Area& area, const OperationContext& context, Diagnostics& diagnostics) {
  constexpr double kMostPasses = 20000.0;
  const double chord =
      minimum_interval(area, CubicSpline::constant(area.start_w), IntervalRule::kExact).chord_mm;
  const SurfaceCurve side{!area.along_u, CubicSpline::constant(0.5)};
  const double width = curve_length(*area.surface, side, 0.0, 1.0);
  if (width / chord <= kMostPasses) return true;
  const double share = width / chord / kMostPasses;
  diagnostics.error(
      "too-many-passes", context.operation->where,
      fmt::format(
          "a scallop of {:.6g} mm needs about {:.0f} passes of {:.3g} mm interval; {:.0f} is the most "
          "that is planned",
          area.scallop_mm, width / chord, chord, kMostPasses),
      fmt::format("use a scallop of E{:.3g} mm or more", area.scallop_mm * share * share));
  return false;
}

void report_family(const Area& area, const Family& family, const OperationContext& context,
                   Diagnostics& diagnostics) {
  const SourceLocation& where = context.operation->where;
  for (const ReachProblem& problem : family.unreachable) report_reach(area, problem, context, diagnostics);
  if (family.outcome != NextPass::kOk) {
    const double w = family.passes.back().w.at(family.failed_t).w;
    diagnostics.error(
        "path-folds", where,
        fmt::format("surface P{}: the pass after pass {} {} near u={:.4f}, v={:.4f}", context.surface_number,
                    family.passes.size(),
                    family.outcome == NextPass::kFolds ? "would fold over itself" : "cannot be found",
                    area.pass_surface().u(family.failed_t, w), area.pass_surface().v(family.failed_t, w)),
        "start from another boundary (B), use the isoparametric planner, or split the surface there");
  }
  if (!area.continues_along)
    diagnostics.note(
        "no-overrun", where,
        fmt::format("surface P{} does not continue beyond the ends of the passes: they stop at the "
                    "edge of the part",
                    context.surface_number));
  if (!area.continues_across)
    diagnostics.note(
        "no-continuation", where,
        fmt::format("surface P{} does not continue beyond the last boundary: the last pass lies on it",
                    context.surface_number));
}

}  // namespace swarf::toolpath
