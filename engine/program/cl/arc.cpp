#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/units.h"
#include "program/cl/arc_angle.h"
#include "program/cl/steps.h"

namespace swarf::program::cldata {
namespace {

/// False with a fault unless the points follow each other on the circle.
bool passes(Reporter& reporter, ClPath& path, ClArcs& arcs, const ClStatement& s,
            const std::vector<Vec3>& points) {
  double before = 0.0;
  for (const Vec3& point : points) {
    const Vec3 arm = point - arcs.circle->centre_W;
    const double radius = flat_in(arm, arcs.circle->normal_W).norm();
    const double angle = swept_angle(path.pose.tip_W - arcs.circle->centre_W, arm, arcs.circle->normal_W);
    if (std::abs(radius - arcs.circle->radius) <= kArcTolerance && angle > before) {
      before = angle;
      continue;
    }
    fault(reporter, "bad-arc", s,
          fmt::format("({:.4f}, {:.4f}, {:.4f}) is not the next point of the arc: it lies {:.4f} mm from the "
                      "circle, {:.3f} deg round it, the point before {:.3f} deg",
                      point.x(), point.y(), point.z(), std::abs(radius - arcs.circle->radius),
                      deg_from_rad(angle), deg_from_rad(before)),
          "give the points in their order, and CIRCLE with its sense");
    return false;
  }
  return true;
}

bool arc_fits(Reporter& reporter, ClPath& path, ClArcs& arcs, const ClStatement& s, const Vec3& from,
              const Vec3& to) {
  if (path.rapid) {
    fault(reporter, "bad-arc", s, "an arc stands in a rapid move",
          "take the RAPID away: an arc needs a feed");
    return false;
  }
  double least_height = kArcTolerance + 1.0;
  for (const Vec3& tip : {from, to}) {
    const Vec3 arm = tip - arcs.circle->centre_W;
    const double radius = flat_in(arm, arcs.circle->normal_W).norm();
    least_height = std::min(least_height, std::abs(arm.dot(arcs.circle->normal_W)));
    if (std::abs(radius - arcs.circle->radius) <= kArcTolerance) continue;
    fault(reporter, "bad-arc", s,
          fmt::format("({:.4f}, {:.4f}, {:.4f}) does not lie on the circle of radius {:.4f} mm: its "
                      "distance from the axis is {:.4f} mm",
                      tip.x(), tip.y(), tip.z(), arcs.circle->radius, radius),
          fmt::format("both ends must lie on the circle within {:g} mm", kArcTolerance));
    return false;
  }
  if (least_height <= kArcTolerance) return true;
  fault(reporter, "bad-arc", s, "neither end of the arc lies in the plane of its circle",
        fmt::format("one must, within {:g} mm; the other one may lie beside it where the arc is a helix",
                    kArcTolerance));
  return false;
}

}  // namespace

void circle(ClState& cl, const ClStatement& s) {
  const char* form = "CIRCLE/cx,cy,cz,i,j,k,r (unit vector)";
  // NX appends tolerances, the tool's diameter and corner radius, and TIMES with the turns of a helix.
  size_t count = s.arguments.size();
  std::optional<double> turns;
  if (count >= 2 && s.arguments[count - 2].text == "TIMES" && s.arguments[count - 1].number) {
    turns = s.arguments[count - 1].value;
    count -= 2;
  }
  // SolidWorks CAM leaves the radius out: the arc begins where the tool stands.
  const bool by_start = count == 6 && s.arguments.size() == 6;
  if (by_start && !cl.path.positioned) {
    fault(cl.reporter, "no-position", s,
          "CIRCLE without a radius begins where the tool stands, and no position "
          "stands before it",
          "give GOTO first");
    return;
  }
  if (count < 7 && !by_start) {
    fault(cl.reporter, "wrong-arguments", s, fmt::format("CIRCLE has {} arguments", s.arguments.size()),
          fmt::format("write {}", form));
    return;
  }
  for (size_t i = 0; i < count; ++i) {
    if (s.arguments[i].number) continue;
    fault(cl.reporter, "wrong-arguments", s.arguments[i],
          fmt::format("CIRCLE takes numbers, '{}' is none", s.arguments[i].text),
          fmt::format("write {}", form));
    return;
  }
  Vec3 axis;
  if (!unit_vector(cl.reporter, s, 3, "circle's axis", axis)) return;
  const Vec3 arm_W = cl.path.pose.tip_W - cl.systems.X_WC * point_at(cl.systems, s, 0);
  const double radius =
      by_start ? flat_in(arm_W, cl.systems.X_WC.linear() * axis).norm() : cl.systems.mm(s.arguments[6].value);
  if (radius <= kArcTolerance) {
    fault(cl.reporter, "out-of-range", by_start ? s.arguments[0] : s.arguments[6],
          fmt::format("the circle's radius is {:g} mm", radius),
          fmt::format("it must be above {:g} mm", kArcTolerance));
    return;
  }
  if (turns && !(*turns > 0.0 && *turns <= 10000.0)) {
    fault(cl.reporter, "out-of-range", s.arguments.back(), fmt::format("the helix has {:g} turns", *turns),
          "write TIMES,n with n above 0");
    return;
  }
  if (cl.drilling.cycle) {
    fault(cl.reporter, "bad-arc", s, "an arc stands inside a cycle", "write CYCLE/OFF before it");
    return;
  }
  const Vec3 axis_W = cl.systems.X_WC.linear() * axis,
             centre_W = cl.systems.X_WC * point_at(cl.systems, s, 0);
  std::optional<double> sense = circle_sense(cl.options, cl.program);
  if (cl.arcs.direction_W && cl.path.positioned) {
    sense = sense_along(cl.reporter, cl.path, cl.arcs, s, centre_W, axis_W);
    cl.arcs.direction_W.reset();
    if (!sense) return;
  }
  if (!sense) {
    fault(
        cl.reporter, "circle-sense", s,
        "CIRCLE runs clockwise about its vector with NX and counter-clockwise with Creo, and this file does "
        "not show who wrote it",
        "write cl_circle = \"clockwise\" or \"counter_clockwise\" in the scene (swarf check --circle), or "
        "INDIRV before it");
    return;
  }
  cl.arcs.circle = Circle{centre_W, *sense * axis_W, radius, turns};
}

/// ISO 4343: counter-clockwise about its vector, round an angle that stands with it.
void move_arc(ClState& cl, const ClStatement& s) {
  const bool form = s.arguments.size() == 9 && s.arguments[7].text == "ANGLE" &&
                    std::all_of(s.arguments.begin(), s.arguments.end(),
                                [&](const ClArgument& one) { return one.number || &one == &s.arguments[7]; });
  if (!form) {
    fault(cl.reporter, "wrong-arguments", s, "MOVARC takes a centre, a vector, a radius and an angle",
          "write MOVARC/cx,cy,cz,i,j,k,r,ANGLE,a (a in degrees)");
    return;
  }
  Vec3 axis;
  if (!unit_vector(cl.reporter, s, 3, "arc's axis", axis)) return;
  const double radius = cl.systems.mm(s.arguments[6].value), degrees = s.arguments[8].value;
  if (radius <= kArcTolerance || !(degrees > 0.0 && degrees <= 3.6e6)) {
    fault(cl.reporter, "out-of-range", s,
          fmt::format("the arc has a radius of {:g} mm and goes round {:g} deg", radius, degrees),
          fmt::format("both are above zero, the radius above {:g} mm", kArcTolerance));
    return;
  }
  if (cl.drilling.cycle) {
    fault(cl.reporter, "bad-arc", s, "an arc stands inside a cycle", "write CYCLE/OFF before it");
    return;
  }
  cl.arcs.circle = Circle{cl.systems.X_WC * point_at(cl.systems, s, 0), cl.systems.X_WC.linear() * axis,
                          radius, degrees / 360.0};
}

void go_round(ClState& cl, const ClStatement& s) {
  const char* form = "the points of the arc as x,y,z, or as x,y,z,i,j,k under MULTAX/ON; the last is its end";
  if (!all_numbers(cl.reporter, s, form)) return;
  const size_t count = s.arguments.size();
  const auto value = [&](size_t i) { return s.arguments[i].value; };
  const bool one =
      count == 6 && std::abs(Vec3(value(3), value(4), value(5)).norm() - 1.0) <= kAxisLengthTolerance;
  const size_t step = cl.path.multi_axis || one ? 6 : 3;
  if (count % step != 0) {
    fault(cl.reporter, "wrong-arguments", s, fmt::format("GOTO has {} numbers", count),
          fmt::format("write {}", form));
    return;
  }
  std::vector<Vec3> points;
  ToolPose to{cl.path.pose.tip_W, cl.path.axis_W};
  for (size_t i = 0; i < count; i += step) {
    points.push_back(cl.systems.X_WC * point_at(cl.systems, s, i));
    if (step == 6 && !unit_vector(cl.reporter, s, i + 3, "tool axis", to.axis_W)) return;
  }
  if (step == 6) to.axis_W = cl.systems.X_WC.linear() * to.axis_W;
  to.tip_W = points.back();
  if (step == 3 && !axis_stands(cl.reporter, cl.path, s)) return;
  cl.path.axis_known = true;
  cl.path.turned = false;
  if (cl.path.positioned && !passes(cl.reporter, cl.path, cl.arcs, s, points)) return;
  move_to(cl, s, to);
}

bool continues_arc(Reporter& reporter, ClPath& path, ClArcs& arcs, const ClStatement& s, const Vec3& to) {
  const std::optional<Circle> arc = std::exchange(arcs.rounded, std::nullopt);
  if (arcs.circle || !arc || path.rapid) return false;
  const Vec3 arm = to - arc->centre_W, before = path.pose.tip_W - arc->centre_W;
  const bool on_circle = std::abs(flat_in(arm, arc->normal_W).norm() - arc->radius) <= kArcTolerance &&
                         std::abs((arm - before).dot(arc->normal_W)) <= kArcTolerance;
  constexpr double kAlmostHalf = 0.99 * kPi;  // what closes a half circle is its diameter
  if (!on_circle || swept_angle(before, arm, arc->normal_W) > kAlmostHalf) return false;
  fault(reporter, "bad-arc", s,
        "this point lies on the arc that has just ended: Creo may list it as a further point of the arc, or "
        "mean a straight line",
        "give the points of an arc in one GOTO behind its CIRCLE, or output one point for each arc");
  return true;
}

void add_arc(ClState& cl, const ClStatement& s, const ToolPose& to) {
  const Circle circle = *cl.arcs.circle;
  const ToolPose from = cl.path.pose;
  if (!arc_fits(cl.reporter, cl.path, cl.arcs, s, from.tip_W, to.tip_W)) {
    cl.path.pose = to;
    return;
  }
  const Vec3& n = circle.normal_W;
  const double last = swept_angle(from.tip_W - circle.centre_W, to.tip_W - circle.centre_W, n);
  const double whole = circle.turns ? 2.0 * kPi * *circle.turns : last;
  const double further = std::round((whole - last) / (2.0 * kPi));
  if (further < 0.0 || std::abs(whole - last - 2.0 * kPi * further) * circle.radius > kArcTolerance) {
    fault(cl.reporter, "bad-arc", s,
          fmt::format("TIMES says {:g} turns, and the end lies {:.3f} deg round the circle", *circle.turns,
                      deg_from_rad(last)),
          "both must agree: write TIMES with the turns and their fraction");
    return;
  }
  const double rise = (to.tip_W - from.tip_W).dot(n), total = last + 2.0 * kPi * further;
  // A helix has its centre at the height where each of its turns begins.
  const bool helix = std::abs(rise) > kArcTolerance;
  const auto arc_from = [&](const Vec3& tip) {
    const Vec3 up = helix ? Vec3((tip - circle.centre_W).dot(n) * n) : Vec3(Vec3::Zero());
    return Arc{circle.centre_W + up, n};
  };
  for (int i = 1; i <= static_cast<int>(further); ++i) {
    const double share = 2.0 * kPi * i / total;
    const Vec3 axis = (from.axis_W + share * (to.axis_W - from.axis_W)).normalized();
    send(cl, s, {from.tip_W + share * rise * n, axis}, arc_from(cl.path.pose.tip_W), cl.feed.feed_mm_s, 0.0);
  }
  send(cl, s, to, arc_from(cl.path.pose.tip_W), cl.feed.feed_mm_s, 0.0);
  if (cl.program.writer == ClWriter::kCreo) cl.arcs.rounded = circle;
}

}  // namespace swarf::program::cldata
