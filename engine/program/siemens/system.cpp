// System variables of Siemens 840D whose value is sure here; the others are refused by name.
#include <fmt/format.h>

#include <cmath>

#include "base/units.h"
#include "program/siemens/steps.h"

namespace swarf::program::nc::siemens {
namespace {

constexpr int kOffsetsMax = 99;

/// A whole number among the indices.
std::optional<int> whole_index(const std::vector<Value>& indices, size_t n) {
  if (n >= indices.size() || indices[n].type == Type::kString) return std::nullopt;
  const double value = indices[n].number;
  if (value != std::floor(value) || std::abs(value) > 1e6) return std::nullopt;
  return static_cast<int>(value);
}

[[noreturn]] void bad_index(const SystemName& asked, const char* example) {
  refuse(asked.line, asked.offset, "out-of-range", fmt::format("{} has other indices", asked.name), example);
}

/// The axis that an index names: X or X1.
int system_axis(nc::Control& control, const SystemName& asked, size_t n) {
  const std::string text =
      n < asked.indices.size() && asked.indices[n].type == Type::kString ? asked.indices[n].text : "";
  const bool plain = text.size() == 1 || (text.size() == 2 && text[1] == '1');
  const size_t word = plain ? std::string_view(nc::kAxisLetters).find(text[0]) : std::string_view::npos;
  if (word == std::string_view::npos) bad_index(asked, "name an axis: $AA_IW[X], $P_UIFR[1,X,TR]");
  if (control.space.axis_of(static_cast<nc::AxisWord>(word)) < 0) {
    refuse(asked.line, asked.offset, "axis-missing", fmt::format("the machine has no axis {}", text[0]),
           "choose the machine that the program was posted for");
  }
  return static_cast<int>(word);
}

/// Lengths of system variables are those of the basic system, which a program in inches does not show.
void check_metric(nc::Control& control, const SystemName& asked) {
  if (!control.modal.inches()) return;
  refuse(asked.line, asked.offset, "unsupported-word",
         fmt::format("{} in a program in inches is not supported", asked.name),
         "write G71 or G710 before it");
}

kinematics::AxisValues offset_of(nc::Control& control, const Frames& frames, int number) {
  const auto pending = frames.pending_offsets.find(number);
  return pending == frames.pending_offsets.end() ? nc::offset_origin(control.space, control.offsets, number)
                                                 : pending->second;
}

/// $P_UIFR[1,X,TR] and $P_UIFR[1,X,RT]: number of the offset, 1 is G54.
int offset_index(const SystemName& asked, bool& shifts) {
  const std::optional<int> number = whole_index(asked.indices, 0);
  if (!number || *number < 0 || *number > kOffsetsMax || asked.indices.size() != 3 ||
      asked.indices[2].type != Type::kString) {
    bad_index(asked, "$P_UIFR[1,X,TR]: the offset (1 is G54), the axis, TR");
  }
  const std::string& component = asked.indices[2].text;
  shifts = component == "TR";
  if (!shifts && component != "FI" && component != "RT") {
    refuse(asked.line, asked.offset, "unsupported-word",
           fmt::format("the component {} of offsets is not supported", component),
           "offsets shift (TR); rotate with AROT");
  }
  return *number;
}

/// $P_EP and $AA_IW: programmed coordinates, $AA_IM: those of the machine.
Value position_of(nc::Control& control, Frames& frames, const SystemName& asked) {
  const int word = system_axis(control, asked, 0);
  const size_t n = static_cast<size_t>(word);
  if (asked.name != "$P_EP" &&
      (control.contour.side() != nc::Compensation::kOff || control.contour.leading_out())) {
    refuse(asked.line, asked.offset, "unsupported-word",
           fmt::format("{} while the cutter radius is compensated is not supported", asked.name),
           "read $P_EP, or write G40 and a straight move before it");
  }
  const double value = asked.name == "$AA_IM"
                           ? control.path.q[control.space.axis_of(static_cast<nc::AxisWord>(word))]
                           : nc::position(control)[n] / (word < 3 ? frames.stretch.factor[word] : 1.0);
  if (!std::isfinite(value) || !control.path.started) {
    refuse(asked.line, asked.offset, "start-unknown",
           fmt::format("{} is read, and the position is not known yet", asked.name),
           "give the start position: start in [setup] of the scene, swarf check --home");
  }
  if (word >= 3) return Value::real(deg_from_rad(value));
  check_metric(control, asked);
  return Value::real(value);
}

/// $P_TOOLNO, $P_TOOL, $P_TOOLR, $P_TOOLL[1] of the tool in the spindle, $TC_DP3 and $TC_DP6 by number.
Value tool_data(nc::Control& control, const SystemName& asked) {
  const std::string& name = asked.name;
  const bool stored = name == "$TC_DP3" || name == "$TC_DP6";
  if (!stored && name != "$P_TOOLNO" && name != "$P_TOOL" && name != "$P_TOOLR" && name != "$P_TOOLL") {
    refuse(asked.line, asked.offset, "unsupported-word",
           fmt::format("the system variable {} is not simulated", name),
           "write its value, or assign it to a variable of the program");
  }
  const NcTool* tool = nc::active_tool(control);
  if (stored) {
    const std::optional<int> number = whole_index(asked.indices, 0), edge = whole_index(asked.indices, 1);
    if (!number || edge != 1 || asked.indices.size() != 2) bad_index(asked, "$TC_DP3[5,1]: the tool, edge 1");
    const int index = nc::find_tool(control, *number, column_of(asked.line, asked.offset));
    tool = index < 0 ? nullptr : &control.setup.tools[static_cast<size_t>(index)];
  }
  const bool by_name = name == "$P_TOOLNO" && tool != nullptr && tool->number == 0;
  if (by_name || (tool == nullptr && (stored || control.setup.tools.empty()))) {
    refuse(asked.line, asked.offset, "unsupported-word",
           fmt::format("{} is read, and the tool table does not say it", name),
           "give a tool table with this tool and its number");
  }
  if (name == "$P_TOOLNO") return Value::integer(tool == nullptr ? 0 : tool->number);
  const bool on = stored || (tool != nullptr && control.tools.length_on);
  if (name == "$P_TOOL") return Value::integer(on ? 1 : 0);
  check_metric(control, asked);
  if (name == "$P_TOOLR" || name == "$TC_DP6") return Value::real(on ? 0.5 * tool->diameter_mm : 0.0);
  if (name == "$P_TOOLL") {
    const std::optional<int> length = whole_index(asked.indices, 0);
    if (!length || *length < 1 || *length > 3) bad_index(asked, "$P_TOOLL[1] is the length of a mill");
    if (*length != 1) return Value::real(0.0);
  }
  return Value::real(on ? tool->length_mm : 0.0);
}

}  // namespace

Value Executor::read_system(const SystemName& asked) {
  const std::string& name = asked.name;
  const auto length = [&](double value) {
    check_metric(control, asked);
    return Value::real(value);
  };
  // The program runs on the machine: no search, no test, no simulation of the control.
  for (const char* mode : {"$P_SEARCH", "$P_ISTEST", "$P_SIM", "$P_DRYRUN", "$P_SEARCHL"}) {
    if (name == mode) return Value::boolean(false);
  }
  if (name == "$P_UIFR") {
    bool shifts = false;
    const int number = offset_index(asked, shifts);
    const int word = system_axis(control, asked, 1);
    const double value =
        offset_of(control, frames, number)[control.space.axis_of(static_cast<nc::AxisWord>(word))];
    return !shifts ? Value::real(0.0) : word < 3 ? length(value) : Value::real(deg_from_rad(value));
  }
  if (name == "$P_UIFRNUM") return Value::integer(control.offsets.active);
  if (name == "$P_EP" || name == "$AA_IW" || name == "$AA_IM") return position_of(control, frames, asked);
  return tool_data(control, asked);
}

/// $P_UIFR[n,X,TR]=: holds from the next G54 ... G599 on, as on the control.
void Executor::write_system(const SystemName& asked, const Value& value) {
  if (asked.name != "$P_UIFR") {
    refuse(asked.line, asked.offset, "unsupported-word",
           fmt::format("writing the system variable {} is not supported", asked.name),
           "work offsets can be written: $P_UIFR[1,X,TR]=10");
  }
  bool shifts = false;
  if (asked.indices.size() == 1) {  // every axis: CTRANS names those that are not zero
    SystemName one = asked;
    for (int word = 0; word < nc::kAxisWords; ++word) {
      if (control.space.axis_of(static_cast<nc::AxisWord>(word)) < 0) continue;
      one.indices = {asked.indices[0], Value::string(std::string(1, nc::kAxisLetters[word])),
                     Value::string("TR")};
      write_system(one, value);
    }
    return;
  }
  const int number = offset_index(asked, shifts);
  const int word = system_axis(control, asked, 1);
  const double amount = converted(value, Type::kReal, asked.line, asked.offset).number;
  if (!shifts) {
    if (amount == 0.0) return;
    refuse(asked.line, asked.offset, "unsupported-word", "work offsets that turn are not supported",
           "shift with TR, rotate with AROT");
  }
  if (word < 3) check_metric(control, asked);
  kinematics::AxisValues origin = offset_of(control, frames, number);
  origin[control.space.axis_of(static_cast<nc::AxisWord>(word))] = word < 3 ? amount : rad_from_deg(amount);
  frames.pending_offsets[number] = origin;
}

/// G54 ... G599, G500: what was written to the offset holds now.
void use_offset(nc::Control& control, Frames& frames, int number) {
  const auto pending = frames.pending_offsets.find(number);
  if (pending != frames.pending_offsets.end()) {
    nc::set_offset_origin(control, number, pending->second);
    frames.pending_offsets.erase(pending);
  }
  nc::set_work_offset(control, number);
}

}  // namespace swarf::program::nc::siemens
