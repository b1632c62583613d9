// Numbered and named parameters: the program's own, and what the control and the machine answer.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "program/linuxcnc/steps.h"

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

/// "%d", "%f" or "%.3f" at the start of `text`: its length, and the decimals it asks for.
size_t format_word(std::string_view text, int& decimals) {
  if (text.starts_with("%d")) return decimals = 0, 2;
  if (text.starts_with("%lf")) return decimals = 6, 3;
  if (text.starts_with("%f")) return decimals = 4, 2;
  if (text.size() >= 4 && text[1] == '.' && text[2] >= '0' && text[2] <= '9' && text[3] == 'f')
    return decimals = text[2] - '0', 4;
  return 0;
}

/// Stored positions, offsets and tool data count in the units of the INI file whatever G20 and G21 say.
double machine_length(const LetterDialect& letters, double mm, long number, size_t place) {
  if (letters.control.modal.inches() && mm != 0.0)
    letters.control.report.fail(
        "machine-value", letters.reader.column_of(place),
        fmt::format("#{} counts in the units of the machine's INI file, mm or inch, and G20 is active",
                    number),
        "read it under G21, where a machine in mm is meant");
  return mm;
}

double position_parameter(LetterDialect& letters, long number, size_t place) {
  const long word = number - 5420;
  if (word >= kAxisWords) return 0.0;
  const double value = nc::position(letters.control)[static_cast<size_t>(word)];
  if (!std::isfinite(value))
    letters.control.report.fail("start-unknown", letters.reader.column_of(place),
                                fmt::format("#{} asks for a position that is not known yet", number),
                                "give the start position: start in [setup] of the scene, swarf check --home");
  return word < 3 ? value / letters.control.modal.mm(1.0) : deg_from_rad(value);
}

double system_parameter(Zero& zero, LetterDialect& letters, long number, size_t place) {
  const auto by_word = [&](const kinematics::AxisValues& q, long word) {
    const int axis = word < kAxisWords ? letters.control.space.axis_of(static_cast<AxisWord>(word)) : -1;
    return axis < 0   ? 0.0
           : word < 3 ? machine_length(letters, q[axis], number, place)
                      : deg_from_rad(q[axis]);
  };
  for (const long first : {5161L, 5181L}) {
    const bool second = first == 5181;
    if (number >= first && number < first + 9 && reference_position(zero, letters, second))
      return by_word(*reference_position(zero, letters, second), number - first);
  }
  if (number == 5210) return zero.shift_on ? 1.0 : 0.0;
  if (number >= 5211 && number <= 5219) return by_word(zero.shift, number - 5211);
  if (number == 5220) return letters.control.offsets.active;
  if (number >= 5221 && number <= 5390) {
    const long offset = (number - 5221) / 20 + 1, word = (number - 5221) % 20;
    if (word == 9) return deg_from_rad(zero.offset_turn[static_cast<size_t>(offset)]);
    if (word < 9)
      return by_word(
          nc::offset_origin(letters.control.space, letters.control.offsets, static_cast<int>(offset)), word);
  }
  if (number == 5400) return letters.control.tools.active_number;
  if (number >= 5401 && number <= 5409)
    return number == 5403 ? machine_length(letters, letters.control.space.length(), number, place) : 0.0;
  if (number == 5410)
    return machine_length(letters, diameter_of(zero, letters, 0, 0).value_or(0.0), number, place);
  if (number >= 5420 && number <= 5428) return position_parameter(letters, number, place);
  letters.control.report.fail(
      "undefined-parameter", letters.reader.column_of(place),
      fmt::format("#{} is no parameter that can be read here", number),
      "read #5210 to #5390 (offsets), #5400 to #5410 (tool), #5420 to #5428 (position)");
}

/// #<_hal[pin]> and #<_ini[section]name>: neither values nor whether they exist are in the program.
void refuse_machine_value(const LetterDialect& letters, std::string_view name, size_t place) {
  const bool pin = name.starts_with("_hal[");
  if (!pin && !name.starts_with("_ini[")) return;
  letters.control.report.fail(
      "machine-value", letters.reader.column_of(place),
      fmt::format("#<{}> is {}, which is not here", name,
                  pin ? "a HAL pin of the running machine" : "an entry of the machine's INI file"),
      "assign the value that is to be checked to a parameter, and read that one");
}

std::optional<double> predefined(LinuxCnc& linuxcnc, std::string_view name) {
  if (const long word = axis_in(name, "_abs_"); word >= 0) {
    const int axis = word < kAxisWords ? linuxcnc.control.space.axis_of(static_cast<AxisWord>(word)) : -1;
    if (axis < 0) return 0.0;
    const double value = linuxcnc.control.path.q[axis];
    return word < 3 ? value / linuxcnc.control.modal.mm(1.0) : deg_from_rad(value);
  }
  const FeedMode feed = linuxcnc.control.modal.feed_mode;
  const std::pair<std::string_view, double> values[] = {
      {"_feed", linuxcnc.control.modal.feed},
      {"_rpm", linuxcnc.control.modal.speed_rpm},
      {"_current_tool", linuxcnc.control.tools.active_number},
      {"_selected_tool", linuxcnc.modes.tool_called ? linuxcnc.control.tools.selected_number : -1.0},
      {"_tool_offset", linuxcnc.control.tools.length_on ? 1.0 : 0.0},
      {"_metric", linuxcnc.control.modal.inches() ? 0.0 : 1.0},
      {"_imperial", linuxcnc.control.modal.inches() ? 1.0 : 0.0},
      {"_absolute", linuxcnc.modes.incremental ? 0.0 : 1.0},
      {"_incremental", linuxcnc.modes.incremental ? 1.0 : 0.0},
      {"_inverse_time", feed == FeedMode::kInverseTime ? 1.0 : 0.0},
      {"_units_per_minute", feed == FeedMode::kPerMinute ? 1.0 : 0.0},
      {"_units_per_rev", feed == FeedMode::kPerRevolution ? 1.0 : 0.0},
      {"_ijk_absolute_mode", linuxcnc.modes.arc_absolute ? 1.0 : 0.0},
      {"_ijk_incremental_mode", linuxcnc.modes.arc_absolute ? 0.0 : 1.0},
      {"_retract_r_plane", linuxcnc.modes.retract_to_r ? 1.0 : 0.0},
      {"_retract_old_z", linuxcnc.modes.retract_to_r ? 0.0 : 1.0},
      {"_plane", 170.0 + 10.0 * static_cast<int>(linuxcnc.control.modal.plane)},
      {"_ccomp", linuxcnc.modes.radius_code},
      {"_line", static_cast<double>(linuxcnc.calls.stack.top().source->line_number())},
      {"_motion_mode", linuxcnc.modes.motion},
      {"_call_level", static_cast<double>(linuxcnc.calls.stack.size() - 1)},
      {"_remap_level", 0.0},
      {"_task", 1.0},  // the machine, not the preview
      {"_value", linuxcnc.parameters.returned},
      {"_value_returned", linuxcnc.parameters.value_returned ? 1.0 : 0.0},
      {"_spindle_on", linuxcnc.control.modal.spindle != 0 ? 1.0 : 0.0},
      {"_spindle_cw", linuxcnc.control.modal.spindle > 0 ? 1.0 : 0.0},
      {"_spindle_rpm_mode", 1.0},
      {"_spindle_css_mode", 0.0},
      {"_lathe_diameter_mode", 0.0},
      {"_lathe_radius_mode", 0.0},
      {"_mist", linuxcnc.modes.mist ? 1.0 : 0.0},
      {"_flood", linuxcnc.modes.flood ? 1.0 : 0.0},
      {"_coord_system", linuxcnc.control.offsets.active <= 6 ? 530 + 10 * linuxcnc.control.offsets.active
                                                             : 584 + linuxcnc.control.offsets.active},
  };
  for (const auto& [word, value] : values) {
    if (word == name) return value;
  }
  return std::nullopt;
}

}  // namespace

double LinuxCnc::read(long number, size_t place) {
  if (number >= 1 && number <= kArguments) {
    // Arguments that a call does not give are zero; the main program has none.
    if ((frame(calls).assigned >> number & 1u) != 0 || calls.stack.called())
      return frame(calls).arguments[static_cast<size_t>(number)];
  } else if (number == 5399 && modes.input_read) {
    control.report.fail(
        "machine-value", reader.column_of(place),
        "#5399 holds the input that M66 read, which only the machine knows",
        "check the branches one by one: assign the value that is to be checked to a parameter instead");
  } else if (number > kArguments && number < kNumbers && parameters.number_set[static_cast<size_t>(number)]) {
    return parameters.numbers[static_cast<size_t>(number)];
  } else if (number == kDebugOutput) {
    return parameters.debug_output;
  } else if (number >= 5161) {
    return system_parameter(zero, *this, number, place);
  }
  if (number < 1 || parameters.in_message)
    control.report.fail("undefined-parameter", reader.column_of(place),
                        fmt::format("#{} is no parameter", number), "parameters have numbers from 1");
  control.report.warn_once("undefined-parameter", reader.column_of(place),
                           fmt::format("#{} is read and nothing assigned it: LinuxCNC gives 0, or what its "
                                       "parameter file holds",
                                       number),
                           "assign it before it is read");
  return 0.0;
}

double LinuxCnc::read_named(std::string_view name, size_t place) {
  refuse_machine_value(*this, name, place);
  const auto& list = name[0] == '_' ? parameters.globals : frame(calls).named;
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const Named& one) { return one.name == name; });
  if (found != list.end()) return found->value;
  if (const long word = axis_in(name, "_"); word >= 0) return position_parameter(*this, 5420 + word, place);
  if (axis_in(name, "_abs_") >= 0 && !control.path.started)
    control.report.fail("start-unknown", reader.column_of(place),
                        fmt::format("#<{}> asks for a position that is not known yet", name),
                        "give the start position: start in [setup] of the scene, swarf check --home");
  if (const std::optional<double> value = predefined(*this, name)) return *value;
  if (of_machine(name))
    control.report.fail("machine-value", reader.column_of(place),
                        fmt::format("#<{}> is known to the machine only, not to its program", name),
                        "write the value that is to be checked instead");
  control.report.fail("undefined-parameter", reader.column_of(place),
                      fmt::format("#<{}> has no value: nothing assigned it", name),
                      "assign it before it is read, or ask EXISTS first");
}

bool is_read_only(LinuxCnc& linuxcnc, std::string_view name) {
  if (name[0] != '_') return false;
  return name.starts_with("_hal[") || name.starts_with("_ini[") || axis_in(name, "_") >= 0 ||
         of_machine(name) || predefined(linuxcnc, name).has_value();
}

bool LinuxCnc::exists(std::string_view name) {
  refuse_machine_value(*this, name, reader.at());
  const auto& list = name[0] == '_' ? parameters.globals : frame(calls).named;
  return std::any_of(list.begin(), list.end(), [&](const Named& one) { return one.name == name; }) ||
         is_read_only(*this, name);
}

/// Of (MSG, ...) as written; in (DEBUG, ...) and (PRINT, ...) parameters stand for their values, "######"
/// where there is none.
std::string message_text(LetterDialect& letters) {
  const std::string_view line = letters.reader.line(), text = letters.block.message;
  const auto at = static_cast<size_t>(text.data() - line.data());
  const char last = at >= 2 ? static_cast<char>(line[at - 2] | 0x20) : ' ';
  const bool fills_in = last == 'g' && at >= 6 && (line[at - 3] | 0x20) == 'u';  // DEBUG, not MSG
  if (!fills_in && last != 't') return std::string(text);
  const size_t back = letters.reader.at();
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
    letters.reader.move_to(at + i);
    try {
      all += fmt::format("{:.{}f}", letters.reader.value(), decimals);
    } catch (const InputError&) {
      all += "######";
    }
    i = std::max(i + 1, letters.reader.at() - at);
  }
  letters.reader.move_to(back);
  return all;
}

}  // namespace swarf::program::nc::linuxcnc
