// The axes along one move of CL data: the places at which a program has to stand so that the control, which
// moves every axis evenly between them, keeps the tip and the tool axis where the CL data has them.
//
//   CL      P0 ---------------------------------- P1     tip on the line or arc, axis on the great circle
//   program P0 ----x---------x---------x--------- P1     exact axis values at each x
//
//  1. An axis nearer to a pole than `snap_rad` counts as the pole: there the outer rotary axis is free, and
//     what digits are left would turn it at random.
//  2. A move through the pole is cut there; the outer axis turns at rest where the far side wants another
//     value, in pieces in which the tip stays where it is.
//  3. Each part is cut in equal pieces, and these again, until every piece is within the tolerances. Bounds:
//     tip    no TCP: kinematics::segment_deviation, proven (or the cheap bound of theory 2 above it), plus
//     the
//            sagitta of an arc's chord, plus what the written digits may turn the tip aside (rounding.h)
//     axis   |da| <= turn^2 / 8 from the chord, or TrajectoryError::orientation_rad, which is proven
//  Known limit: a piece that turns an axis by more than kPieceTurn is a jump and none is made of it.
#pragma once

#include <string>
#include <vector>

#include "kinematics/machine_model.h"
#include "kinematics/singularity.h"
#include "program/moves.h"

namespace swarf::post {

/// What the program has to keep to.
struct FollowRules {
  bool tcp = false;          ///< the control keeps the tip on its line itself
  double tip_mm = 0.01;      ///< of the tip from the CL move, written digits included
  double axis_rad = 0.0;     ///< of the tool axis from its great circle
  double snap_rad = 0.0;     ///< see 1.
  double linear_half = 0.0;  ///< half the last digit written, mm
  double rotary_half = 0.0;  ///< rad
};

/// A machine that follows, with the tool in its spindle.
struct Follower {
  /// Throws InputError as InverseKinematics does.
  Follower(const kinematics::MachineModel& with_tool, const FollowRules& given);
  kinematics::MachineModel machine;
  kinematics::InverseKinematics inverse;
  kinematics::Poles poles;
  FollowRules rules;
};

/// The pose with an axis near a pole laid into it.
ToolPose snapped(const Follower& follower, const ToolPose& pose);

struct Waypoint {
  ToolPose pose;
  kinematics::AxisValues q = kinematics::AxisValues::Zero();
  double share = 1.0;         ///< of the move that is done here
  double deviation_mm = 0.0;  ///< bound over the piece that ends here, without the digits
  bool turns_at_rest = false;
};

/// Why the axes cannot follow.
struct FollowFault {
  std::string code;  ///< "" : none. "unreachable" | "travel" | "axis-jump" | "tolerance-below-digits"
  std::string text, fix;
  int axis = -1;  ///< of the machine, of "travel" and "axis-jump"
};

/// Rotary axes that turn by less have not turned, rad.
inline constexpr double kTurned = 1e-9;
/// More in one piece is a jump, rad.
inline constexpr double kPieceTurn = 3.3;

/// On which side a pole is left.
enum class PoleSide {
  kContinuous,  ///< on the one that the axes go on to, where the travel has it: nothing turns
  kOther,       ///< the outer axis turns by half a turn at rest, and the inner one goes back
};

/// The side on which each pole is left, in the order in which a path leaves them.
struct PoleSides {
  std::vector<PoleSide> sides;  ///< of the first ones; the others are left on kContinuous
  size_t left = 0;              ///< poles that have been left so far
  PoleSide next() { return left < sides.size() ? sides[left++] : (++left, PoleSide::kContinuous); }
};

/// Appends the places after the start of the move, the last at its end. `q`: axis values at its start; in the
/// end those of the last place. Nothing is appended with a fault.
FollowFault follow(const Follower& follower, const program::Move& move, PoleSides& poles,
                   kinematics::AxisValues& q, std::vector<Waypoint>& places);

/// Greatest of |change| of a rotary axis, rad.
double greatest_turn(const kinematics::MachineModel& machine, const kinematics::AxisValues& from,
                     const kinematics::AxisValues& to);

/// The fault of a solution that cannot be driven to; code "" when it can.
FollowFault fault_of(const Follower& follower, const kinematics::Branch& branch, const ToolPose& pose);

/// Sum of what the rotary axes turn between two sets of axis values, rad.
double rotary_way(const kinematics::MachineModel& machine, const kinematics::AxisValues& from,
                  const kinematics::AxisValues& to);

/// The least time in which the axes go there by their speeds, s; 0 where the machine does not say them.
double axis_time(const kinematics::MachineModel& machine, const kinematics::AxisValues& from,
                 const kinematics::AxisValues& to, bool rapid);

}  // namespace swarf::post
