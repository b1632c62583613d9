#include "motion/speed/free_move.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/tool_axis.h"
#include "motion/speed/jerk_profile.h"

namespace swarf::motion {
namespace {

using kinematics::AxisValues;
using kinematics::InverseKinematics;
using kinematics::MachineModel;
using toolpath::FreeMove;

/// Turns count as long as this arm would swing, mm.
constexpr double kFreeTurnArm = 100.0;
/// Moves shorter than this go nowhere, mm.
constexpr double kLengthMin = 1e-9;
/// A power of two, so that the middle of a symmetric move is a node.
constexpr double kCells = 128.0;
/// Path speed and acceleration of a rapid before the axes limit it; far beyond any machine.
constexpr double kUnlimited = 1e9;

SampleKind kind_of(toolpath::MoveKind kind) {
  switch (kind) {
    case toolpath::MoveKind::kApproach:
      return SampleKind::kApproach;
    case toolpath::MoveKind::kRetract:
      return SampleKind::kRetract;
    case toolpath::MoveKind::kRapid:
      return SampleKind::kRapid;
  }
  return SampleKind::kRapid;
}

/// Jerk along the path that no axis exceeds its own with, as far as q(s) is straight.
double rapid_jerk(const std::vector<PathNode>& nodes, const MachineModel& machine) {
  double jerk = kUnlimited;
  for (size_t i = 0; i < machine.axes.size(); ++i)
    jerk = std::min(jerk, machine.axes[i].jerk_max / greatest_rate(nodes, static_cast<int>(i)));
  return jerk;
}

Profile plan_move(const FreeMove& move, double length, const MachineModel& machine,
                  const InverseKinematics& inverse, const MotionOptions& options, const AxisValues& hint) {
  const PathShape shape{[&](double x) { return pose_between(move.from, move.to, x); },
                        [&](double from, double to) { return length * std::abs(to - from); }};
  const kinematics::Branch start = inverse.solve_nearest(move.from, hint);
  const bool reached = start.outcome != kinematics::InverseOutcome::kUnreachable;
  std::vector<PathNode> nodes{{0.0, 0.0, reached ? start.q : hint, false, reached}};
  append_nodes(shape, inverse, machine, 1.0, length / kCells * (1.0 + 1e-9), nodes);
  const double way = (move.to.tip_W - move.from.tip_W).norm();
  const bool rapid = move.feed_mm_s == 0.0;
  // Feed and path limits belong to the tip; a move that mainly turns is planned along a longer way.
  const double stretch = way > 0.0 ? length / way : kUnlimited;
  SpeedLimits limits =
      uniform_limits(nodes, rapid ? kUnlimited : std::min(kUnlimited, move.feed_mm_s * stretch),
                     rapid ? kUnlimited : options.path_acceleration_max * stretch);
  clamp_by_axes(nodes, machine, limits);
  double jerk = rapid_jerk(nodes, machine);
  if (!rapid) jerk = std::min(jerk, options.path_jerk_max * stretch);
  const SpeedPlan plan = plan_speed(limits, jerk, options.period_s);
  return sample_plan(plan, limits.length(), options.period_s);
}

}  // namespace

double move_length(const ToolPose& from, const ToolPose& to) {
  return std::max((to.tip_W - from.tip_W).norm(), kFreeTurnArm * angle_between(from.axis_W, to.axis_W));
}

std::vector<ToolSample> sample_free_move(const FreeMove& move, const MachineModel& machine,
                                         const InverseKinematics& inverse, const MotionOptions& options,
                                         const AxisValues& hint) {
  const double length = move_length(move.from, move.to);
  if (length < kLengthMin) return {};
  const Profile profile = plan_move(move, length, machine, inverse, options, hint);
  const double tip_share = (move.to.tip_W - move.from.tip_W).norm() / length;
  std::vector<ToolSample> samples(profile.step_mm.size());
  for (size_t k = 0; k < samples.size(); ++k) {
    const bool last = k + 1 == samples.size();
    ToolSample& sample = samples[k];
    sample.pose = last ? move.to : pose_between(move.from, move.to, profile.position_mm[k] / length);
    sample.contact_W = sample.pose.tip_W;
    sample.feed_mm_s = tip_share * profile.step_mm[k] / options.period_s;
    sample.kind = kind_of(move.kind);
  }
  return samples;
}

}  // namespace swarf::motion
