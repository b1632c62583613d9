// TLON of CATIA, Mastercam and Creo, and what leads to it: INDIRV, PSIS, AUTOPS.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/units.h"
#include "program/cl/arc_angle.h"
#include "program/cl/steps.h"

namespace swarf::program::cldata {
namespace {

constexpr const char* kTlonForm =
    "TLON,GOFWD/(CIRCLE/cx,cy,cz,r),ON,(LINE/cx,cy,cz,x,y,z), with 2,INTOF behind ON for more than half a "
    "turn";

/// The move of TLON round circle_, whose normal has no sense yet. `second`: ON,2,INTOF.
void catia_circle(ClState& cl, const ClStatement& s, const Vec3& end_W, bool second) {
  if (!cl.path.positioned || !cl.arcs.direction_W || cl.drilling.cycle) {
    fault(cl.reporter, cl.drilling.cycle ? "bad-arc" : "no-position", s,
          cl.drilling.cycle    ? "an arc stands inside a cycle"
          : cl.path.positioned ? "TLON starts without a direction"
                               : "TLON moves from a position, and none has been given",
          cl.drilling.cycle    ? "write CYCLE/OFF before it"
          : cl.path.positioned ? "write INDIRV/i,j,k before it"
                               : "give FROM or GOTO first");
    return;
  }
  if (cl.arcs.circle->radius <= kArcTolerance) {
    fault(cl.reporter, "out-of-range", s,
          fmt::format("the circle's radius is {:g} mm", cl.arcs.circle->radius),
          fmt::format("it must be above {:g} mm", kArcTolerance));
    return;
  }
  if (!axis_stands(cl.reporter, cl.path, s)) return;
  const std::optional<double> sense =
      sense_along(cl.reporter, cl.path, cl.arcs, s, cl.arcs.circle->centre_W, cl.arcs.circle->normal_W);
  if (!sense) return;
  cl.arcs.circle->normal_W *= *sense;
  // The line runs through the centre: the circle meets it twice, half a turn apart, and the first crossing
  // comes within half a turn of the start.
  const double angle = swept_angle(cl.path.pose.tip_W - cl.arcs.circle->centre_W,
                                   end_W - cl.arcs.circle->centre_W, cl.arcs.circle->normal_W);
  const double slack = kArcTolerance / cl.arcs.circle->radius;
  if (second ? angle < kPi - slack : angle > kPi + slack) {
    fault(cl.reporter, "bad-arc", s,
          fmt::format("the end lies {:.3f} deg round the circle: that is the {} crossing with the line, and "
                      "TLON asks for the {}",
                      deg_from_rad(angle), second ? "first" : "second", second ? "second" : "first"),
          fmt::format("write {}", kTlonForm));
    return;
  }
  if (cl.arcs.part_surface) {
    for (const Vec3& tip : {cl.path.pose.tip_W, end_W}) {
      const double off = (tip - cl.arcs.part_surface->point_W).dot(cl.arcs.part_surface->normal_W);
      if (std::abs(off) <= kArcTolerance) continue;
      fault(cl.reporter, "bad-arc", s,
            fmt::format("an end of the arc lies {:.4f} mm beside the plane of PSIS", off),
            "both ends must lie in it");
      return;
    }
  }
  cl.path.turned = false;
  move_to(cl, s, {end_W, cl.path.axis_W});
}

}  // namespace

void direction(ClState& cl, const ClStatement& s) {
  if (s.word == "INDIRP") {
    if (!numbers(cl.reporter, s, 3, 3, "INDIRP/x,y,z")) return;
    if (!cl.path.positioned) {
      fault(cl.reporter, "no-position", s, "INDIRP points from a position, and none has been given",
            "give FROM or GOTO first");
      return;
    }
    cl.arcs.direction_W = cl.systems.X_WC * point_at(cl.systems, s, 0) - cl.path.pose.tip_W;
  } else {
    if (!numbers(cl.reporter, s, 3, 3, "INDIRV/i,j,k")) return;
    cl.arcs.direction_W =
        cl.systems.X_WC.linear() * Vec3(s.arguments[0].value, s.arguments[1].value, s.arguments[2].value);
  }
  if (cl.arcs.direction_W->norm() > 1e-9) return;
  fault(cl.reporter, "out-of-range", s, fmt::format("{} gives no direction", s.word),
        "give a vector that is not zero");
  cl.arcs.direction_W.reset();
}

std::optional<double> sense_along(Reporter& reporter, ClPath& path, ClArcs& arcs, const ClStatement& s,
                                  const Vec3& centre_W, const Vec3& axis_W) {
  const Vec3 arm = flat_in(path.pose.tip_W - centre_W, axis_W);
  const Vec3 tangent = axis_W.cross(arm).normalized();
  const double along = tangent.dot(arcs.direction_W->normalized());
  constexpr double kNearTangent = 0.9;  // 26 degrees: far from both senses is neither
  if (std::abs(along) >= kNearTangent) return along > 0.0 ? 1.0 : -1.0;
  fault(reporter, "bad-arc", s,
        fmt::format("INDIRV stands at {:.1f} deg to the circle where the tool is",
                    deg_from_rad(std::acos(std::min(1.0, std::abs(along))))),
        "give the direction in which the tool starts on the circle");
  return std::nullopt;
}

void part_surface(ClState& cl, const ClStatement& s) {
  cl.arcs.part_surface.reset();
  if (s.word == "AUTOPS") return;  // the plane through the tip, which an arc of constant height stays in
  Vec3 normal;
  if (fits(s, "PLANE POINT ### PERPTO VECTOR ###")) {
    if (!unit_vector(cl.reporter, s, 7, "normal of PSIS", normal)) return;
    cl.arcs.part_surface =
        Plane{cl.systems.X_WC * point_at(cl.systems, s, 2), cl.systems.X_WC.linear() * normal};
  } else if (fits(s, "PLANE ####")) {
    if (!unit_vector(cl.reporter, s, 1, "normal of PSIS", normal)) return;
    cl.arcs.part_surface = Plane{cl.systems.X_WC * Vec3(cl.systems.mm(s.arguments[4].value) * normal),
                                 cl.systems.X_WC.linear() * normal};
  } else {
    fault(cl.reporter, "unsupported-word", s, "this form of PSIS is not followed",
          "write PSIS/(PLANE/(POINT/x,y,z),PERPTO,(VECTOR/i,j,k)) or PSIS/(PLANE/i,j,k,d)");
  }
}

void tool_on(ClState& cl, const ClStatement& s) {
  // The second crossing of circle and line is written ON,2,INTOF.
  ClStatement plain = s;
  std::vector<ClArgument>& list = plain.arguments;
  const auto on = std::find_if(list.begin(), list.end(), [](const ClArgument& a) { return a.text == "ON"; });
  const bool counted = list.end() - on > 2 && (on + 2)->text == "INTOF";
  const bool second = counted && (on + 1)->value == 2.0;
  if (counted && (second || (on + 1)->value == 1.0)) list.erase(on + 1, on + 3);
  Vec3 axis = Vec3::UnitZ();
  const bool cylinder = fits(
      plain, "GOFWD CYLNDR ### ### # ON PLANE PERPTO PLANE POINT ### PERPTO VECTOR ### POINT ### POINT ###");
  if (!cylinder && !fits(plain, "GOFWD CIRCLE ### # ON LINE ### ###")) {
    fault(cl.reporter, "unsupported-word", s, "TLON moves along geometry that only an APT processor follows",
          fmt::format("write {}, or the motion as GOTO", kTlonForm));
    return;
  }
  if (cylinder && !unit_vector(cl.reporter, plain, 5, "axis of the cylinder", axis)) return;
  const size_t radius = cylinder ? 8 : 5;
  cl.arcs.circle = Circle{cl.systems.X_WC * point_at(cl.systems, plain, 2), cl.systems.X_WC.linear() * axis,
                          cl.systems.mm(list[radius].value), std::nullopt};
  catia_circle(cl, s, cl.systems.X_WC * point_at(cl.systems, plain, list.size() - 3), second);
  cl.arcs.circle.reset();
  cl.arcs.direction_W.reset();
  cl.path.rapid = false;
}

}  // namespace swarf::program::cldata
