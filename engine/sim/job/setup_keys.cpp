#include "sim/job/setup_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "base/units.h"
#include "sim/job/stock_keys.h"

namespace swarf::sim {
namespace {

constexpr double kFarthestOrigin = 1e6;  // mm: a kilometre
constexpr std::array<const char*, 9> kOffsets{"G54", "G55",   "G56",   "G57",  "G58",
                                              "G59", "G59.1", "G59.2", "G59.3"};

/// The keys that are no axis with its unit, finish() reports.
AxisSettings read_axes(ConfigTable table) {
  AxisSettings settings;
  for (const char letter : std::string_view("XYZABCUVW")) {
    for (const bool rotary : {false, true}) {
      const std::string key = fmt::format("{}_{}", letter, rotary ? "deg" : "mm");
      if (!table.has(key)) continue;
      const double value = table.number(key, {});
      settings.push_back(
          {std::string(1, letter), rotary, rotary ? rad_from_deg(value) : value, table.where(key)});
    }
  }
  return settings;
}

/// What stands in the control before the first block, besides positions.
void read_control_keys(ConfigTable& table, SetupSettings& setup) {
  for (const char* key : {"start_tool", "start_tool_name"}) {
    if (table.has(key)) setup.start_tool_where = table.where(key);
  }
  if (table.has("start_tool")) setup.start_tool = table.integer("start_tool", 1, 1'000'000'000);
  setup.start_tool_name = table.text("start_tool_name", "");
  setup.t_changes_tool = table.boolean("t_changes_tool", false);
  if (table.has("slot_ends"))
    setup.slot_ends = table.choice("slot_ends", {"edge", "centre"}) == "edge" ? program::SlotEnds::kEdge
                                                                              : program::SlotEnds::kCentre;
  setup.tip_without_length = table.choice("without_length", {"gauge_line", "tip"}, "gauge_line") == "tip";
}

/// Of one of several.
void read_list_keys(ConfigTable& table, int number, SetupSettings& setup) {
  setup.number = number;
  setup.name = table.text("name", "");
  setup.pose_said = table.has("part_pose");
  if (!setup.pose_said) return;
  setup.X_WF = read_pose(table.table("part_pose"));
  if (number == 1)
    table.error("part-pose-of-first", "part_pose",
                "the first set-up has a part_pose: its work frame is the one that the others are told by",
                "leave it out; place the stock by [stock], and the work by setup.work_origin_mm");
}

}  // namespace

SetupSettings read_setup(ConfigTable table, bool nc, int number) {
  SetupSettings setup;
  if (number > 0) read_list_keys(table, number, setup);
  if (table.is_text("work_origin_mm")) {
    setup.on_table = table.choice("work_origin_mm", {"on_table"}) == "on_table";
  } else if (table.has("work_origin_mm")) {
    const std::vector<double> origin = table.numbers("work_origin_mm", 3);
    if (origin.size() == 3) setup.work_origin_mm = Vec3(origin[0], origin[1], origin[2]);
    if (setup.work_origin_mm && setup.work_origin_mm->cwiseAbs().maxCoeff() > kFarthestOrigin)
      table.error(
          "out-of-range", "work_origin_mm", "the work's origin is farther away than any machine reaches",
          fmt::format("every number must be from {:g} to {:g} mm", -kFarthestOrigin, kFarthestOrigin));
  }
  setup.work_rotation_rad = rad_from_deg(table.number("work_rotation_deg", {-360.0, 360.0}, 0.0));
  if (table.has("units")) setup.unit_mm = table.choice("units", {"mm", "inch"}) == "inch" ? 25.4 : 1.0;
  if (!nc && table.has("tracut"))
    setup.tracut = table.choice("tracut", {"apply", "applied"}) == "apply" ? program::ClTracut::kApply
                                                                           : program::ClTracut::kApplied;
  if (!nc) return setup;
  if (table.has("start")) setup.start = read_axes(table.table("start"));
  read_control_keys(table, setup);
  ConfigTable offsets = table.table("offsets");
  for (const std::string& key : offsets.keys()) {
    const auto* known = std::find(kOffsets.begin(), kOffsets.end(), key);
    const AxisSettings axes = read_axes(offsets.table(key));
    if (known == kOffsets.end()) {
      offsets.error("unknown-offset", key, fmt::format("'{}' is no work offset", key),
                    fmt::format("one of {}", fmt::join(kOffsets, ", ")));
      continue;
    }
    setup.offsets[static_cast<int>(known - kOffsets.begin()) + 1] = axes;
  }
  return setup;
}

kinematics::AxisValues axis_values(const AxisSettings& settings, const kinematics::MachineModel& machine,
                                   bool complete, Diagnostics& diagnostics) {
  kinematics::AxisValues values = kinematics::AxisValues::Zero();
  std::vector<bool> given(machine.axes.size(), false);
  for (const AxisSetting& setting : settings) {
    const auto axis = std::find_if(machine.axes.begin(), machine.axes.end(),
                                   [&](const kinematics::Axis& a) { return a.name == setting.axis; });
    if (axis == machine.axes.end()) {
      diagnostics.error("unknown-axis", setting.where,
                        fmt::format("the machine {} has no axis {}", machine.name, setting.axis),
                        "name the axes of its machine.toml");
      continue;
    }
    const bool rotary = axis->kind == kinematics::AxisKind::kRotary;
    if (rotary != setting.rotary) {
      diagnostics.error("wrong-unit", setting.where,
                        fmt::format("axis {} is {}", setting.axis, rotary ? "rotary" : "linear"),
                        fmt::format("write {}{}", setting.axis, rotary ? "_deg" : "_mm"));
      continue;
    }
    const auto index = axis - machine.axes.begin();
    given[static_cast<size_t>(index)] = true;
    values[index] = setting.value;
  }
  for (size_t i = 0; complete && i < given.size(); ++i) {
    if (given[i]) continue;
    diagnostics.error("missing-axis", settings.empty() ? SourceLocation{} : settings.front().where,
                      fmt::format("the start does not say where axis {} stands", machine.axes[i].name),
                      "name every axis: no position is assumed");
  }
  return values;
}

}  // namespace swarf::sim
