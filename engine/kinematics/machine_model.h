// The machine as a kinematic model: a serial chain of axes from the work, through the bed, to the tool.
//
//   W --table chain--> base <--head chain-- T
//
// Every pose is in the machine frame M with all axes at zero ("home drawing"); axes then move their links.
// ISO 841: a positive value moves the tool positively relative to the work, so a table-side axis moves its
// link the other way. `reversed` names the other habit (the paper's machine turns its tables positively).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/frames.h"

namespace swarf::kinematics {

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
  double home = 0.0;
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
};

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

/// The closed-form inverse, prepared once per machine; solving allocates nothing.
/// Three linear axes and up to two rotary axes in any table/head arrangement, orthogonal or not.
class InverseKinematics {
 public:
  /// Throws InputError when the chain has no unique inverse (linear axes dependent, rotary axes parallel).
  explicit InverseKinematics(const MachineModel& machine);
  /// Both branches; rotary values lie within a turn of `hint` (unwound to be continuous with it).
  InverseSolutions solve(const ToolPose& pose_W, const AxisValues& hint) const;
  /// The branch nearest to `hint` by rotary travel among those inside the travel limits; the continuous
  /// choice through the pole (-a, b + 180 deg) falls out of this rule.
  Branch solve_nearest(const ToolPose& pose_W, const AxisValues& hint) const;

 private:
  MachineModel machine_;
  std::vector<int> linear_, rotary_;
  Mat3 linear_inverse_ = Mat3::Identity();
};

}  // namespace swarf::kinematics
