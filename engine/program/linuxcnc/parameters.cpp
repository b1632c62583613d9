// Numbered and named parameters: the program's own, and what the control and the machine answer.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "program/linuxcnc/reader.h"

namespace swarf::program::nc::linuxcnc {
namespace {

constexpr std::string_view kWords = "xyzabcuvw";

/// Names that exist on each control, with values that only the machine or its operator know.
constexpr std::string_view kMachineNames[] = {"_vmajor",         "_vminor",         "_speed_override",
                                              "_feed_override",  "_adaptive_feed",  "_feed_hold",
                                              "_current_pocket", "_selected_pocket"};

/// Index of the axis in "_x" (prefix "_") or "_abs_x"; -1: no such name.
long axis_in(std::string_view name, std::string_view prefix) {
  if (name.size() != prefix.size() + 1 || !name.starts_with(prefix)) return -1;
  const size_t word = kWords.find(name.back());
  return word == std::string_view::npos ? -1 : static_cast<long>(word);
}

bool of_machine(std::string_view name) {
  return std::find(std::begin(kMachineNames), std::end(kMachineNames), name) != std::end(kMachineNames);
}

}  // namespace

double LinuxCnc::read(long number, size_t place) {
  if (number >= 1 && number <= kArguments) {
    // Arguments that a call does not give are zero; the main program has none.
    if ((frame().assigned >> number & 1u) != 0 || calls_.size() > 1)
      return frame().arguments[static_cast<size_t>(number)];
  } else if (number == 5399 && input_read_) {
    control_.report.fail(
        "machine-value", reader_.column_of(place),
        "#5399 holds the input that M66 read, which only the machine knows",
        "check the branches one by one: assign the value that is to be checked to a parameter instead");
  } else if (number > kArguments && number < kNumbers && number_set_[static_cast<size_t>(number)]) {
    return numbers_[static_cast<size_t>(number)];
  } else if (number >= 5161) {
    return system_parameter(number, place);
  }
  control_.report.fail("undefined-parameter", reader_.column_of(place),
                       fmt::format("#{} has no value: nothing assigned it", number),
                       "assign it before it is read");
}

/// Stored positions, offsets and tool data count in the units of the INI file whatever G20 and G21 say.
double LinuxCnc::machine_length(double mm, long number, size_t place) const {
  if (control_.modal.inches() && mm != 0.0)
    control_.report.fail(
        "machine-value", reader_.column_of(place),
        fmt::format("#{} counts in the units of the machine's INI file, mm or inch, and G20 is active",
                    number),
        "read it under G21, where a machine in mm is meant");
  return mm;
}

double LinuxCnc::system_parameter(long number, size_t place) {
  const auto by_word = [&](const kinematics::AxisValues& q, long word) {
    const int axis = word < kAxisWords ? control_.space.axis_of(static_cast<AxisWord>(word)) : -1;
    return axis < 0 ? 0.0 : word < 3 ? machine_length(q[axis], number, place) : deg_from_rad(q[axis]);
  };
  for (const long first : {5161L, 5181L}) {
    const bool second = first == 5181;
    if (number >= first && number < first + 9 && reference_position(second))
      return by_word(*reference_position(second), number - first);
  }
  if (number == 5210) return shift_on_ ? 1.0 : 0.0;
  if (number >= 5211 && number <= 5219) return by_word(shift_, number - 5211);
  if (number == 5220) return control_.offsets.active;
  if (number >= 5221 && number <= 5390) {
    const long offset = (number - 5221) / 20 + 1, word = (number - 5221) % 20;
    if (word == 9) return deg_from_rad(offset_turn_[static_cast<size_t>(offset)]);
    if (word < 9)
      return by_word(nc::offset_origin(control_.space, control_.offsets, static_cast<int>(offset)), word);
  }
  if (number == 5400) return control_.tools.active_number;
  if (number >= 5401 && number <= 5409)
    return number == 5403 ? machine_length(control_.space.length(), number, place) : 0.0;
  if (number == 5410) return machine_length(diameter_of(0, 0).value_or(0.0), number, place);
  if (number >= 5420 && number <= 5428) return position_parameter(number, place);
  control_.report.fail("undefined-parameter", reader_.column_of(place),
                       fmt::format("#{} is no parameter that can be read here", number),
                       "read #5210 to #5390 (offsets), #5400 to #5410 (tool), #5420 to #5428 (position)");
}

double LinuxCnc::position_parameter(long number, size_t place) {
  const long word = number - 5420;
  if (word >= kAxisWords) return 0.0;
  const double value = nc::position(control_)[static_cast<size_t>(word)];
  if (!std::isfinite(value))
    control_.report.fail("start-unknown", reader_.column_of(place),
                         fmt::format("#{} asks for a position that is not known yet", number),
                         "give the start position in the scene");
  return word < 3 ? value / control_.modal.mm(1.0) : deg_from_rad(value);
}

double LinuxCnc::read_named(std::string_view name, size_t place) {
  refuse_machine_value(name, place);
  const auto& list = name[0] == '_' ? globals_ : frame().named;
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const Named& one) { return one.name == name; });
  if (found != list.end()) return found->value;
  if (const long word = axis_in(name, "_"); word >= 0) return position_parameter(5420 + word, place);
  if (axis_in(name, "_abs_") >= 0 && !control_.path.started)
    control_.report.fail("start-unknown", reader_.column_of(place),
                         fmt::format("#<{}> asks for a position that is not known yet", name),
                         "give the start position in the scene");
  if (const std::optional<double> value = predefined(name)) return *value;
  if (of_machine(name))
    control_.report.fail("machine-value", reader_.column_of(place),
                         fmt::format("#<{}> is known to the machine only, not to its program", name),
                         "write the value that is to be checked instead");
  control_.report.fail("undefined-parameter", reader_.column_of(place),
                       fmt::format("#<{}> has no value: nothing assigned it", name),
                       "assign it before it is read, or ask EXISTS first");
}

/// #<_hal[pin]> and #<_ini[section]name>: neither values nor whether they exist are in the program.
void LinuxCnc::refuse_machine_value(std::string_view name, size_t place) const {
  const bool pin = name.starts_with("_hal[");
  if (!pin && !name.starts_with("_ini[")) return;
  control_.report.fail(
      "machine-value", reader_.column_of(place),
      fmt::format("#<{}> is {}, which is not here", name,
                  pin ? "a HAL pin of the running machine" : "an entry of the machine's INI file"),
      "assign the value that is to be checked to a parameter, and read that one");
}

std::optional<double> LinuxCnc::predefined(std::string_view name) {
  if (const long word = axis_in(name, "_abs_"); word >= 0) {
    const int axis = word < kAxisWords ? control_.space.axis_of(static_cast<AxisWord>(word)) : -1;
    if (axis < 0) return 0.0;
    const double value = control_.path.q[axis];
    return word < 3 ? value / control_.modal.mm(1.0) : deg_from_rad(value);
  }
  const FeedMode feed = control_.modal.feed_mode;
  const std::pair<std::string_view, double> values[] = {
      {"_feed", control_.modal.feed},
      {"_rpm", control_.modal.speed_rpm},
      {"_current_tool", control_.tools.active_number},
      {"_selected_tool", tool_called_ ? control_.tools.selected_number : -1.0},
      {"_tool_offset", control_.tools.length_on ? 1.0 : 0.0},
      {"_metric", control_.modal.inches() ? 0.0 : 1.0},
      {"_imperial", control_.modal.inches() ? 1.0 : 0.0},
      {"_absolute", incremental_ ? 0.0 : 1.0},
      {"_incremental", incremental_ ? 1.0 : 0.0},
      {"_inverse_time", feed == FeedMode::kInverseTime ? 1.0 : 0.0},
      {"_units_per_minute", feed == FeedMode::kPerMinute ? 1.0 : 0.0},
      {"_units_per_rev", feed == FeedMode::kPerRevolution ? 1.0 : 0.0},
      {"_ijk_absolute_mode", arc_absolute_ ? 1.0 : 0.0},
      {"_ijk_incremental_mode", arc_absolute_ ? 0.0 : 1.0},
      {"_retract_r_plane", retract_to_r_ ? 1.0 : 0.0},
      {"_retract_old_z", retract_to_r_ ? 0.0 : 1.0},
      {"_plane", 170.0 + 10.0 * static_cast<int>(control_.modal.plane)},
      {"_ccomp", radius_code_},
      {"_line", static_cast<double>(calls_.back().source->line_number())},
      {"_motion_mode", motion_},
      {"_call_level", static_cast<double>(calls_.size() - 1)},
      {"_remap_level", 0.0},
      {"_task", 1.0},  // the machine, not the preview
      {"_value", returned_},
      {"_value_returned", value_returned_ ? 1.0 : 0.0},
      {"_spindle_on", control_.modal.spindle != 0 ? 1.0 : 0.0},
      {"_spindle_cw", control_.modal.spindle > 0 ? 1.0 : 0.0},
      {"_spindle_rpm_mode", 1.0},
      {"_spindle_css_mode", 0.0},
      {"_lathe_diameter_mode", 0.0},
      {"_lathe_radius_mode", 0.0},
      {"_mist", mist_ ? 1.0 : 0.0},
      {"_flood", flood_ ? 1.0 : 0.0},
      {"_coord_system",
       control_.offsets.active <= 6 ? 530 + 10 * control_.offsets.active : 584 + control_.offsets.active},
  };
  for (const auto& [word, value] : values) {
    if (word == name) return value;
  }
  return std::nullopt;
}

bool LinuxCnc::is_read_only(std::string_view name) {
  if (name[0] != '_') return false;
  return name.starts_with("_hal[") || name.starts_with("_ini[") || axis_in(name, "_") >= 0 ||
         of_machine(name) || predefined(name).has_value();
}

bool LinuxCnc::exists(std::string_view name) {
  refuse_machine_value(name, reader_.at());
  const auto& list = name[0] == '_' ? globals_ : frame().named;
  return std::any_of(list.begin(), list.end(), [&](const Named& one) { return one.name == name; }) ||
         is_read_only(name);
}

namespace {

/// "%d", "%f" or "%.3f" at the start of `text`: its length, and the decimals it asks for.
size_t format_word(std::string_view text, int& decimals) {
  if (text.starts_with("%d")) return decimals = 0, 2;
  if (text.starts_with("%lf")) return decimals = 6, 3;
  if (text.starts_with("%f")) return decimals = 4, 2;
  if (text.size() >= 4 && text[1] == '.' && text[2] >= '0' && text[2] <= '9' && text[3] == 'f')
    return decimals = text[2] - '0', 4;
  return 0;
}

}  // namespace

/// Of (MSG, ...) as written; in (DEBUG, ...) and (PRINT, ...) parameters stand for their values, "######"
/// where there is none.
std::string LinuxCnc::message_text() {
  const std::string_view line = reader_.line(), text = block_.message;
  const auto at = static_cast<size_t>(text.data() - line.data());
  const char last = at >= 2 ? static_cast<char>(line[at - 2] | 0x20) : ' ';
  const bool fills_in = last == 'g' && at >= 6 && (line[at - 3] | 0x20) == 'u';  // DEBUG, not MSG
  if (!fills_in && last != 't') return std::string(text);
  const size_t back = reader_.at();
  std::string all;
  int decimals = 6;
  for (size_t i = 0; i < text.size();) {
    if (const size_t length = text[i] == '%' ? format_word(text.substr(i), decimals) : 0; length > 0) {
      i += length;
      continue;
    }
    if (text[i] != '#') {
      all += text[i++];
      continue;
    }
    reader_.move_to(at + i);
    try {
      all += fmt::format("{:.{}f}", reader_.value(), decimals);
    } catch (const InputError&) {
      all += "######";
    }
    i = std::max(i + 1, reader_.at() - at);
  }
  reader_.move_to(back);
  return all;
}

}  // namespace swarf::program::nc::linuxcnc
