// The machine as a kinematic model: a serial chain of axes from the work, through the bed, to the tool.
//
//   W --table chain--> base <--head chain-- T
//
// Every pose is in the machine frame M with all axes at zero ("home drawing"); axes then move their links.
// ISO 841: a positive value moves the tool positively relative to the work, so a table-side axis moves its
// link the other way. `reversed` names the other habit (the paper's machine turns its tables positively).
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/frames.h"
#include "kinematics/link_step.h"
#include "kinematics/rotary_pair.h"

namespace swarf::kinematics {

struct Sines;
template <int N>
struct LanePoints;

enum class AxisKind { kLinear, kRotary };
enum class Side { kTable, kHead };

/// Limits and geometry of one axis. Linear: mm, mm/s ...; rotary: rad, rad/s ...
struct Axis {
  std::string name;  ///< one of X Y Z A B C (U V W)
  AxisKind kind = AxisKind::kLinear;
  Side side = Side::kTable;
  Vec3 direction_M = Vec3::UnitX();  ///< unit
  Vec3 origin_M = Vec3::Zero();      ///< a point on a rotary axis, all axes at zero
  bool reversed = false;
  double min = 0.0, max = 0.0;  ///< travel
  double speed_max = 0.0;
  double acceleration_max = 0.0;
  double jerk_max = 0.0;
  double rapid_max = 0.0;  ///< speed in rapid moves; 0: speed_max
  double home = 0.0;
};

/// What the axes do in a rapid move.
enum class RapidMotion {
  kLinear,  ///< all arrive together, on a straight line of axis values
  kDogLeg,  ///< each runs at its own rapid speed and waits for the others
};

inline constexpr int kMaxAxes = 5;
/// One value per axis, in the order of MachineModel::axes; unused entries are zero.
using AxisValues = Eigen::Matrix<double, kMaxAxes, 1>;

struct MachineModel {
  std::string name;
  std::vector<Axis> axes;            ///< order of trajectory.csv
  std::vector<int> table_chain;      ///< indices into axes, from the base towards the work
  std::vector<int> head_chain;       ///< indices into axes, from the base towards the tool
  Pose X_MW = Pose::Identity();      ///< work frame with all axes at zero
  Vec3 tip_M = Vec3::Zero();         ///< tool tip with all axes at zero
  Vec3 tool_axis_M = Vec3::UnitZ();  ///< tip to spindle, all axes at zero
  /// Spindle gauge line with all axes at zero; none: the tip stands at tip_M whatever the tool.
  std::optional<Vec3> gauge_M;
  RapidMotion rapid = RapidMotion::kLinear;
  /// Where tools are changed; none: at home.
  std::optional<AxisValues> tool_change;
};

/// The machine with a tool of this length (gauge line to tip, mm) in its spindle: tip_M = gauge_M - length
/// tool_axis_M. Without a gauge line the tip stays where the machine says.
MachineModel with_tool(const MachineModel& machine, double length_mm);

/// Displacement of the link that the axis carries, in M, at value q: identity at 0.
Pose axis_motion(const Axis& axis, double q);

/// Tool tip and axis in the work frame at the given axis values (exact forward kinematics).
ToolPose forward(const MachineModel& machine, const AxisValues& q);

enum class InverseOutcome { kOk, kSingular, kOutOfTravel, kUnreachable };

/// One solution; `kSingular`: the tool axis stands at the pole and the free rotary took its value from the
/// hint.
struct Branch {
  AxisValues q = AxisValues::Zero();
  InverseOutcome outcome = InverseOutcome::kUnreachable;
  int out_of_travel_axis = -1;  ///< for kOutOfTravel: the first offending axis
};

/// At most two rotary solutions; count says how many are set. Each has been verified by forward().
struct InverseSolutions {
  Branch branch[2];
  int count = 0;
};

/// A solution counts only when forward() brings it back to the pose within these: tip (mm), axis (rad).
inline constexpr double kTipTolerance = 1e-9;
inline constexpr double kAxisTolerance = 1e-12;

/// The closed-form inverse, prepared once per machine; solving allocates nothing.
/// Three linear axes and up to two rotary axes in any table/head arrangement, orthogonal or not.
///
///  1. Rotary axes: R(e1, t1) R(e2, t2) v = axis_W, all directions in W at zero axes (RotaryPair); two
///  branches, one at the pole.
///  2. Unwind each rotary value by whole turns to the one nearest to the hint. When that lies outside the
///     travel and the value one turn towards the travel lies inside, the latter is taken.
///  3. Linear axes: with the rotary axes set, the tip closes the loop work - base - tool, three equations
///     linear in the three values.
///  4. Proof: forward() of the values, which knows nothing of 1 to 3 and takes its sines and cosines from the
///     final values, must give the pose back. A candidate that fails is dropped.
class InverseKinematics {
 public:
  /// Throws InputError when the chain has no unique inverse (linear axes dependent, rotary axes parallel, a
  /// rotary axis along the tool).
  explicit InverseKinematics(const MachineModel& machine);
  /// Both branches; rotary values lie within a turn of `hint` (unwound to be continuous with it) when the
  /// hint itself lies inside the travel. axis_W need not be exactly unit. NaN anywhere: no solution.
  InverseSolutions solve(const ToolPose& pose_W, const AxisValues& hint) const;
  /// The branch nearest to `hint` by rotary travel among those inside the travel limits; the continuous
  /// choice through the pole (-a, b + 180 deg) falls out of this rule. When none is inside, the nearest one,
  /// marked kOutOfTravel.
  Branch solve_nearest(const ToolPose& pose_W, const AxisValues& hint) const;
  /// The branch nearest to `before` by the turns of the rotary axes, whatever their travel: each value within
  /// half a turn of the one before.
  Branch continued(const ToolPose& pose_W, const AxisValues& before) const;
  /// The same of many poses, bit for bit: two, four or eight side by side, as the processor has it
  /// (inverse_lanes.cpp).
  void continued(std::span<const ToolPose> poses_W, std::span<const AxisValues> before,
                 std::span<Branch> found) const;
  /// The same along a way: what each pose follows are the values found for the one before it, or what that
  /// one followed where it is out of reach.
  void continued(std::span<const ToolPose> poses_W, const AxisValues& before, std::span<Branch> found) const;
  /// Angle between the tool axis and the nearest direction where the outer rotary is free, rad; infinity for
  /// a machine without such a pole (fewer than two rotary axes among them).
  double pole_distance(const Vec3& axis_W) const;

 private:
  struct Candidates;  ///< rotary solutions before the linear axes are known, side by side
  struct Targets;     ///< the poses to reach, in M, side by side
  friend struct LaneKernel;
  friend struct LaneInverse;
  void prepare_steps();
  void prepare_pair();
  int candidates(const Vec3& axis_W, const AxisValues& hint, Candidates& out) const;
  int turns(const Vec3& axis_W, TurnPair out[2]) const;
  void set_target(const Vec3& tip_W, const Vec3& axis_W, int lane, Targets& targets) const;
  void complete(const Targets& targets, const Candidates& candidates, Branch (&branch)[2]) const;
  LanePoints<2> located_apart(const Targets& targets, const double (&sine)[4],
                              const double (&cosine)[4]) const;
  bool locate_one(const Vec3& tip_M, const Sines& of, Vec3& linear_values) const;
  double turn_to(const AxisValues& before, AxisValues& q) const;
  int first_out_of_travel(const AxisValues& q) const;

  MachineModel machine_;
  std::vector<int> linear_, rotary_;  ///< indices into axes; rotary_: from the work to the tool
  double rotary_min_[2] = {0.0, 0.0}, rotary_max_[2] = {0.0, 0.0}, rotary_sense_[2] = {1.0, 1.0};
  std::vector<LinkStep> table_steps_, head_steps_;  ///< work to base, tool to base
  std::vector<LinkStep> tool_to_work_;              ///< the steps of forward()
  int column_[kMaxAxes] = {};                       ///< of a linear axis in the loop equation, by axis
  /// Travel by axis, wider by what the proof lets pass as rounding; without limits beyond the last axis.
  AxisValues travel_min_ = AxisValues::Constant(-std::numeric_limits<double>::infinity());
  AxisValues travel_max_ = AxisValues::Constant(std::numeric_limits<double>::infinity());
  RotaryPair pair_;              ///< of the directions in W at zero axes, as the pose gives its axis
  Vec3 tool_W_ = Vec3::UnitZ();  ///< tool axis with all axes at zero
  /// One rotary axis: the part of the tool axis along it, and the basis across it that the turn is counted
  /// in.
  Vec3 single_direction_W_ = Vec3::UnitX(), single_basis_W_[2] = {Vec3::UnitX(), Vec3::UnitY()};
  double single_along_ = 0.0;
  bool columns_constant_ = true;  ///< no linear axis rides on a rotary one
  Mat3 linear_inverse_ = Mat3::Identity();
};

}  // namespace swarf::kinematics
