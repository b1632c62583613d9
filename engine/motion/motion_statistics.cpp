#include "motion/motion_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/units.h"
#include "kinematics/reach.h"
#include "kinematics/rotary_pair.h"
#include "motion/block_run.h"
#include "motion/block_turns.h"
#include "motion/look_ahead.h"
#include "motion/pass_geometry.h"

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

/// The sample stands where another tool begins: how the axes came there is not part of the program.
bool tool_changes(const Trajectory& trajectory, size_t k) {
  return trajectory.samples[k].tool != trajectory.samples[k - 1].tool;
}

/// Distance of a point from a path near it, whose tangent is the given one.
double distance_across(const Vec3& gap, const Vec3& along) {
  const double square = along.squaredNorm();
  return square > 0.0 ? (gap - gap.dot(along) / square * along).norm() : gap.norm();
}

/// What is measured of one tick, from the sample before it to its own.
class TickMeter {
 public:
  TickMeter(const Trajectory& trajectory, const toolpath::ToolPath& path, std::span<const BlockMotion> blocks,
            const MachineModel& machine, const kinematics::InverseKinematics& inverse, double radius,
            MotionStatistics& statistics)
      : trajectory_(trajectory),
        path_(path),
        blocks_(blocks),
        machine_(machine),
        inverse_(inverse),
        radius_(radius),
        out_(statistics) {}

  void measure(size_t k) {
    const ToolSample& sample = trajectory_.samples[k];
    const MachineModel& machine =
        blocks_.empty() ? machine_ : *blocks_[static_cast<size_t>(sample.element)].machine;
    const ToolPose back = kinematics::forward(machine, trajectory_.axes[k]);
    out_.fk_ik_error_max_mm = std::max(out_.fk_ik_error_max_mm, (back.tip_W - sample.pose.tip_W).norm());
    const double pole = inverse_.pole_distance(sample.pose.axis_W);
    if (pole < kinematics::kPoleTolerance) ++out_.singular_ticks;
    const auto& what = path_.elements[static_cast<size_t>(sample.element)].what;
    const ToolPose middle =
        k > 0 ? kinematics::forward(machine, 0.5 * (trajectory_.axes[k - 1] + trajectory_.axes[k])) : back;
    if (sample.kind == SampleKind::kCutting && pole < out_.pole_distance_min_rad) {
      out_.pole_distance_min_rad = pole;
      out_.pole_element = sample.element;
    }
    if (k == 0) return;
    const ToolSample& before = trajectory_.samples[k - 1];
    if (const auto* pass = std::get_if<SurfacePass>(&what)) {
      measure_contact(*pass, before, sample, middle);
    } else if (const auto* move = std::get_if<FreeMove>(&what)) {
      const double error =
          distance_across(middle.tip_W - move->from.tip_W, move->to.tip_W - move->from.tip_W);
      out_.tip_error_max_mm = std::max(out_.tip_error_max_mm, error);
    } else {
      measure_block(std::get<BlockMove>(what), before, sample, middle);
    }
  }

 private:
  void measure_contact(const SurfacePass& pass, const ToolSample& before, const ToolSample& sample,
                       const ToolPose& middle) {
    const Vec3 chord = sample.contact_W - before.contact_W;
    const double period = trajectory_.period_s;
    const double length = chord.norm();
    out_.path_length_mm += length;
    out_.feed_error_max_rel = std::max(
        out_.feed_error_max_rel, std::abs(length - sample.feed_mm_s * period) / (pass.feed_mm_s * period));
    const double t = curve_parameter(pass, sample.u, sample.v);
    const ToolPose exact = contact_pose(pass, t, radius_);
    out_.orientation_error_max_rad =
        std::max(out_.orientation_error_max_rad, angle_between(exact.axis_W, sample.pose.axis_W));
    const double t_middle = 0.5 * (t + previous_parameter(pass, before));
    const Vec3 on_curve = curve_point(*pass.surface, pass.curve, t_middle);
    const double chord_error = distance_across(0.5 * (sample.contact_W + before.contact_W) - on_curve, chord);
    out_.chord_error_max_mm = std::max(out_.chord_error_max_mm, chord_error);
    const Vec3 tip_gap = middle.tip_W - contact_pose(pass, t_middle, radius_).tip_W;
    const double tip_error = distance_across(tip_gap, sample.pose.tip_W - before.pose.tip_W);
    out_.tip_error_max_mm = std::max(out_.tip_error_max_mm, tip_error);
  }

  void measure_block(const BlockMove& block, const ToolSample& before, const ToolSample& sample,
                     const ToolPose& middle) {
    const Vec3 chord = sample.pose.tip_W - before.pose.tip_W;
    const bool cutting = sample.kind == SampleKind::kCutting;
    const BlockMove& last = *blocks_[static_cast<size_t>(before.element)].block;
    if (last.tool != block.tool) return;  // another tool's tip: no way between them
    if (cutting) out_.path_length_mm += chord.norm();
    if (sample.rounded && cutting) measure_corner(sample);
    if (before.element != sample.element || before.rounded || sample.rounded) return;
    const ToolPose exact = pose_at(blocks_[static_cast<size_t>(sample.element)], 0.5 * (before.u + sample.u));
    const double tip_error = distance_across(middle.tip_W - exact.tip_W, chord);
    out_.tip_error_max_mm = std::max(out_.tip_error_max_mm, tip_error);
    if (!cutting) return;
    const double period = trajectory_.period_s;
    out_.feed_error_max_rel =
        std::max(out_.feed_error_max_rel,
                 std::abs(chord.norm() - sample.feed_mm_s * period) / (programmed_feed(block) * period));
    const Vec3 gap = 0.5 * (sample.pose.tip_W + before.pose.tip_W) - exact.tip_W;
    out_.chord_error_max_mm = std::max(out_.chord_error_max_mm, distance_across(gap, chord));
  }

  void measure_corner(const ToolSample& sample) {
    const BlockMotion& motion = blocks_[static_cast<size_t>(sample.element)];
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

  const Trajectory& trajectory_;
  const toolpath::ToolPath& path_;
  std::span<const BlockMotion> blocks_;
  const MachineModel& machine_;
  const kinematics::InverseKinematics& inverse_;
  double radius_;
  MotionStatistics& out_;
};

std::vector<AxisStatistics> measure_axes(const Trajectory& trajectory, const MachineModel& machine) {
  std::vector<AxisStatistics> all;
  const std::vector<AxisValues>& q = trajectory.axes;
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    AxisStatistics axis;
    axis.name = machine.axes[i].name;
    axis.min = axis.max = q.front()[row];
    double speed = 0.0, acceleration = 0.0;
    for (size_t k = 1; k < q.size(); ++k) {
      axis.min = std::min(axis.min, q[k][row]);
      axis.max = std::max(axis.max, q[k][row]);
      if (tool_changes(trajectory, k)) {
        speed = 0.0;
        continue;
      }
      const double change = q[k][row] - q[k - 1][row];
      axis.travel += std::abs(change);
      const double before = speed;
      speed = change / trajectory.period_s;
      axis.speed_max = std::max(axis.speed_max, std::abs(speed));
      const double acceleration_before = acceleration;
      acceleration = (speed - before) / trajectory.period_s;
      axis.acceleration_max = std::max(axis.acceleration_max, std::abs(acceleration));
      axis.jerk_max =
          std::max(axis.jerk_max, std::abs(acceleration - acceleration_before) / trajectory.period_s);
      const bool rapid = trajectory.samples[k].kind == SampleKind::kRapid;
      if (std::abs(speed) >= kAtLimit * speed_limit(machine.axes[i], rapid))
        axis.time_at_speed_limit_s += trajectory.period_s;
    }
    all.push_back(axis);
  }
  return all;
}

bool is_rapid_element(const toolpath::Element& element) {
  if (const auto* move = std::get_if<FreeMove>(&element.what)) return move->feed_mm_s == 0.0;
  const auto* block = std::get_if<BlockMove>(&element.what);
  return block != nullptr && is_rapid(*block);
}

CycleTime measure_cycle(const Trajectory& trajectory, const toolpath::ToolPath& path) {
  CycleTime cycle;
  for (size_t k = 1; k < trajectory.samples.size(); ++k) {
    if (tool_changes(trajectory, k)) continue;
    const ToolSample& sample = trajectory.samples[k];
    const toolpath::Element& element = path.elements[static_cast<size_t>(sample.element)];
    const auto* block = std::get_if<BlockMove>(&element.what);
    // A block's dwell stands at its start; all its other ticks are further on.
    const bool dwells = block != nullptr && block->dwell_s > 0.0 && sample.u == 0.0;
    (dwells                      ? cycle.dwell_s
     : is_rapid_element(element) ? cycle.rapid_s
                                 : cycle.feed_s) += trajectory.period_s;
    const size_t tool = block != nullptr ? static_cast<size_t>(block->tool) : 0;
    if (cycle.by_tool_s.size() <= tool) cycle.by_tool_s.resize(tool + 1, 0.0);
    cycle.by_tool_s[tool] += trajectory.period_s;
  }
  return cycle;
}

/// First sample of the element after the one at `begin`.
size_t element_end(const Trajectory& trajectory, size_t begin) {
  size_t end = begin + 1;
  while (end < trajectory.samples.size() &&
         trajectory.samples[end].element == trajectory.samples[begin].element)
    ++end;
  return end;
}

/// Least feed of samples [begin, end) between the first and the last that have their top feed.
double least_feed(const Trajectory& trajectory, size_t begin, size_t end) {
  double top = 0.0;
  for (size_t k = begin; k < end; ++k) top = std::max(top, trajectory.samples[k].feed_mm_s);
  const auto at_top = [&](size_t k) { return trajectory.samples[k].feed_mm_s >= kTopFeedShare * top; };
  size_t first = begin, last = end - 1;
  while (!at_top(first)) ++first;
  while (!at_top(last)) --last;
  double least = top;
  for (size_t k = first; k <= last; ++k) least = std::min(least, trajectory.samples[k].feed_mm_s);
  return least;
}

double feed_min(const Trajectory& trajectory) {
  double least = -1.0;
  for (size_t begin = 0; begin < trajectory.samples.size();) {
    const size_t end = element_end(trajectory, begin);
    if (trajectory.samples[begin].kind == SampleKind::kCutting) {
      const double feed = least_feed(trajectory, begin, end);
      least = least < 0.0 ? feed : std::min(least, feed);
    }
    begin = end;
  }
  return std::max(0.0, least);
}

std::string element_name(const toolpath::Element& element) {
  if (const auto* pass = std::get_if<SurfacePass>(&element.what))
    return fmt::format("pass {}", pass->pass + 1);
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

/// The worst excess of one kind on one axis within one element.
struct Worst {
  double excess = 0.0, value = 0.0, limit = 0.0;
  size_t sample = 0;
  void see(double e, double v, double l, size_t k) {
    if (e > excess) *this = {e, v, l, k};
  }
};

std::string travel_text(const kinematics::Axis& axis, const Worst& worst, const std::string& where) {
  const bool rotary = axis.kind == AxisKind::kRotary;
  const double scale = rotary ? deg_from_rad(1.0) : 1.0;
  const char* unit = rotary ? "deg" : "mm";
  return fmt::format(
      "axis {} would have to go to {:.3f} {} in {}, {:.3f} {} beyond its travel of {:.3f} .. {:.3f} {}",
      axis.name, scale * worst.value, unit, where, scale * worst.excess, unit, scale * axis.min,
      scale * axis.max, unit);
}

std::string speed_text(const kinematics::Axis& axis, const Worst& worst, const std::string& where) {
  const bool rotary = axis.kind == AxisKind::kRotary;
  const double scale = rotary ? deg_from_rad(1.0) : 1.0;
  return fmt::format("axis {} would have to move at {:.3f} {} in {}, its limit is {:.3f}", axis.name,
                     scale * worst.value, rotary ? "deg/s" : "mm/s", where, scale * worst.limit);
}

void find_in_element(const Trajectory& trajectory, size_t begin, size_t end, const toolpath::Element& element,
                     const MachineModel& machine, std::vector<MotionFinding>& findings) {
  const int index = trajectory.samples[begin].element;
  const auto* block = std::get_if<BlockMove>(&element.what);
  const bool rapid = block != nullptr && is_rapid(*block);
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    const kinematics::Axis& axis = machine.axes[i];
    const auto row = static_cast<Eigen::Index>(i);
    const double most = speed_limit(axis, rapid);
    Worst travel, speed;
    for (size_t k = begin; k < end; ++k) {
      const double q = trajectory.axes[k][row];
      const double beyond = std::abs(kinematics::travel_excess(axis, q));
      if (beyond > kTravelTolerance) travel.see(beyond, q, q < axis.min ? axis.min : axis.max, k);
      if (k == 0 || tool_changes(trajectory, k)) continue;
      const double v = std::abs(q - trajectory.axes[k - 1][row]) / trajectory.period_s;
      if (v > most * (1.0 + kAxisSpeedTolerance)) speed.see(v - most, v, most, k);
    }
    const std::string where = element_name(element);
    if (travel.excess > 0.0)
      findings.push_back({"travel", travel_text(axis, travel, where), index,
                          trajectory.samples[travel.sample].t_s, element.where});
    if (speed.excess > 0.0)
      findings.push_back({"axis-speed", speed_text(axis, speed, where), index,
                          trajectory.samples[speed.sample].t_s, element.where});
  }
}

}  // namespace

MotionStatistics measure_motion(const Trajectory& trajectory, const toolpath::ToolPath& path,
                                std::span<const BlockMotion> blocks, const MachineModel& machine,
                                const kinematics::InverseKinematics& inverse, const cutter::Cutter& cutter) {
  MotionStatistics statistics;
  statistics.pole_distance_min_rad = kPi;
  if (trajectory.samples.empty()) return statistics;
  statistics.ticks = trajectory.samples.size() - 1;
  statistics.time_s = trajectory.samples.back().t_s;
  TickMeter meter(trajectory, path, blocks, machine, inverse, cutter.radius(), statistics);
  for (size_t k = 0; k < trajectory.samples.size(); ++k) meter.measure(k);
  statistics.feed_min_mm_s = feed_min(trajectory);
  statistics.axes = measure_axes(trajectory, machine);
  statistics.cycle = measure_cycle(trajectory, path);
  statistics.other_mode = other_mode(blocks);
  return statistics;
}

std::vector<MotionFinding> find_axis_faults(const Trajectory& trajectory, const toolpath::ToolPath& path,
                                            const MachineModel& machine) {
  std::vector<MotionFinding> findings;
  for (size_t begin = 0; begin < trajectory.samples.size();) {
    const size_t end = element_end(trajectory, begin);
    const auto index = static_cast<size_t>(trajectory.samples[begin].element);
    find_in_element(trajectory, begin, end, path.elements[index], machine, findings);
    begin = end;
  }
  return findings;
}

}  // namespace swarf::motion
