// T, M6, M61, G41 to G43, and what G10 L1, L10 and L11 write over the tool table.
#include <fmt/format.h>

#include <cmath>

#include "program/linuxcnc/reader.h"

namespace swarf::program::nc::linuxcnc {

int LinuxCnc::tool_word(char letter) {
  return whole(block_, letter, 0, 99999999, reader_, control_);
}

void LinuxCnc::apply_tool() {
  if (block_.has('T')) {
    const int number = tool_word('T');
    nc::select_tool(control_.tools, number == 0 ? -1 : nc::find_tool(control_, number, column('T')), number);
    tool_called_ = true;
  }
  if (block_.has_m(610)) declare_tool();
  if (!block_.has_m(60)) return;
  spline_tangent_.reset();
  nc::change_tool(control_);
}

/// M61 Q gives the tool in the spindle its number; no tool moves. What a program has put there is known.
void LinuxCnc::declare_tool() {
  need('Q', "M61");
  const int number = tool_word('Q');
  if (number == control_.tools.active_number) return;
  if (control_.tools.active_number != 0)
    control_.report.fail(
        "tool-not-changed", column('Q'),
        fmt::format("M61 Q{} renames the tool in the spindle, where this program has put T{}", number,
                    control_.tools.active_number),
        number == 0 ? "write T0 M6 to empty the spindle" : fmt::format("write T{} M6 to change it", number));
  nc::declare_tool(control_, nc::find_tool(control_, number, column('Q')), number);
}

/// Number 0: the tool in the spindle, as machines without a random changer have it (D0, H0).
std::optional<double> LinuxCnc::diameter_of(int number, int column) {
  const int wanted = number == 0 ? control_.tools.active_number : number;
  const auto written = tool_data_.find(wanted);
  if (written != tool_data_.end() && written->second.diameter_mm) return written->second.diameter_mm;
  const NcTool* tool = nc::active_tool(control_);
  if (number != 0) {
    const int index = nc::find_tool(control_, number, column);
    tool = index < 0 ? nullptr : &control_.setup.tools[static_cast<size_t>(index)];
  }
  return tool == nullptr ? std::nullopt : std::optional(tool->diameter_mm);
}

double LinuxCnc::length_of(int number, int column) {
  const int wanted = number == 0 ? control_.tools.active_number : number;
  const auto written = tool_data_.find(wanted);
  if (written != tool_data_.end() && written->second.length_mm) return *written->second.length_mm;
  if (number == 0) return nc::active_tool(control_) == nullptr ? 0.0 : nc::active_tool(control_)->length_mm;
  const int index = nc::find_tool(control_, number, column);
  return index < 0 ? 0.0 : control_.setup.tools[static_cast<size_t>(index)].length_mm;
}

void LinuxCnc::apply_compensation() {
  if (!block_.has_g(kRadiusGroup)) return;
  const int code = block_.g[kRadiusGroup];
  const int at = g_column(kRadiusGroup);
  radius_code_ = code;
  if (code == 400) return nc::set_compensation(control_, Compensation::kOff, 0.0, at);
  if (control_.modal.plane == Plane::kYZ)
    control_.report.fail("compensation-plane", at,
                         "LinuxCNC compensates the cutter's radius in G17 and G18 only",
                         "write the path of the cutter's centre");
  if (code == 411 || code == 421) {
    need('D', "G41.1");
    diameter_mm_ = control_.modal.mm(block_.get('D'));
  } else {
    const bool named = block_.has('D');
    const std::optional<double> diameter = diameter_of(named ? tool_word('D') : 0, named ? column('D') : at);
    if (!diameter)
      control_.report.fail("compensation-no-tool", at,
                           "cutter compensation has no tool to take its radius from",
                           "load a tool that the table knows, or write G41.1 D");
    diameter_mm_ = *diameter;
  }
  const bool left = code == 410 || code == 411;
  nc::set_compensation(control_, left == (diameter_mm_ >= 0.0) ? Compensation::kLeft : Compensation::kRight,
                       0.5 * std::abs(diameter_mm_), at);
}

void LinuxCnc::apply_length() {
  if (!block_.has_g(kLengthGroup)) return;
  const int code = block_.g[kLengthGroup];
  if (code == 490) return nc::set_length_compensation(control_, 0.0, false);
  const bool by_axes = code == 431 || (code == 432 && !block_.has('H'));
  double length = 0.0;
  if (code == 432 && by_axes && !is_axis_given()) need('H', "G43.2");
  if (by_axes) {
    if ((block_.given & kAxisBits) != 1u << ('Z' - 'A'))
      control_.report.fail("unsupported-word", g_column(kLengthGroup),
                           "G43.1 and G43.2 are read with Z alone (a length along the tool), or G43.2 with H",
                           "write Z");
    length = control_.modal.mm(block_.get('Z'));
  } else {
    length = length_of(block_.has('H') ? tool_word('H') : 0,
                       block_.has('H') ? column('H') : g_column(kLengthGroup));
  }
  if (code == 432) length += control_.space.length();
  nc::set_length_compensation(control_, length, true);
}

/// G10 L1: the words are the values. L10, L11: the length with which the present position would read as
/// written, in the offsets that hold, or in G59.3 without G52 and G92. Only a later G43 or G41 reads them.
void LinuxCnc::set_tool_data(int kind) {
  const int number = tool_word('P');
  if (control_.contour.side() != Compensation::kOff)
    control_.report.fail("compensation-active", column('L'),
                         "the tool table changes while cutter radius compensation is on",
                         "switch it off first: G40");
  if (number == 0)
    control_.report.fail("out-of-range", column('P'), "P0 is no tool of the table",
                         "write the number of the tool");
  nc::find_tool(control_, number, column('P'));
  for (const char letter : {'X', 'Y', 'A', 'B', 'C'}) {
    if (block_.has(letter))
      control_.report.fail("unsupported-word", column(letter),
                           fmt::format("a tool offset along {}: tools have a length along Z here", letter),
                           "write Z and R alone");
  }
  if (block_.has('I') || block_.has('J') || block_.has('Q'))
    control_.report.without_effect("G10 I J Q (angles and orientation of turning tools)");
  ToolData& data = tool_data_[number];
  if (block_.has('R')) data.diameter_mm = 2.0 * control_.modal.mm(block_.get('R'));
  if (!block_.has('Z')) return;
  const double value = control_.modal.mm(block_.get('Z'));
  data.length_mm = kind == 1 ? value : touched_length(kind, value);
}

double LinuxCnc::touched_length(int kind, double value) const {
  if (!control_.path.started)
    control_.report.fail("start-unknown", column('Z'),
                         "G10 measures the tool where it stands, which is not known yet",
                         "give the start position in the scene");
  if (control_.space.coordinates() != Coordinates::kAxes)
    control_.report.fail("tcp-active", column('Z'),
                         "G10 L10 and L11 measure along Z of the machine, and TCP is on",
                         "switch it off first: M429");
  const double here = nc::position_xyz(control_).z(), length = control_.space.length();
  if (kind == 10) return length + here - value;
  constexpr int kFixture = 9;  // G59.3
  const int z = control_.space.axis_of(kZ);
  const double zero = nc::offset_origin(control_.space, control_.offsets, control_.offsets.active)[z] +
                      (shift_on_ ? shift_[z] : 0.0);
  return length + here + zero - nc::offset_origin(control_.space, control_.offsets, kFixture)[z] - value;
}

}  // namespace swarf::program::nc::linuxcnc
