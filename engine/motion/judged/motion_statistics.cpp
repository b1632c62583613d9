#include "motion/judged/motion_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/angles.h"
#include "base/units.h"
#include "kinematics/reach.h"
#include "kinematics/rotary_pair.h"
#include "motion/blocks/block_run.h"
#include "motion/blocks/block_turns.h"
#include "motion/passes/pass_geometry.h"
#include "motion/speed/look_ahead.h"

namespace swarf::motion {
namespace {

using kinematics::AxisKind;
using kinematics::AxisValues;
using kinematics::MachineModel;
using toolpath::BlockMove;
using toolpath::FreeMove;
using toolpath::SurfacePass;

/// Share of its top feed from which a pass counts as being past its start and before its stop.
constexpr double kTopFeedShare = 0.999;
/// A fine excess of travel counts as rounding, mm or rad.
constexpr double kTravelTolerance = 1e-9;

/// Distance of a point from a path near it, whose tangent is the given one.
double distance_across(const Vec3& gap, const Vec3& along) {
  const double square = along.squaredNorm();
  return square > 0.0 ? (gap - gap.dot(along) / square * along).norm() : gap.norm();
}

}  // namespace

/// What is measured of one cycle, from the one before it to its own.
class MotionMeter::TickMeter {
 public:
  TickMeter(const Cycles& cycles, MotionStatistics& statistics)
      : elements_(cycles.elements()),
        blocks_(cycles.motions()),
        motion_(cycles.motions()),
        machine_(cycles.machines().front()),
        inverse_(cycles.inverse(0)),
        end_(toolpath::contact_end(cycles.cutter())),
        period_(cycles.period_s()),
        out_(statistics) {}

  void measure(const Cycle* last, const Cycle& now) {
    const ToolSample& sample = now.sample;
    const MachineModel& machine =
        blocks_.empty() ? machine_ : *motion_.at(static_cast<size_t>(sample.element)).machine;
    const ToolPose back = kinematics::forward(machine, now.q);
    out_.fk_ik_error_max_mm = std::max(out_.fk_ik_error_max_mm, (back.tip_W - sample.pose.tip_W).norm());
    const double pole = inverse_.pole_distance(sample.pose.axis_W);
    if (pole < kinematics::kPoleTolerance) ++out_.singular_ticks;
    if (sample.kind == SampleKind::kCutting && pole < out_.pole_distance_min_rad) {
      out_.pole_distance_min_rad = pole;
      out_.pole_element = sample.element;
    }
    if (last == nullptr) return;
    const ToolPose middle = kinematics::forward(machine, 0.5 * (last->q + now.q));
    const ToolSample& before = last->sample;
    const auto element = static_cast<size_t>(sample.element);
    if (!blocks_.empty()) {
      measure_block(motion_.at(element), before, sample, middle);
    } else if (const auto* pass = elements_.pass(element)) {
      measure_contact(*pass, before, sample, middle);
    } else if (const auto* driven = elements_.driven(element)) {
      measure_driven(*driven, before, sample, middle);
    } else {
      const auto move = std::get<FreeMove>(elements_[element].what);
      const double error = distance_across(middle.tip_W - move.from.tip_W, move.to.tip_W - move.from.tip_W);
      out_.tip_error_max_mm = std::max(out_.tip_error_max_mm, error);
    }
  }

 private:
  void measure_contact(const SurfacePass& pass, const ToolSample& before, const ToolSample& sample,
                       const ToolPose& middle) {
    const Vec3 from = previous_contact(pass, before);
    const Vec3 chord = sample.contact_W - from;
    const double period = period_;
    const double length = chord.norm();
    out_.path_length_mm += length;
    out_.feed_error_max_rel = std::max(
        out_.feed_error_max_rel, std::abs(length - sample.feed_mm_s * period) / (pass.feed_mm_s * period));
    const double t = curve_parameter(pass, sample.u, sample.v);
    const ToolPose exact = contact_pose(pass, t, end_);
    out_.orientation_error_max_rad =
        std::max(out_.orientation_error_max_rad, angle_between(exact.axis_W, sample.pose.axis_W));
    const double t_middle = 0.5 * (t + previous_parameter(pass, before));
    const Vec3 on_curve = curve_point(*pass.surface, pass.curve, t_middle);
    const double chord_error = distance_across(0.5 * (sample.contact_W + from) - on_curve, chord);
    out_.chord_error_max_mm = std::max(out_.chord_error_max_mm, chord_error);
    const Vec3 tip_gap = middle.tip_W - contact_pose(pass, t_middle, end_).tip_W;
    const double tip_error = distance_across(tip_gap, sample.pose.tip_W - before.pose.tip_W);
    out_.tip_error_max_mm = std::max(out_.tip_error_max_mm, tip_error);
  }

  /// Against the tool set down half way between the two cycles.
  void measure_driven(const toolpath::DrivenPass& pass, const ToolSample& before, const ToolSample& sample,
                      const ToolPose& middle) {
    const Vec3 chord = sample.pose.tip_W - before.pose.tip_W;
    out_.path_length_mm += chord.norm();
    out_.feed_error_max_rel =
        std::max(out_.feed_error_max_rel,
                 std::abs(chord.norm() - sample.feed_mm_s * period_) / (pass.feed_mm_s * period_));
    const double x = before.kind == SampleKind::kCutting ? before.u : 0.0;
    constexpr double kStep_mm = 1e-6;  // on one line the tool climbs straight
    if (std::abs(sample.u - x) < kStep_mm) return;
    const ToolPose exact = toolpath::tip_at(pass, 0.5 * (x + sample.u), near_).pose;
    const Vec3 gap = 0.5 * (sample.pose.tip_W + before.pose.tip_W) - exact.tip_W;
    out_.chord_error_max_mm = std::max(out_.chord_error_max_mm, distance_across(gap, chord));
    out_.tip_error_max_mm =
        std::max(out_.tip_error_max_mm, distance_across(middle.tip_W - exact.tip_W, chord));
  }

  void measure_block(const BlockMotion& motion, const ToolSample& before, const ToolSample& sample,
                     const ToolPose& middle) {
    const BlockMove& block = motion.block;
    const Vec3 chord = sample.pose.tip_W - before.pose.tip_W;
    const bool cutting = sample.kind == SampleKind::kCutting;
    if (blocks_.tool(static_cast<size_t>(before.element)) != block.tool)
      return;  // another tool's tip: no way between them
    if (cutting) out_.path_length_mm += chord.norm();
    if (sample.rounded && cutting) measure_corner(motion, sample);
    if (before.element != sample.element || before.rounded || sample.rounded) return;
    const ToolPose exact = pose_at(motion, 0.5 * (before.u + sample.u));
    const double tip_error = distance_across(middle.tip_W - exact.tip_W, chord);
    out_.tip_error_max_mm = std::max(out_.tip_error_max_mm, tip_error);
    if (!cutting) return;
    const double period = period_;
    out_.feed_error_max_rel =
        std::max(out_.feed_error_max_rel,
                 std::abs(chord.norm() - sample.feed_mm_s * period) / (programmed_feed(block) * period));
    const Vec3 gap = 0.5 * (sample.pose.tip_W + before.pose.tip_W) - exact.tip_W;
    out_.chord_error_max_mm = std::max(out_.chord_error_max_mm, distance_across(gap, chord));
  }

  void measure_corner(const BlockMotion& motion, const ToolSample& sample) {
    const double deviation = (sample.pose.tip_W - pose_at(motion, sample.u).tip_W).norm();
    if (deviation <= out_.corner_deviation_max_mm) return;
    out_.corner_deviation_max_mm = deviation;
    out_.corner_element = sample.element;
  }

  static double programmed_feed(const BlockMove& block) {
    return block.duration_s > 0.0 ? toolpath::tip_way(block) / block.duration_s : block.feed_mm_s;
  }

  /// The first tick of a pass comes from a free move, which ends on its start.
  static double previous_parameter(const SurfacePass& pass, const ToolSample& before) {
    return before.kind == SampleKind::kCutting ? curve_parameter(pass, before.u, before.v) : pass.t_start;
  }

  /// A free move's last cycle knows the tip only, which is not the contact of a leaned tool.
  static Vec3 previous_contact(const SurfacePass& pass, const ToolSample& before) {
    return before.kind == SampleKind::kCutting ? before.contact_W
                                               : curve_point(*pass.surface, pass.curve, pass.t_start);
  }

  const toolpath::Elements& elements_;
  const BlockMotions& blocks_;
  MotionReader motion_;
  const MachineModel& machine_;
  const kinematics::InverseKinematics& inverse_;
  toolpath::ContactEnd end_;
  double period_;
  MotionStatistics& out_;
  position::Near near_;
};

/// Differences of one axis.
class MotionMeter::AxisMeter {
 public:
  AxisMeter(const kinematics::Axis& axis, Eigen::Index row, double period_s)
      : axis_(axis), row_(row), period_(period_s) {
    out_.name = axis.name;
  }

  void measure(const Cycle* last, const Cycle& now) {
    const double q = now.q[row_];
    if (last == nullptr) {
      out_.min = out_.max = q;
      return;
    }
    out_.min = std::min(out_.min, q);
    out_.max = std::max(out_.max, q);
    if (now.sample.tool != last->sample.tool) {
      speed_ = 0.0;
      return;
    }
    const double change = q - last->q[row_];
    out_.travel += std::abs(change);
    const double before = speed_;
    speed_ = change / period_;
    out_.speed_max = std::max(out_.speed_max, std::abs(speed_));
    const double acceleration_before = acceleration_;
    acceleration_ = (speed_ - before) / period_;
    out_.acceleration_max = std::max(out_.acceleration_max, std::abs(acceleration_));
    out_.jerk_max = std::max(out_.jerk_max, std::abs(acceleration_ - acceleration_before) / period_);
    const bool rapid = now.sample.kind == SampleKind::kRapid;
    if (std::abs(speed_) >= kAtLimit * speed_limit(axis_, rapid)) out_.time_at_speed_limit_s += period_;
  }
  const AxisStatistics& result() const { return out_; }

 private:
  const kinematics::Axis& axis_;
  Eigen::Index row_;
  double period_;
  double speed_ = 0.0, acceleration_ = 0.0;
  AxisStatistics out_;
};

bool is_rapid_element(const toolpath::Element& element) {
  if (const auto* move = std::get_if<FreeMove>(&element.what)) return move->feed_mm_s == 0.0;
  const auto* block = std::get_if<BlockMove>(&element.what);
  return block != nullptr && is_rapid(*block);
}

namespace {

/// Least of the feeds of one element between the first and the last that have its top feed.
double least_feed(std::span<const double> feeds) {
  const double top = *std::max_element(feeds.begin(), feeds.end());
  const auto at_top = [&](double feed) { return feed >= kTopFeedShare * top; };
  size_t first = 0, last = feeds.size() - 1;
  while (!at_top(feeds[first])) ++first;
  while (!at_top(feeds[last])) --last;
  return *std::min_element(feeds.begin() + static_cast<ptrdiff_t>(first),
                           feeds.begin() + static_cast<ptrdiff_t>(last) + 1);
}

std::string element_name(const toolpath::Element& element) {
  if (const auto* pass = std::get_if<SurfacePass>(&element.what))
    return fmt::format("pass {}", pass->pass + 1);
  if (const auto* driven = std::get_if<toolpath::DrivenPass>(&element.what))
    return fmt::format("pass {}", driven->pass + 1);
  if (std::holds_alternative<BlockMove>(element.what))
    return fmt::format("the block of line {}", element.where.line);
  switch (std::get<FreeMove>(element.what).kind) {
    case toolpath::MoveKind::kApproach:
      return "an approach";
    case toolpath::MoveKind::kRetract:
      return "a retract";
    case toolpath::MoveKind::kRapid:
      return "a rapid move";
  }
  return "a move";
}

std::string speed_text(const kinematics::Axis& axis, const AxisExcess& worst, const std::string& where) {
  const bool rotary = axis.kind == AxisKind::kRotary;
  const double scale = rotary ? deg_from_rad(1.0) : 1.0;
  return fmt::format("axis {} would have to move at {:.3f} {} in {}, its limit is {:.3f}", axis.name,
                     scale * worst.value, rotary ? "deg/s" : "mm/s", where, scale * worst.limit);
}

}  // namespace

MotionMeter::MotionMeter(const Cycles& cycles, MotionResult& result)
    : cycles_(cycles),
      machine_(cycles.machines().front()),
      out_(result),
      ticks_(std::make_unique<TickMeter>(cycles, result.statistics)),
      excess_(machine_.axes.size()) {
  out_.statistics.pole_distance_min_rad = kPi;
  for (size_t i = 0; i < machine_.axes.size(); ++i)
    axes_.emplace_back(machine_.axes[i], static_cast<Eigen::Index>(i), cycles.period_s());
}

MotionMeter::~MotionMeter() = default;

void MotionMeter::add(std::span<const Cycle> window) {
  for (const Cycle& now : window) {
    if (last_ && last_->sample.element != now.sample.element) end_element();
    const Cycle* last = last_ ? &*last_ : nullptr;
    ticks_->measure(last, now);
    for (AxisMeter& axis : axes_) axis.measure(last, now);
    see_time(now);
    see_reach(now);
    see_excess(now);
    if (now.sample.kind == SampleKind::kCutting) feeds_.push_back(now.sample.feed_mm_s);
    if (now.cost_ns >= 0.0F && costs_ns_.size() < kCostsMost) costs_ns_.push_back(now.cost_ns);
    last_ = now;
    ++out_.statistics.ticks;
  }
}

/// Time by what it is spent on. A block's dwell stands at its start; all its other cycles are further on.
void MotionMeter::see_time(const Cycle& now) {
  if (!last_) return;
  CycleTime& cycle = out_.statistics.cycle;
  const auto in_spindle = static_cast<size_t>(now.sample.tool);
  if (cycle.in_spindle_s.size() <= in_spindle) cycle.in_spindle_s.resize(in_spindle + 1, 0.0);
  cycle.in_spindle_s[in_spindle] += now.sample.t_s - last_->sample.t_s;
  if (last_->sample.tool != now.sample.tool) return;
  const toolpath::Element& element = element_of(now);
  const auto* block = std::get_if<BlockMove>(&element.what);
  const bool dwells = block != nullptr && block->dwell_s > 0.0 && now.sample.u == 0.0;
  (dwells ? cycle.dwell_s : is_rapid_element(element) ? cycle.rapid_s : cycle.feed_s) += cycles_.period_s();
  const size_t tool = block != nullptr ? static_cast<size_t>(block->tool) : 0;
  if (cycle.by_tool_s.size() <= tool) cycle.by_tool_s.resize(tool + 1, 0.0);
  cycle.by_tool_s[tool] += cycles_.period_s();
}

/// The element under way.
const toolpath::Element& MotionMeter::element_of(const Cycle& now) {
  if (!element_ || element_number_ != now.sample.element)
    element_ = cycles_.elements()[static_cast<size_t>(now.sample.element)];
  element_number_ = now.sample.element;
  return *element_;
}

void MotionMeter::see_reach(const Cycle& now) {
  if (now.reached) return;
  if (outside_reach_++ == 0) first_outside_ = now.sample;
}

void MotionMeter::see_excess(const Cycle& now) {
  const auto* block = std::get_if<BlockMove>(&element_of(now).what);
  const bool rapid = block != nullptr && is_rapid(*block);
  for (size_t i = 0; i < excess_.size(); ++i) {
    const kinematics::Axis& axis = machine_.axes[i];
    const double q = now.q[static_cast<Eigen::Index>(i)];
    const double beyond = std::abs(kinematics::travel_excess(axis, q));
    if (beyond > kTravelTolerance)
      excess_[i].travel.see(beyond, q, q < axis.min ? axis.min : axis.max, now.sample.t_s);
    if (!last_ || last_->sample.tool != now.sample.tool) continue;
    const double most = speed_limit(axis, rapid);
    const double v = std::abs(q - last_->q[static_cast<Eigen::Index>(i)]) / cycles_.period_s();
    if (v > most * (1.0 + kAxisSpeedTolerance)) excess_[i].speed.see(v - most, v, most, now.sample.t_s);
  }
}

void MotionMeter::end_element() {
  const int index = last_->sample.element;
  const toolpath::Element& element = element_of(*last_);
  if (outside_reach_ > 0) {
    const kinematics::UnreachableText why = kinematics::unreachable_text(machine_, first_outside_.pose);
    out_.findings.push_back(
        {"unreachable",
         fmt::format("its axes stood still for {} cycles, from the first pose out of reach: {}; {}",
                     outside_reach_, why.text, why.fix),
         index, first_outside_.t_s, element.where});
    outside_reach_ = 0;
  }
  for (size_t i = 0; i < excess_.size(); ++i) {
    const kinematics::Axis& axis = machine_.axes[i];
    AxisFault& found = excess_[i];
    if (found.travel.excess > 0.0)
      faults_.push_back({"travel", kinematics::travel_text(axis, found.travel.value, element_name(element)),
                         index, found.travel.t_s, element.where, Severity::kError, axis.name});
    if (found.speed.excess > 0.0)
      faults_.push_back({"axis-speed", speed_text(axis, found.speed, element_name(element)), index,
                         found.speed.t_s, element.where, Severity::kError, axis.name});
    found = {};
  }
  if (feeds_.empty()) return;
  const double feed = least_feed(feeds_);
  feed_min_ = feed_min_ < 0.0 ? feed : std::min(feed_min_, feed);
  feeds_.clear();
}

void MotionMeter::rank_costs() {
  if (costs_ns_.empty()) return;
  const auto rank = [&](double share) {
    const auto at =
        costs_ns_.begin() + static_cast<ptrdiff_t>(share * static_cast<double>(costs_ns_.size() - 1));
    std::nth_element(costs_ns_.begin(), at, costs_ns_.end());
    return static_cast<double>(*at);
  };
  out_.statistics.tick_ns_median = rank(0.5);
  out_.statistics.tick_ns_p999 = rank(0.999);
}

void MotionMeter::finish() {
  MotionStatistics& statistics = out_.statistics;
  if (last_) {
    end_element();
    --statistics.ticks;  // the first cycle is where the motion starts
    statistics.time_s = last_->sample.t_s;
    statistics.feed_min_mm_s = std::max(0.0, feed_min_);
    for (const AxisMeter& axis : axes_) statistics.axes.push_back(axis.result());
    statistics.other_mode = other_mode(cycles_.motions());
    rank_costs();
  }
  std::move(faults_.begin(), faults_.end(), std::back_inserter(out_.findings));
}

}  // namespace swarf::motion
