#include "motion/passes/surface_interpolator.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "base/check.h"
#include "motion/passes/pass_geometry.h"

namespace swarf::motion {
namespace {

using toolpath::CurvePoint;

/// The march must end this close to the end of the pass, mm: a ten-thousandth of what the last tick's feed
/// error may be at 50 mm/s and 1 ms.
constexpr double kEndTolerance = 5e-12;
constexpr int kEndCorrections = 12;
/// First Newton steps up to this share of the chord are followed by a second one without a new position: the
/// third order is its cube, 1e-9, times the chord's own third-order term.
constexpr double kTaylorShare = 1e-3;
/// Each leaves about the step's share of the curve's unevenness, V T |C''| / |C'|^2, of the error before it.
constexpr int kNodeCorrections = 2;

}  // namespace

SurfaceInterpolator::SurfaceInterpolator(const kinematics::MachineModel& machine,
                                         const kinematics::InverseKinematics& inverse,
                                         const cutter::Cutter& cutter, const MotionOptions& options)
    : machine_(machine), inverse_(inverse), end_(toolpath::contact_end(cutter)), options_(options) {}

ToolPose SurfaceInterpolator::pose_at(const CurvePoint& at) const {
  return contact_pose(pass_, at, direction_, end_);
}

ToolPose SurfaceInterpolator::start_pose() const {
  return pose_at(curve_at(*pass_.surface, pass_.curve, pass_.t_start));
}

double SurfaceInterpolator::advance_taylor1(const CurvePoint& at, double t, double length) const {
  return t + direction_ * length / at.dC.norm();
}

double SurfaceInterpolator::advance_chord(const CurvePoint& at, double t, double length) const {
  const double square = at.dC.squaredNorm();
  const double target = length * length;
  t += direction_ * length / std::sqrt(square) - 0.5 * target * at.dC.dot(at.ddC) / (square * square);
  const CurvePoint near = curve_at(*pass_.surface, pass_.curve, t);
  Vec3 chord = near.C - at.C;
  const double first = (target - chord.squaredNorm()) / (2.0 * chord.dot(near.dC));
  t += first;
  // The second step needs position and derivative so near by that Taylor gives them; only after a long first
  // step would the third order be felt.
  const Vec3 slope = near.dC + first * near.ddC;
  if (std::abs(first) * near.dC.norm() <= kTaylorShare * length) {
    chord += first * (near.dC + 0.5 * first * near.ddC);
  } else {
    chord = curve_point(*pass_.surface, pass_.curve, t) - at.C;
  }
  return t + (target - chord.squaredNorm()) / (2.0 * chord.dot(slope));
}

double SurfaceInterpolator::advance(const CurvePoint& at, double t, double length) const {
  if (length == 0.0) return t;
  return options_.mode == Mode::kTaylor1 ? advance_taylor1(at, t, length) : advance_chord(at, t, length);
}

void SurfaceInterpolator::begin_unplanned(const toolpath::SurfacePass& pass) {
  pass_ = pass;
  direction_ = pass.t_end >= pass.t_start ? 1.0 : -1.0;
  limits_ = {};
  profile_ = {};
  tick_ = 0;
  t_ = pass.t_start;
  at_ = curve_at(*pass_.surface, pass_.curve, t_);
}

void SurfaceInterpolator::begin(const toolpath::SurfacePass& pass, const kinematics::AxisValues& hint) {
  begin_unplanned(pass);
  find_limits(hint);
  fit_plan();
}

void SurfaceInterpolator::find_limits(const kinematics::AxisValues& hint) {
  const std::vector<PathNode> nodes = pass_nodes(pass_, end_, machine_, inverse_, hint);
  node_t_.clear();
  for (const PathNode& node : nodes) node_t_.push_back(node.x);
  limits_ = uniform_limits(nodes, pass_.feed_mm_s, options_.path_acceleration_max);
  for (size_t cell = 0; cell < limits_.speed.size(); ++cell) {
    const double curvature =
        std::max(path_curvature(pass_, nodes[cell].x), path_curvature(pass_, nodes[cell + 1].x));
    limits_.speed[cell] = std::min(
        limits_.speed[cell], chord_speed_limit(1.0 / curvature, pass_.chord_tolerance_mm, options_.period_s));
  }
  clamp_by_axes(nodes, machine_, limits_);
}

std::vector<double> SurfaceInterpolator::march() const {
  std::vector<double> parameters;
  parameters.reserve(profile_.step_mm.size());
  double t = pass_.t_start;
  CurvePoint at = curve_at(*pass_.surface, pass_.curve, t);
  for (const double length : profile_.step_mm) {
    t = advance(at, t, length);
    at = curve_at(*pass_.surface, pass_.curve, t);
    parameters.push_back(t);
  }
  return parameters;
}

double SurfaceInterpolator::overshoot(double t) const {
  return std::copysign(pass_length(pass_, t, pass_.t_end), beyond_end(t));
}

void SurfaceInterpolator::follow_march(const std::vector<double>& march, SpeedPlan& plan) const {
  size_t tick = 0;
  double before = 0.0, t_before = pass_.t_start;  // length and parameter at the start of the tick
  for (size_t i = 1; i + 1 < node_t_.size(); ++i) {
    while (tick + 1 < march.size() && direction_ * (node_t_[i] - march[tick]) > 0.0) {
      before += profile_.step_mm[tick];
      t_before = march[tick++];
    }
    const double share = (node_t_[i] - t_before) / (march[tick] - t_before);
    plan.limits.s[i] = before + share * profile_.step_mm[tick];
  }
  plan.limits.s.back() = profile_.position_mm.back() - overshoot(march.back());
}

void SurfaceInterpolator::fit_plan() {
  SpeedPlan plan = plan_speed(limits_, options_.path_jerk_max, options_.period_s);
  for (int i = 0; i < kNodeCorrections; ++i) {
    profile_ = sample_plan(plan, plan.limits.length(), options_.period_s);
    follow_march(march(), plan);
  }
  double length = plan.limits.length();
  for (int i = 0; i < kEndCorrections; ++i) {
    profile_ = sample_plan(plan, length, options_.period_s);
    const double error = overshoot(march().back());
    if (std::abs(error) <= kEndTolerance) return;
    length -= error;
  }
  SWARF_CHECK(false, "the march along a pass does not come to lie on its end");
}

void SurfaceInterpolator::step(const StepInput& input, StepOutput& output) {
  if (!input.timed) {
    take_step(input, output);
    return;
  }
  const auto start = std::chrono::steady_clock::now();
  take_step(input, output);
  output.tick_ns = std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
}

void SurfaceInterpolator::take_step(const StepInput& input, StepOutput& output) {
  const bool planned = !input.feed_mm_s.has_value();
  SWARF_CHECK(!planned || tick_ < profile_.step_mm.size(), "a step beyond the plan of the pass");
  const double length = planned ? profile_.step_mm[tick_] : *input.feed_mm_s * options_.period_s;
  ++tick_;
  double t = advance(at_, t_, length);
  output.finished = planned ? tick_ == profile_.step_mm.size() : beyond_end(t) >= 0.0;
  if (output.finished) t = pass_.t_end;
  const Vec3 before = at_.C;
  t_ = t;
  at_ = curve_at(*pass_.surface, pass_.curve, t);
  output.pose = pose_at(at_);
  output.contact_W = at_.C;
  output.t = t;
  output.u = at_.u;
  output.v = at_.v;
  output.chord_mm = (at_.C - before).norm();
  output.feed_mm_s = (planned || !output.finished ? length : output.chord_mm) / options_.period_s;
}

}  // namespace swarf::motion
