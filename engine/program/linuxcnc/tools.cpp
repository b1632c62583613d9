// T, M6, M61, G41 to G43, and what G10 L1, L10 and L11 write over the tool table.
#include <fmt/format.h>

#include <cmath>

#include "program/linuxcnc/steps.h"

namespace swarf::program::nc::linuxcnc {
namespace {

int tool_word(LetterDialect& letters, char letter) {
  return whole(letters.block, letter, 0, 99999999, letters.reader, letters.control);
}

/// M61 Q gives the tool in the spindle its number; no tool moves. What a program has put there is known.
void declare_tool(LetterDialect& letters) {
  letters.need('Q', "M61");
  const int number = tool_word(letters, 'Q');
  if (number == letters.control.tools.active_number) return;
  if (letters.control.tools.active_number != 0)
    letters.control.report.fail(
        "tool-not-changed", letters.column('Q'),
        fmt::format("M61 Q{} renames the tool in the spindle, where this program has put T{}", number,
                    letters.control.tools.active_number),
        number == 0 ? "write T0 M6 to empty the spindle" : fmt::format("write T{} M6 to change it", number));
  nc::declare_tool(letters.control, nc::find_tool(letters.control, number, letters.column('Q')), number);
}

double length_of(Zero& zero, LetterDialect& letters, int number, int column) {
  const int wanted = number == 0 ? letters.control.tools.active_number : number;
  const auto written = zero.tool_data.find(wanted);
  if (written != zero.tool_data.end() && written->second.length_mm) return *written->second.length_mm;
  if (number == 0)
    return nc::active_tool(letters.control) == nullptr ? 0.0 : nc::active_tool(letters.control)->length_mm;
  const int index = nc::find_tool(letters.control, number, column);
  return index < 0 ? 0.0 : letters.control.setup.tools[static_cast<size_t>(index)].length_mm;
}

double touched_length(const Zero& zero, const LetterDialect& letters, int kind, double value) {
  if (!letters.control.path.started)
    letters.control.report.fail("start-unknown", letters.column('Z'),
                                "G10 measures the tool where it stands, which is not known yet",
                                "give the start position: start in [setup] of the scene, swarf check --home");
  if (letters.control.space.coordinates() != Coordinates::kAxes)
    letters.control.report.fail("tcp-active", letters.column('Z'),
                                "G10 L10 and L11 measure along Z of the machine, and TCP is on",
                                "switch it off first: M429");
  const double here = nc::position_xyz(letters.control).z(), length = letters.control.space.length();
  if (kind == 10) return length + here - value;
  constexpr int kFixture = 9;  // G59.3
  const int z = letters.control.space.axis_of(kZ);
  const double origin =
      nc::offset_origin(letters.control.space, letters.control.offsets, letters.control.offsets.active)[z] +
      (zero.shift_on ? zero.shift[z] : 0.0);
  return length + here + origin -
         nc::offset_origin(letters.control.space, letters.control.offsets, kFixture)[z] - value;
}

}  // namespace

void apply_tool(Modes& modes, Curves& curves, LetterDialect& letters) {
  if (letters.block.has('T')) {
    const int number = tool_word(letters, 'T');
    nc::select_tool(letters.control.tools,
                    number == 0 ? -1 : nc::find_tool(letters.control, number, letters.column('T')), number);
    modes.tool_called = true;
  }
  if (letters.block.has_m(610)) declare_tool(letters);
  const bool by_t = letters.control.setup.t_changes_tool && letters.block.has('T');
  if (!letters.block.has_m(60) && !by_t) return;
  curves.spline_tangent.reset();
  nc::change_tool(letters.control);
}

/// Number 0: the tool in the spindle, as machines without a random changer have it (D0, H0).
std::optional<double> diameter_of(Zero& zero, LetterDialect& letters, int number, int column) {
  const int wanted = number == 0 ? letters.control.tools.active_number : number;
  const auto written = zero.tool_data.find(wanted);
  if (written != zero.tool_data.end() && written->second.diameter_mm) return written->second.diameter_mm;
  if (nc::no_tool_table(letters.control, column)) return 0.0;
  const NcTool* tool = nc::active_tool(letters.control);
  if (number != 0) {
    const int index = nc::find_tool(letters.control, number, column);
    tool = index < 0 ? nullptr : &letters.control.setup.tools[static_cast<size_t>(index)];
  }
  return tool == nullptr ? std::nullopt : std::optional(tool->diameter_mm);
}

void apply_compensation(Modes& modes, Zero& zero, LetterDialect& letters) {
  if (!letters.block.has_g(kRadiusGroup)) return;
  const int code = letters.block.g[kRadiusGroup];
  const int at = letters.g_column(kRadiusGroup);
  modes.radius_code = code;
  if (code == G::kCompensationOff) return nc::set_compensation(letters.control, Compensation::kOff, 0.0, at);
  if (letters.control.modal.plane == Plane::kYZ)
    letters.control.report.fail("compensation-plane", at,
                                "LinuxCNC compensates the cutter's radius in G17 and G18 only",
                                "write the path of the cutter's centre");
  if (code == G::kCompensationLeftBy || code == G::kCompensationRightBy) {
    letters.need('D', "G41.1");
    modes.diameter_mm = letters.control.modal.mm(letters.block.get('D'));
  } else {
    const bool named = letters.block.has('D');
    const std::optional<double> diameter =
        diameter_of(zero, letters, named ? tool_word(letters, 'D') : 0, named ? letters.column('D') : at);
    if (!diameter)
      letters.control.report.fail("compensation-no-tool", at,
                                  "cutter compensation has no tool to take its radius from",
                                  "load a tool that the table knows, or write G41.1 D");
    modes.diameter_mm = *diameter;
  }
  const bool left = code == G::kCompensationLeft || code == G::kCompensationLeftBy;
  nc::set_compensation(letters.control,
                       left == (modes.diameter_mm >= 0.0) ? Compensation::kLeft : Compensation::kRight,
                       0.5 * std::abs(modes.diameter_mm), at);
}

void apply_length(Zero& zero, LetterDialect& letters) {
  if (!letters.block.has_g(kLengthGroup)) return;
  const int code = letters.block.g[kLengthGroup];
  if (code == G::kLengthOff) return nc::set_length_compensation(letters.control, 0.0, false);
  const bool by_axes = code == G::kLengthBy || (code == G::kLengthAdded && !letters.block.has('H'));
  double length = 0.0;
  if (code == G::kLengthAdded && by_axes && !is_axis_given(letters)) letters.need('H', "G43.2");
  if (by_axes) {
    if ((letters.block.given & kAxisBits) != 1u << ('Z' - 'A'))
      letters.control.report.fail(
          "unsupported-word", letters.g_column(kLengthGroup),
          "G43.1 and G43.2 are read with Z alone (a length along the tool), or G43.2 with H", "write Z");
    length = letters.control.modal.mm(letters.block.get('Z'));
  } else {
    length = length_of(zero, letters, letters.block.has('H') ? tool_word(letters, 'H') : 0,
                       letters.block.has('H') ? letters.column('H') : letters.g_column(kLengthGroup));
  }
  if (code == G::kLengthAdded) length += letters.control.space.length();
  nc::set_length_compensation(letters.control, length, true);
}

/// G10 L1: the words are the values. L10, L11: the length with which the present position would read as
/// written, in the offsets that hold, or in G59.3 without G52 and G92. Only a later G43 or G41 reads them.
void set_tool_data(Zero& zero, LetterDialect& letters, int kind) {
  const int number = tool_word(letters, 'P');
  if (letters.control.contour.side() != Compensation::kOff)
    letters.control.report.fail("compensation-active", letters.column('L'),
                                "the tool table changes while cutter radius compensation is on",
                                "switch it off first: G40");
  if (number == 0)
    letters.control.report.fail("out-of-range", letters.column('P'), "P0 is no tool of the table",
                                "write the number of the tool");
  nc::find_tool(letters.control, number, letters.column('P'));
  for (const char letter : {'X', 'Y', 'A', 'B', 'C'}) {
    if (letters.block.has(letter))
      letters.control.report.fail(
          "unsupported-word", letters.column(letter),
          fmt::format("a tool offset along {}: tools have a length along Z here", letter),
          "write Z and R alone");
  }
  if (letters.block.has('I') || letters.block.has('J') || letters.block.has('Q'))
    letters.control.report.without_effect("G10 I J Q (angles and orientation of turning tools)");
  ToolData& data = zero.tool_data[number];
  if (letters.block.has('R')) data.diameter_mm = 2.0 * letters.control.modal.mm(letters.block.get('R'));
  if (!letters.block.has('Z')) return;
  const double value = letters.control.modal.mm(letters.block.get('Z'));
  data.length_mm = kind == 1 ? value : touched_length(zero, letters, kind, value);
}

}  // namespace swarf::program::nc::linuxcnc
