// What a block does near the pole of the rotary axes (So et al., corrected: theory 2, E12 to E15).
//
//   axes linear in the block:   p(u) = forward(q_from + u (q_to - q_from))      the true trajectory
//   programmed:                 P0 ---------------------- P1
//
// Near the pole the outer rotary axis (next to the work) swings far while the tool axis hardly turns: at
// distance beta from the pole its rate is (d sigma / ds) / sin(beta). The tip then leaves the line sideways
// and beyond its ends. The paper measures the distance to the infinite line, which hides the excursion past
// the ends; our error is the distance to the segment, and both are given (E15).
#pragma once

#include <optional>
#include <vector>

#include "kinematics/curve_peak.h"
#include "kinematics/machine_model.h"

namespace swarf::kinematics {

/// A block as programmed, with the axis values of the machine at both ends.
struct BlockEnds {
  ToolPose from, to;
  AxisValues q_from = AxisValues::Zero(), q_to = AxisValues::Zero();
};

/// Throws InputError "not-finite" when any number of the block is NaN or infinite.
void require_finite(const BlockEnds& ends);

/// Where the outer rotary axis is free.
struct Pole {
  Vec3 direction_W = Vec3::UnitZ();  ///< of the tool axis
  double inner_value = 0.0;          ///< of the inner rotary axis there, rad, but for whole turns
};

/// The two rotary axes and the poles between them; none on a machine with fewer than two rotary axes, or
/// where no position of the inner axis lays the tool along the outer one.
struct Poles {
  int outer = -1, inner = -1;  ///< indices into MachineModel::axes; -1: the machine has no such axis
  std::vector<Pole> at;
};
Poles find_poles(const MachineModel& machine);

/// Least angle (rad) between the tool axis and the nearest pole while the tool axis turns evenly along the
/// great circle (tcp); infinity without a pole.
double pole_distance_on_arc(const Poles& poles, const Vec3& from_W, const Vec3& to_W);
/// The same while the axes move linearly (joint): the distance depends on the inner axis alone, and is 0
/// where it passes the pole's value.
double pole_distance_of_axes(const MachineModel& machine, const Poles& poles, const BlockEnds& ends);

/// Half angle (rad) of the singular cone of a block: within it the outer axis would have to turn faster than
/// `outer_speed_max` (rad/s) for a tool axis that turns by `turn_rad` in `duration_s` around the pole. pi/2:
/// nowhere fast enough.
double singular_cone(double turn_rad, double duration_s, double outer_speed_max);

/// The true trajectory of a block with linear axes against its programmed line.
struct TrajectoryError {
  Peak line;     ///< distance to the infinite line P0 P1, mm (the paper's measure)
  Peak segment;  ///< distance to the segment P0 P1, mm (ours)
  Peak beyond;   ///< how far past an end of the segment, along it, mm; 0 for a block without a length
  double length_mm = 0.0;        ///< of the true trajectory
  double chord_mm = 0.0;         ///< of the programmed line
  double orientation_rad = 0.0;  ///< greatest angle between tool axis and the great circle through its ends;
                                 ///< NaN when the block reverses the axis: any great circle goes through them
  double bound_mm = 0.0;         ///< 1/8 max|p''|: neither distance exceeds it (theory 2)
};
/// Maxima by bracketed roots of the exact derivatives, proven to 1e-9 mm (curve_peak.h). A block without a
/// length is measured by the distance to its point. Throws InputError "not-finite".
TrajectoryError trajectory_error(const MachineModel& machine, const BlockEnds& ends);

/// TrajectoryError::segment alone.
Peak segment_deviation(const MachineModel& machine, const BlockEnds& ends);
/// TrajectoryError::bound_mm alone: cheap.
double trajectory_error_bound(const MachineModel& machine, const BlockEnds& ends);

/// One way to run the block with linear axes: a rotary solution at each end and a way round for the outer
/// axis.
struct BranchChoice {
  bool other_from = false, other_to = false;  ///< the second rotary solution at this end
  bool long_way = false;                      ///< the outer axis goes the other way round, a whole turn apart
  AxisValues q_from = AxisValues::Zero(), q_to = AxisValues::Zero();
  double outer_swing_rad = 0.0, inner_swing_rad = 0.0;  ///< signed
  double line_mm = 0.0, segment_mm = 0.0;               ///< greatest deviations, as in TrajectoryError
  int out_of_travel_axis = -1;                          ///< first axis that would leave its travel; -1: none
};
/// Every combination, the block as it stands first. Empty on a machine with fewer than two rotary axes.
std::vector<BranchChoice> branch_choices(const MachineModel& machine, const InverseKinematics& inverse,
                                         const BlockEnds& ends);

}  // namespace swarf::kinematics
