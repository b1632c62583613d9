#include "kinematics/reach.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/units.h"
#include "kinematics/model_check.h"

namespace swarf::kinematics {
namespace {

/// Less than this is rounding of the angle itself, rad.
constexpr double kAngleRounding = 1e-12;

std::string vector_text(const Vec3& v) {
  return fmt::format("({:.4f}, {:.4f}, {:.4f})", v.x(), v.y(), v.z());
}

std::string reach_text(const AxisReach& reach) {
  const double low = deg_from_rad(reach.angle_min), high = deg_from_rad(reach.angle_max);
  return reach.angle_max - reach.angle_min < kAngleRounding ? fmt::format("exactly {:.4g} deg", low)
                                                            : fmt::format("{:.4g} .. {:.4g} deg", low, high);
}

}  // namespace

AxisReach axis_reach(const MachineModel& machine) {
  const std::vector<int> order = rotary_order(machine);
  const Mat3 R_WM = machine.X_MW.linear().transpose();
  const Vec3 tool_W = R_WM * machine.tool_axis_M;
  if (order.empty()) return {"", tool_W, 0.0, 0.0};
  const auto at = [&](int axis) -> const Axis& { return machine.axes[static_cast<size_t>(axis)]; };
  const Axis& outer = at(order.front());
  const Vec3& inner_M = at(order.back()).direction_M;
  const double a = angle_between(outer.direction_M, inner_M);
  const double b = angle_between(inner_M, machine.tool_axis_M);
  return {outer.name, R_WM * outer.direction_M, std::abs(a - b), kPi - std::abs(kPi - (a + b))};
}

double missing_angle(const AxisReach& reach, const Vec3& axis_W) {
  const double angle = angle_between(reach.about_W, axis_W);
  if (angle < reach.angle_min - kAngleRounding) return angle - reach.angle_min;
  if (angle > reach.angle_max + kAngleRounding) return angle - reach.angle_max;
  return 0.0;
}

Vec3 nearest_in_reach(const AxisReach& reach, const Vec3& axis_W) {
  const double angle = std::clamp(angle_between(reach.about_W, axis_W), reach.angle_min, reach.angle_max);
  Vec3 across = axis_W - axis_W.dot(reach.about_W) * reach.about_W;
  across = across.norm() > kAngleRounding * axis_W.norm() ? Vec3(across.normalized())
                                                          : Vec3(reach.about_W.unitOrthogonal());
  return std::cos(angle) * reach.about_W + std::sin(angle) * across;
}

UnreachableText unreachable_text(const MachineModel& machine, const ToolPose& pose_W) {
  const Vec3& tip = pose_W.tip_W;
  const std::string pose = fmt::format("tip ({:.3f}, {:.3f}, {:.3f}) mm, axis {}", tip.x(), tip.y(), tip.z(),
                                       vector_text(pose_W.axis_W));
  const AxisReach reach = axis_reach(machine);
  const double missing = missing_angle(reach, pose_W.axis_W);
  if (missing == 0.0) {
    return {
        fmt::format("the machine has no axis values for {}: its linear axes do not span space there", pose),
        "give positions that the machine reaches"};
  }
  const std::string about = reach.about.empty() ? "the spindle" : fmt::format("the {} axis", reach.about);
  return {fmt::format("the machine has no axis values for {}: the tool would stand at {:.4g} deg to {}, the "
                      "machine reaches {}; {:.4g} deg are missing",
                      pose, deg_from_rad(angle_between(reach.about_W, pose_W.axis_W)), about,
                      reach_text(reach), deg_from_rad(std::abs(missing))),
          fmt::format("the nearest tool axis that it reaches is {}",
                      vector_text(nearest_in_reach(reach, pose_W.axis_W)))};
}

double travel_excess(const Axis& axis, double value) {
  if (value < axis.min) return value - axis.min;
  return value > axis.max ? value - axis.max : 0.0;
}

std::string travel_text(const Axis& axis, double value, const std::string& where) {
  const bool rotary = axis.kind == AxisKind::kRotary;
  const double scale = rotary ? deg_from_rad(1.0) : 1.0;
  const char* unit = rotary ? "deg" : "mm";
  return fmt::format(
      "axis {} would have to go to {:.3f} {} in {}, {:.3f} {} beyond its travel of {:.3f} .. {:.3f} {}",
      axis.name, scale * value, unit, where, scale * std::abs(travel_excess(axis, value)), unit,
      scale * axis.min, scale * axis.max, unit);
}

}  // namespace swarf::kinematics
