#include "machine/axis_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/units.h"

namespace swarf::machine {
namespace {

using kinematics::Axis;
using kinematics::AxisKind;

/// A direction in a file carries the digits that a person wrote; within this it is meant as a unit vector and
/// is normalised.
constexpr double kWrittenUnitTolerance = 1e-9;

constexpr double kNotSaid = std::numeric_limits<double>::quiet_NaN();

/// What machines of a size usually have; rotary in deg.
struct MachineClass {
  const char* name;
  double travel_max_mm;  ///< of its longest linear axis
  double acceleration, jerk, rotary_acceleration, rotary_jerk;
};
constexpr std::array<MachineClass, 3> kClasses{
    {{"machining centre", 1000.0, 4000.0, 50000.0, 600.0, 12000.0},
     {"large machining centre", 2500.0, 3000.0, 40000.0, 400.0, 8000.0},
     {"gantry", std::numeric_limits<double>::infinity(), 1500.0, 20000.0, 200.0, 4000.0}}};

const std::vector<std::string> kAxisLetters{"X", "Y", "Z", "A", "B", "C", "U", "V", "W"};

bool is_rotary(const Axis& axis) {
  return axis.kind == AxisKind::kRotary;
}

Vec3 read_direction(ConfigTable& table, const std::string& key,
                    std::optional<std::vector<double>> fallback = {}) {
  // What is no vector at all has one diagnostic, not a second one for its length.
  if (table.has(key)) fallback = std::vector<double>{1, 0, 0};
  const Vec3 direction = read_vec3(table, key, fallback);
  const double length = direction.norm();
  if (table.has(key) && std::abs(length - 1.0) > kWrittenUnitTolerance) {
    table.error("direction-not-unit", key,
                fmt::format("'{}' is not a unit vector, its length is {:.9g}", key, length),
                length > 0.0 ? fmt::format("write [{:.12g}, {:.12g}, {:.12g}]", direction.x() / length,
                                           direction.y() / length, direction.z() / length)
                             : "write a vector of length 1");
    return Vec3::UnitX();
  }
  return length > 0.0 ? Vec3(direction / length) : Vec3::UnitX();
}

/// Limits carry their unit in the key: min_mm, speed_max_mm_min, ... for linear, min_deg, speed_max_deg_s,
/// ... for rotary axes.
void read_limits(ConfigTable& table, Axis& axis) {
  const bool rotary = axis.kind == AxisKind::kRotary;
  const std::string unit = rotary ? "deg" : "mm";
  const double scale = rotary ? rad_from_deg(1.0) : 1.0;
  axis.min = scale * table.number("min_" + unit, {});
  axis.max = scale * table.number("max_" + unit, {});
  axis.speed_max = rotary ? scale * table.number("speed_max_deg_s", kAboveZero)
                          : mm_s_from_mm_min(table.number("speed_max_mm_min", kAboveZero));
  // What is not given follows from the class of the whole machine: set_usual_dynamics().
  axis.acceleration_max = scale * table.number("acceleration_max_" + unit + "_s2", kAboveZero, kNotSaid);
  axis.jerk_max = scale * table.number("jerk_max_" + unit + "_s3", kAboveZero, kNotSaid);
  const std::string rapid = rotary ? "rapid_max_deg_s" : "rapid_max_mm_min";
  if (table.has(rapid)) {
    const double written = table.number(rapid, kAboveZero);
    axis.rapid_max = rotary ? scale * written : mm_s_from_mm_min(written);
  }
  axis.home = scale * table.number("home_" + unit, {}, 0.0);
  if (!table.has("min_" + unit) || !table.has("max_" + unit)) return;
  if (!(axis.min < axis.max)) {
    table.error("bad-travel", "min_" + unit,
                fmt::format("the travel of axis {} ends at {:g} {} where it begins at {:g}", axis.name,
                            axis.max / scale, unit, axis.min / scale),
                "min must lie below max");
  } else if (axis.home < axis.min || axis.home > axis.max) {
    table.error(
        "home-outside-travel", "home_" + unit,
        fmt::format("home of axis {} is {:g} {}, outside its travel {:g} .. {:g}", axis.name,
                    axis.home / scale, unit, axis.min / scale, axis.max / scale),
        fmt::format("write home_{} = {:g}, or another place inside the travel", unit, axis.max / scale));
  }
}

/// Where the axis stands while a tool is changed: <letter>_mm or <letter>_deg; home when nothing is said.
double read_change_value(ConfigTable& table, const Axis& axis) {
  const double scale = is_rotary(axis) ? rad_from_deg(1.0) : 1.0;
  const std::string unit = is_rotary(axis) ? "deg" : "mm";
  const std::string key = axis.name + "_" + unit;
  if (!table.has(key)) return axis.home;
  const double value = scale * table.number(key, {});
  if (axis.min < axis.max && (value < axis.min || value > axis.max)) {
    table.error("tool-change-outside-travel", key,
                fmt::format("tools are changed with axis {} at {:g} {}, outside its travel {:g} .. {:g}",
                            axis.name, value / scale, unit, axis.min / scale, axis.max / scale),
                "put the tool change inside the travel");
  }
  return value;
}

}  // namespace

Vec3 read_vec3(ConfigTable& table, const std::string& key,
               const std::optional<std::vector<double>>& fallback) {
  const std::vector<double> v = table.numbers(key, 3, fallback);
  return {v[0], v[1], v[2]};
}

Axis read_axis(ConfigTable& table) {
  Axis axis;
  axis.name = table.text("name");
  if (table.has("name") &&
      std::find(kAxisLetters.begin(), kAxisLetters.end(), axis.name) == kAxisLetters.end()) {
    table.error("unknown-axis", "name", fmt::format("there is no axis '{}'", axis.name),
                fmt::format("axes are called {}", fmt::join(kAxisLetters, " ")));
  }
  // A misspelt type is one mistake: the unit of the limits tells what was meant, and they are read as such.
  const bool in_degrees = table.has("min_deg") || table.has("max_deg") || table.has("speed_max_deg_s");
  std::optional<std::string> meant;
  if (table.has("type")) meant = in_degrees ? "rotary" : "linear";
  axis.kind =
      table.choice("type", {"linear", "rotary"}, meant) == "rotary" ? AxisKind::kRotary : AxisKind::kLinear;
  axis.direction_M = read_direction(table, "direction");
  if (axis.kind == AxisKind::kRotary)
    axis.origin_M = read_vec3(table, "origin_mm", std::vector<double>{0, 0, 0});
  axis.reversed = table.boolean("reversed", false);
  read_limits(table, axis);
  return axis;
}

std::string set_usual_dynamics(std::vector<Axis>& axes) {
  double travel = 0.0;
  for (const Axis& axis : axes) {
    if (!is_rotary(axis)) travel = std::max(travel, axis.max - axis.min);
  }
  const MachineClass& usual = *std::find_if(
      kClasses.begin(), kClasses.end(), [&](const MachineClass& one) { return travel <= one.travel_max_mm; });
  std::vector<std::pair<std::string, std::string>> filled;  // value, axes
  const auto fill = [&](const Axis& axis, double& value, double otherwise, const char* unit) {
    if (!std::isnan(value)) return;
    value = is_rotary(axis) ? rad_from_deg(otherwise) : otherwise;
    const std::string said = fmt::format("{:g} {}/{}", otherwise, is_rotary(axis) ? "deg" : "mm", unit);
    auto row = std::find_if(filled.begin(), filled.end(), [&](const auto& one) { return one.first == said; });
    if (row == filled.end()) row = filled.insert(filled.end(), {said, ""});
    row->second += " " + axis.name;
  };
  for (Axis& axis : axes) {
    const bool rotary = is_rotary(axis);
    fill(axis, axis.acceleration_max, rotary ? usual.rotary_acceleration : usual.acceleration, "s2");
    fill(axis, axis.jerk_max, rotary ? usual.rotary_jerk : usual.jerk, "s3");
  }
  std::string text;
  for (const auto& [value, of] : filled)
    text += fmt::format("{}{} of{}", text.empty() ? "" : ", ", value, of);
  if (text.empty()) return "";
  return text + fmt::format(" (a {}: its longest travel is {:g} mm)", usual.name, travel);
}

void read_tool(ConfigTable& root, kinematics::MachineModel& machine) {
  ConfigTable tool = root.table("tool");
  machine.tool_axis_M = read_direction(tool, "axis", std::vector<double>{0, 0, 1});
  if (tool.has("tip_mm") && tool.has("gauge_mm")) {
    tool.error("tip-and-gauge", "gauge_mm", "the file gives both the tool tip and the gauge line",
               "keep gauge_mm when the tip depends on the tool's length, tip_mm when it does not");
  } else if (!tool.has("tip_mm") && !tool.has("gauge_mm")) {
    tool.error("missing-key", "gauge_mm", "the file gives neither the gauge line nor the tool tip",
               "give gauge_mm (the spindle's gauge line at zero axes), or tip_mm for a tip that stays there");
  }
  if (tool.has("gauge_mm")) machine.gauge_M = read_vec3(tool, "gauge_mm");
  machine.tip_M = tool.has("tip_mm") ? read_vec3(tool, "tip_mm") : machine.gauge_M.value_or(Vec3::Zero());
}

void read_rapid(ConfigTable& root, kinematics::MachineModel& machine) {
  const bool dog_leg = root.choice("rapid", {"linear", "dog_leg"}, "linear") == "dog_leg";
  machine.rapid = dog_leg ? kinematics::RapidMotion::kDogLeg : kinematics::RapidMotion::kLinear;
  if (!root.has("tool_change")) return;
  ConfigTable table = root.table("tool_change");
  kinematics::AxisValues values = kinematics::AxisValues::Zero();
  for (size_t i = 0; i < std::min<size_t>(machine.axes.size(), kinematics::kMaxAxes); ++i) {
    values[static_cast<int>(i)] = read_change_value(table, machine.axes[i]);
  }
  machine.tool_change = values;
}

}  // namespace swarf::machine
