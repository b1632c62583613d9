// Surface driven interpolation (Kato et al., section 2): each cycle sets the tool down on the part one chord
// F dt further on.
//
//   1. speed control: F dt from the clamps ahead                                     speed_control.h
//   2. the line x of the guide on which the tool stands |P(x) - P| = F dt away       secants; P(x) by the
//   3. the pose there, the place of contact                                          position calculator
//
// Every position is exact: no curve is fitted, no tolerance enters. Corners of the path are ends of chords
// when the tool stops there; steps are climbed straight along the axis.
#pragma once

#include "motion/passes/surface_evaluation.h"

namespace swarf::motion {

struct DrivenInput {
  double override_share = 1.0;  ///< of the pass' feed and of DrivenPass::overrides; 0: feed hold
};

struct DrivenOutput {
  toolpath::TipPoint at;
  double x = 0.0;           ///< of the guide
  double feed_mm_s = 0.0;   ///< commanded for this cycle: its chord is to be feed times period
  double chord_mm = 0.0;    ///< what the chord has become
  double clamp_mm_s = 0.0;  ///< of the cell in which the cycle ends
  bool finished = false;    ///< the pose is the end of the pass
};

class DrivenInterpolator {
 public:
  /// Looks ahead over the whole pass. Machine and inverse are used here only.
  DrivenInterpolator(toolpath::DrivenPass pass, const kinematics::MachineModel& machine,
                     const kinematics::InverseKinematics& inverse, const MotionOptions& options,
                     const kinematics::AxisValues& hint);

  /// One control cycle. Allocates nothing. Must not be called again once finished.
  DrivenOutput step(const DrivenInput& input);

  /// Where the pass begins.
  const toolpath::TipPoint& start() const { return start_; }
  const EvaluatedPass& ahead() const { return ahead_; }

 private:
  double to_node(size_t node) const { return (ahead_.nodes[node].pose.tip_W - at_.pose.tip_W).norm(); }
  /// One chord further on, or onto the end of the cell's stop.
  void advance(double length);
  void stand_on(size_t node);
  /// Throws InputError "pass-stands" where thousands of cycles have not moved the tool.
  void require_progress();
  void along_step(double length);
  void along_surface(double length);

  toolpath::DrivenPass pass_;
  double period_s_;
  EvaluatedPass ahead_;
  SpeedControl control_;
  position::Near near_;
  toolpath::TipPoint start_, at_;
  double x_ = 0.0;
  size_t cell_ = 0;
  SpeedState state_;
  /// Of the guide for each mm of chord in the last two cycles, from which the next is guessed; 0: not known.
  double per_chord_ = 0.0, per_chord_before_ = 0.0;
  Vec3 anchor_ = Vec3::Zero();  ///< where the tool was when it last got on
  int waits_ = 0;               ///< cycles since then
  int64_t cycles_ = 0;          ///< of the pass so far
};

}  // namespace swarf::motion
