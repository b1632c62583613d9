#include "cli/nc_motion.h"

#include <fmt/format.h>

#include <utility>

#include "base/units.h"
#include "cli/terminal.h"
#include "cutter/cutter.h"
#include "motion/blocks/dog_leg.h"
#include "motion/interpolator.h"

namespace swarf::cli {
namespace {

/// The machine with each tool of the table in its spindle, or as it stands.
std::vector<kinematics::MachineModel> machines_of(const program::ControlSetup& setup) {
  std::vector<kinematics::MachineModel> machines;
  for (const program::NcTool& tool : setup.tools)
    machines.push_back(kinematics::with_tool(setup.machine, tool.length_mm));
  if (machines.empty()) machines.push_back(setup.machine);
  return machines;
}

double shown(const kinematics::Axis& axis, double value) {
  return axis.kind == kinematics::AxisKind::kRotary ? deg_from_rad(value) : value;
}

const char* unit_of(const kinematics::Axis& axis) {
  return axis.kind == kinematics::AxisKind::kRotary ? "deg" : "mm";
}

/// Keys as in [interpolator] of a scene (scenes/README.md).
nlohmann::ordered_json interpolator_json(const motion::MotionOptions& taken) {
  return {{"period_ms", taken.period_s * 1e3},
          {"path_acceleration_max_mm_s2", taken.path_acceleration_max},
          {"path_jerk_max_mm_s3", taken.path_jerk_max},
          {"corner_tolerance_um", um_from_mm(taken.corner_tolerance_mm)}};
}

}  // namespace

bool NcMotionSink::move(const program::NcMove& move) {
  if (++moves_ == kMovesMost + 1) path_ = {};
  if (too_many()) return next_.move(move);
  program::NcMove known = move;
  // Without a table every tool is the machine's own point.
  if (setup_.tools.empty()) known.tool = 0;
  path_.move(known);
  return next_.move(move);
}

std::optional<motion::MotionStatistics> NcMotionSink::drive(const program::NcSummary& summary) {
  if (too_many()) return std::nullopt;
  Diagnostics diagnostics;
  toolpath::ToolPath path = path_.finish(summary, diagnostics).path;
  if (diagnostics.has_errors() || path.elements.empty() || interrupted()) return std::nullopt;
  const std::vector<kinematics::MachineModel> machines = machines_of(setup_);
  path = motion::with_dog_legs(std::move(path), machines);
  motion::CycleLimits limits;
  limits.kept = 0;
  motion::Cycles cycles(path.elements, machines, cutter::Cutter{}, motion::MotionOptions{}, limits);
  TerminalProgress progress;
  const motion::MotionResult result = motion::interpolate(cycles, progress);
  if (cycles.stopped()) return std::nullopt;
  return result.statistics;
}

std::string motion_text(const motion::MotionStatistics& motion, const kinematics::MachineModel& machine) {
  const motion::CycleTime& time = motion.cycle;
  std::string text = fmt::format(
      "\n  driven    {:.3f} s with look-ahead, {} cycles: feed {:.3f} s, rapid {:.3f} s, dwell {:.3f} s",
      motion.time_s, motion.ticks, time.feed_s, time.rapid_s, time.dwell_s);
  const motion::MotionOptions taken;
  text += fmt::format(
      "\n            the interpolator's defaults: cycles of {:g} ms, along the path {:g} mm/s^2 and {:g} "
      "mm/s^3, "
      "corners within {:g} mm where the program gives no tolerance",
      taken.period_s * 1e3, taken.path_acceleration_max, taken.path_jerk_max, taken.corner_tolerance_mm);
  for (size_t i = 0; i < motion.axes.size(); ++i) {
    const kinematics::Axis& axis = machine.axes[i];
    const motion::AxisStatistics& of = motion.axes[i];
    text += fmt::format("\n  {:<9} {} {:.4f} to {:.4f} {unit}, {:.4f} {unit} in all, at most {:.3f} {unit}/s",
                        i == 0 ? "travel" : "", axis.name, shown(axis, of.min), shown(axis, of.max),
                        shown(axis, of.travel), shown(axis, of.speed_max), fmt::arg("unit", unit_of(axis)));
  }
  return text;
}

nlohmann::ordered_json motion_json(const motion::MotionStatistics& motion,
                                   const kinematics::MachineModel& machine) {
  nlohmann::ordered_json json{{"time_s", motion.time_s},
                              {"cycles", motion.ticks},
                              {"feed_time_s", motion.cycle.feed_s},
                              {"rapid_time_s", motion.cycle.rapid_s},
                              {"dwell_time_s", motion.cycle.dwell_s},
                              {"interpolator", interpolator_json({})},
                              {"axes", nlohmann::ordered_json::array()}};
  for (size_t i = 0; i < motion.axes.size(); ++i) {
    const kinematics::Axis& axis = machine.axes[i];
    const motion::AxisStatistics& of = motion.axes[i];
    const std::string unit = unit_of(axis);
    json["axes"].push_back({{"name", axis.name},
                            {"min_" + unit, shown(axis, of.min)},
                            {"max_" + unit, shown(axis, of.max)},
                            {"travel_" + unit, shown(axis, of.travel)},
                            {"speed_max_" + unit + "_s", shown(axis, of.speed_max)}});
  }
  return json;
}

}  // namespace swarf::cli
