// The real-time core: one call per control cycle gives position, exact orientation and feed on a surface
// pass.
//
//   C(t_k)                     1. L = length of this cycle, from the look-ahead plan or from the caller
//     o-------- L -------o     2. Taylor 2:  dt = L/s - L^2 (C'.C'')/(2 s^4),  s = |C'|      (theory 1.3)
//      `-.____________.-'      3. twice Newton on |C(t) - C(t_k)|^2 = L^2
//                  C(t)        4. surface normal and pose at C(t)
//
// In mode taylor1 steps 2 and 3 are Lin & Koren's Eq. (5), dt = L/s. What the ticks sum
// up to is not quite the arc: chords are a little shorter, and Eq. (5) misses by .1 %. begin() marches
// through the pass beforehand and fits the plan to it, so that limits hold where they belong (near the pole
// micrometres matter) and the last tick comes to lie on the end of the pass.
#pragma once

#include <optional>
#include <vector>

#include "cutter/cutter.h"
#include "kinematics/machine_model.h"
#include "motion/options.h"
#include "motion/speed/jerk_profile.h"
#include "motion/speed/speed_clamps.h"
#include "toolpath/tool_path.h"

namespace swarf::motion {

struct StepInput {
  /// Feed of this cycle, mm/s; none: the plan of begin() gives it.
  std::optional<double> feed_mm_s;
  /// Measure tick_ns. Off by default: reading the clock twice costs a tenth of the cycle itself.
  bool timed = false;
};

struct StepOutput {
  ToolPose pose;
  Vec3 contact_W = Vec3::Zero();
  double t = 0.0;  ///< parameter of the pass' curve
  double u = 0.0, v = 0.0;
  double feed_mm_s = 0.0;  ///< commanded for this cycle: its chord is to be feed times period
  double chord_mm = 0.0;   ///< what the chord has become
  bool finished = false;   ///< the pose is the end of the pass
  double tick_ns = 0.0;    ///< cost of this call when it was timed
};

class SurfaceInterpolator {
 public:
  /// The machine and its inverse must outlive the interpolator.
  SurfaceInterpolator(const kinematics::MachineModel& machine, const kinematics::InverseKinematics& inverse,
                      const cutter::Cutter& cutter, const MotionOptions& options);

  /// Look-ahead for a pass: limits, speed plan, exact length. `hint`: axis values before the pass. Allocates.
  void begin(const toolpath::SurfacePass& pass, const kinematics::AxisValues& hint);
  /// Stands at the start of a pass without a plan: every step() needs a feed. The last one is shortened to
  /// end on the end of the pass.
  void begin_unplanned(const toolpath::SurfacePass& pass);

  /// One control cycle. Allocates nothing. Must not be called again once finished.
  void step(const StepInput& input, StepOutput& output);

  /// Pose at the start of the pass.
  ToolPose start_pose() const;
  /// What begin() planned with and what came out.
  const SpeedLimits& limits() const { return limits_; }
  const Profile& profile() const { return profile_; }

 private:
  ToolPose pose_at(const toolpath::CurvePoint& at) const;
  /// Parameter one chord of length L further on.
  double advance(const toolpath::CurvePoint& at, double t, double length) const;
  double advance_taylor1(const toolpath::CurvePoint& at, double t, double length) const;
  double advance_chord(const toolpath::CurvePoint& at, double t, double length) const;
  double beyond_end(double t) const { return direction_ * (t - pass_.t_end); }
  void take_step(const StepInput& input, StepOutput& output);
  /// Limits over the pass from feed, chord tolerance, path acceleration and the axes.
  void find_limits(const kinematics::AxisValues& hint);
  /// Plans, marches through the pass, and corrects the plan until the march ends on the pass' end.
  void fit_plan();
  /// The parameter after each tick of the profile.
  std::vector<double> march() const;
  /// Moves the plan's nodes to where the march has them: what the ticks sum up to when it passes them.
  void follow_march(const std::vector<double>& march, SpeedPlan& plan) const;
  /// mm along the curve from the end of the pass to t; negative short of it.
  double overshoot(double t) const;

  const kinematics::MachineModel& machine_;
  const kinematics::InverseKinematics& inverse_;
  toolpath::ContactEnd end_;
  MotionOptions options_;
  toolpath::SurfacePass pass_;
  double direction_ = 1.0;  ///< sign of t_end - t_start
  SpeedLimits limits_;
  std::vector<double> node_t_;  ///< curve parameters of the nodes of limits_
  Profile profile_;
  size_t tick_ = 0;
  double t_ = 0.0;
  toolpath::CurvePoint at_;
};

}  // namespace swarf::motion
