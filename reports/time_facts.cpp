#include "reports/time_facts.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/units.h"

namespace swarf::reports {
namespace {

std::string line_text(const sim::Result& result, int element) {
  return fmt::format("line {}", result.main.path.elements.line(static_cast<size_t>(element)));
}

void add_blocks(const sim::Job& job, const sim::Result& result, FactGroup& group) {
  const motion::MotionStatistics& m = result.main.motion.statistics;
  const motion::MotionOptions& o = job.scene.motion;
  std::string corners =
      fmt::format("rounded within the tolerance of their blocks, else {:g} mm", o.corner_tolerance_mm);
  if (m.corner_element >= 0)
    corners += fmt::format("; at most {:.4f} mm, {}", m.corner_deviation_max_mm,
                           line_text(result, m.corner_element));
  group.facts.push_back(
      {"Corners", corners + (job.scene.stock.cut_by == sim::CutBy::kCycles
                                 ? "; the stock is cut by the control's cycles, so it shows them"
                                 : "; the stock is cut along the programmed blocks")});
  const auto& axes = job.machine.model.axes;
  const bool turns = std::any_of(axes.begin(), axes.end(), [](const kinematics::Axis& axis) {
    return axis.kind == kinematics::AxisKind::kRotary;
  });
  if (!turns) return;  // a three-axis machine has one mode, and nothing to swing
  group.facts.push_back(
      {"Tip error of the other mode",
       m.other_mode.element < 0
           ? "none: no block turns a rotary axis"
           : fmt::format(
                 "{:.4f} mm between axes linear (joint) and tip straight (tcp), {} at {:.3f} of the block",
                 m.other_mode.tip_error_max_mm, line_text(result, m.other_mode.element),
                 m.other_mode.share)});
  group.facts.push_back(
      {"Reported as fast rotary",
       fmt::format("feed blocks above {:g} deg per mm of the tip; swings above {:g} deg in a block",
                   deg_from_rad(o.fast_rotary_rad_mm), deg_from_rad(o.swing_rad))});
}

}  // namespace

FactGroup time_facts(const sim::Job& job, const sim::Result& result) {
  const motion::CycleTime& cycle = result.main.motion.statistics.cycle;
  FactGroup group;
  group.title = "Time and dynamics";
  group.facts.push_back({"Cycle time", fmt::format("feed {:.2f} s, rapid {:.2f} s, dwell {:.2f} s",
                                                   cycle.feed_s, cycle.rapid_s, cycle.dwell_s)});
  if (cycle.by_tool_s.size() > 1) {
    std::string tools;
    for (size_t i = 0; i < cycle.by_tool_s.size(); ++i)
      tools += fmt::format("{}tool {}: {:.2f} s", i > 0 ? ", " : "", i + 1, cycle.by_tool_s[i]);
    group.facts.push_back({"By tool, in the job's order", tools});
  }
  if (toolpath::holds_blocks(result.main.path)) add_blocks(job, result, group);
  return group;
}

Table axis_limit_table(const sim::Job& job, const sim::Result& result) {
  Table table;
  table.title = "Axes against their limits";
  table.columns = {{"Axis"},
                   {"Unit"},
                   {"Acceleration", "per s²", true},
                   {"Limit", "per s²", true},
                   {"Jerk", "per s³", true},
                   {"Limit", "per s³", true},
                   {"At speed limit", "s", true}};
  const motion::MotionStatistics& motion = result.main.motion.statistics;
  for (size_t i = 0; i < motion.axes.size(); ++i) {
    const kinematics::Axis& axis = job.machine.model.axes[i];
    const motion::AxisStatistics& own = motion.axes[i];
    const bool rotary = axis.kind == kinematics::AxisKind::kRotary;
    const auto shown = [&](double value) {
      return fmt::format("{:.1f}", rotary ? deg_from_rad(value) : value);
    };
    table.rows.push_back({axis.name, rotary ? "deg" : "mm", shown(own.acceleration_max),
                          shown(axis.acceleration_max), shown(own.jerk_max), shown(axis.jerk_max),
                          fmt::format("{:.3f}", own.time_at_speed_limit_s)});
  }
  table.notes = {fmt::format(
      "Measured by differences of the axis positions of the cycles. At its speed limit: from {:g} % of it.",
      100.0 * motion::kAtLimit)};
  return table;
}

}  // namespace swarf::reports
