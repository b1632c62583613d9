// What a machine cannot reach and by how much: the words for a message when the inverse finds nothing.
//
//            e1   . . w     The tool lies on a cone around e2 with the half angle b, and e1 carries this cone
//            round:
//         v   | .           the angle of the tool axis to e1 takes every value from
//          \ b|a . e2            |a - b|   to   pi - |pi - (a + b)|,     a = angle(e1, e2), b = angle(e2, v),
//           \ | /           and no other. One rotary axis: exactly angle(e1, v). None: the tool axis itself.
#pragma once

#include <string>

#include "kinematics/machine_model.h"

namespace swarf::kinematics {

/// The directions that the rotary axes, turned without limits, can give the tool axis in W.
struct AxisReach {
  std::string about;             ///< letter of the rotary axis next to the work; "": no rotary axis
  Vec3 about_W = Vec3::UnitZ();  ///< its direction; without one, the tool axis
  double angle_min = 0.0, angle_max = 0.0;  ///< to about_W, rad
};

AxisReach axis_reach(const MachineModel& machine);

/// Angle by which the direction misses the reach, rad: negative when it stands too close to about_W, positive
/// when too far from it, 0 inside. axis_W need not be unit.
double missing_angle(const AxisReach& reach, const Vec3& axis_W);

/// The direction inside the reach that is nearest to axis_W; unit. Straight against or along about_W, where
/// every side is as near, any of them.
Vec3 nearest_in_reach(const AxisReach& reach, const Vec3& axis_W);

/// Why solve() finds no axis values for the pose, with the missing angle, and the tool axis that would do.
struct UnreachableText {
  std::string text, fix;
};
UnreachableText unreachable_text(const MachineModel& machine, const ToolPose& pose_W);

/// How far the value lies outside the travel: negative below min, positive above max, 0 inside. mm or rad.
double travel_excess(const Axis& axis, double value);
/// That a value lies outside the travel, in words; `where` in the program.
std::string travel_text(const Axis& axis, double value, const std::string& where);

}  // namespace swarf::kinematics
