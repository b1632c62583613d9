// TLON of CATIA, Mastercam and Creo, and what leads to it: INDIRV, PSIS, AUTOPS.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/units.h"
#include "program/cl/arc_angle.h"
#include "program/cl/interpreter.h"

namespace swarf::program {
namespace {

constexpr const char* kTlonForm =
    "TLON,GOFWD/(CIRCLE/cx,cy,cz,r),ON,(LINE/cx,cy,cz,x,y,z), with 2,INTOF behind ON for more than half a "
    "turn";

}  // namespace

void ClInterpreter::direction(const ClStatement& s) {
  if (s.word == "INDIRP") {
    if (!numbers(s, 3, 3, "INDIRP/x,y,z")) return;
    if (!positioned_) {
      fault("no-position", s, "INDIRP points from a position, and none has been given",
            "give FROM or GOTO first");
      return;
    }
    direction_W_ = X_WC_ * point_at(s, 0) - pose_.tip_W;
  } else {
    if (!numbers(s, 3, 3, "INDIRV/i,j,k")) return;
    direction_W_ = X_WC_.linear() * Vec3(s.arguments[0].value, s.arguments[1].value, s.arguments[2].value);
  }
  if (direction_W_->norm() > 1e-9) return;
  fault("out-of-range", s, fmt::format("{} gives no direction", s.word), "give a vector that is not zero");
  direction_W_.reset();
}

std::optional<double> ClInterpreter::sense_along(const ClStatement& s, const Vec3& centre_W,
                                                 const Vec3& axis_W) {
  const Vec3 arm = flat_in(pose_.tip_W - centre_W, axis_W);
  const Vec3 tangent = axis_W.cross(arm).normalized();
  const double along = tangent.dot(direction_W_->normalized());
  constexpr double kNearTangent = 0.9;  // 26 degrees: far from both senses is neither
  if (std::abs(along) >= kNearTangent) return along > 0.0 ? 1.0 : -1.0;
  fault("bad-arc", s,
        fmt::format("INDIRV stands at {:.1f} deg to the circle where the tool is",
                    deg_from_rad(std::acos(std::min(1.0, std::abs(along))))),
        "give the direction in which the tool starts on the circle");
  return std::nullopt;
}

void ClInterpreter::part_surface(const ClStatement& s) {
  part_surface_.reset();
  if (s.word == "AUTOPS") return;  // the plane through the tip, which an arc of constant height stays in
  Vec3 normal;
  if (fits(s, "PLANE POINT ### PERPTO VECTOR ###")) {
    if (!unit_vector(s, 7, "normal of PSIS", normal)) return;
    part_surface_ = Plane{X_WC_ * point_at(s, 2), X_WC_.linear() * normal};
  } else if (fits(s, "PLANE ####")) {
    if (!unit_vector(s, 1, "normal of PSIS", normal)) return;
    part_surface_ = Plane{X_WC_ * Vec3(mm(s.arguments[4].value) * normal), X_WC_.linear() * normal};
  } else {
    fault("unsupported-word", s, "this form of PSIS is not followed",
          "write PSIS/(PLANE/(POINT/x,y,z),PERPTO,(VECTOR/i,j,k)) or PSIS/(PLANE/i,j,k,d)");
  }
}

void ClInterpreter::tool_on(const ClStatement& s) {
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
    fault("unsupported-word", s, "TLON moves along geometry that only an APT processor follows",
          fmt::format("write {}, or the motion as GOTO", kTlonForm));
    return;
  }
  if (cylinder && !unit_vector(plain, 5, "axis of the cylinder", axis)) return;
  const size_t radius = cylinder ? 8 : 5;
  circle_ = Circle{X_WC_ * point_at(plain, 2), X_WC_.linear() * axis, mm(list[radius].value), std::nullopt};
  catia_circle(s, X_WC_ * point_at(plain, list.size() - 3), second);
  circle_.reset();
  direction_W_.reset();
  rapid_ = false;
}

void ClInterpreter::catia_circle(const ClStatement& s, const Vec3& end_W, bool second) {
  if (!positioned_ || !direction_W_ || cycle_) {
    fault(cycle_ ? "bad-arc" : "no-position", s,
          cycle_        ? "an arc stands inside a cycle"
          : positioned_ ? "TLON starts without a direction"
                        : "TLON moves from a position, and none has been given",
          cycle_        ? "write CYCLE/OFF before it"
          : positioned_ ? "write INDIRV/i,j,k before it"
                        : "give FROM or GOTO first");
    return;
  }
  if (circle_->radius <= kArcTolerance) {
    fault("out-of-range", s, fmt::format("the circle's radius is {:g} mm", circle_->radius),
          fmt::format("it must be above {:g} mm", kArcTolerance));
    return;
  }
  const std::optional<double> sense = sense_along(s, circle_->centre_W, circle_->normal_W);
  if (!sense) return;
  circle_->normal_W *= *sense;
  // The line runs through the centre: the circle meets it twice, half a turn apart, and the first crossing
  // comes within half a turn of the start.
  const double angle =
      swept_angle(pose_.tip_W - circle_->centre_W, end_W - circle_->centre_W, circle_->normal_W);
  const double slack = kArcTolerance / circle_->radius;
  if (second ? angle < kPi - slack : angle > kPi + slack) {
    fault("bad-arc", s,
          fmt::format("the end lies {:.3f} deg round the circle: that is the {} crossing with the line, and "
                      "TLON asks for the {}",
                      deg_from_rad(angle), second ? "first" : "second", second ? "second" : "first"),
          fmt::format("write {}", kTlonForm));
    return;
  }
  if (part_surface_) {
    for (const Vec3& tip : {pose_.tip_W, end_W}) {
      const double off = (tip - part_surface_->point_W).dot(part_surface_->normal_W);
      if (std::abs(off) <= kArcTolerance) continue;
      fault("bad-arc", s, fmt::format("an end of the arc lies {:.4f} mm beside the plane of PSIS", off),
            "both ends must lie in it");
      return;
    }
  }
  move_to(s, {end_W, axis_W_});
}

}  // namespace swarf::program
