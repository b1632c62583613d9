// Data of the control that programs set: G10, G52, G92, and the tool offsets behind H and D.
#include <fmt/format.h>

#include <cmath>

#include "program/fanuc/steps.h"

namespace swarf::program::nc::fanuc {
namespace {

/// Memory C: L10 length, L11 its wear, L12 radius, L13 its wear; G91 adds. They act with the next H or D.
void set_tool_offset(Modes& modes, Zero& zero, LetterDialect& letters, const Rules& rules, int kind) {
  letters.need('P', "G10 with a tool offset");
  letters.need('R', "G10 with a tool offset");
  const int number = whole(letters.block, 'P', 1, 999, letters.reader, letters.control);
  const auto slot = static_cast<size_t>(kind - 10);
  const double before =
      modes.incremental ? tool_offset(zero, letters, number, slot, letters.column('P')) : 0.0;
  const bool diameter = slot >= 2 && rules.offset_diameters;
  if (slot >= 2)
    letters.control.report.warn_once(diameter ? "offset-as-diameter" : "offset-as-radius",
                                     letters.column('R'),
                                     fmt::format("G10 L12 and L13 are read as {}, {}",
                                                 diameter ? "diameters" : "radii", rules.offset_rule),
                                     diameter ? "write twice of it where the machine keeps radii"
                                              : "write half of it where the machine keeps diameters");
  const double amount = letters.control.modal.mm(letters.block.get('R'));
  zero.offsets[number][slot] = before + (diameter ? 0.5 * amount : amount);
}

}  // namespace

using kinematics::AxisValues;

void set_data(Modes& modes, Zero& zero, LetterDialect& letters, const Rules& rules) {
  letters.need('L', "G10");
  const int kind = whole(letters.block, 'L', 0, 100, letters.reader, letters.control);
  if (kind == 1 || (kind >= 10 && kind <= 13))
    return set_tool_offset(modes, zero, letters, rules, kind == 1 ? 11 : kind);
  if (kind != 2 && kind != 20)
    letters.control.report.fail(
        "unsupported-word", letters.column('L'),
        kind == 3 ? "G10 L3 registers tool life groups, which are not simulated"
                  : fmt::format("G10 L{} changes data of the control", kind),
        kind == 3 ? "call the tool itself" : "G10 L2 and L20 set work offsets, L10 to L13 tool offsets");
  letters.need('P', "G10");
  const int p =
      whole(letters.block, 'P', 1, kind == 2 ? 6 : rules.further_offsets, letters.reader, letters.control);
  const int number = kind == 2 ? p : 100 + p;
  only_words(letters, "XYZABCP", "G10 L2 and L20");
  const Target values = target_of(letters.block, false, letters.reader, letters.control);
  AxisValues origin = nc::offset_origin(letters.control.space, letters.control.offsets, number);
  for (int word = 0; word < kAxisWords; ++word) {
    if (!values.has(word)) continue;
    const int axis = nc::require_axis(letters.control, static_cast<AxisWord>(word), values.column);
    const double value = values.value[static_cast<size_t>(word)];
    origin[axis] = modes.incremental ? origin[axis] + value : value;
  }
  nc::set_offset_origin(letters.control, number, origin);
}

/// Slots 0 to 3: length, its wear, radius, its wear. What G10 did not set stands in the tool table.
double tool_offset(Zero& zero, LetterDialect& letters, int number, size_t slot, int column) {
  const auto found = zero.offsets.find(number);
  if (found != zero.offsets.end() && found->second[slot]) return *found->second[slot];
  if (slot % 2 == 1) return 0.0;
  const int index = nc::find_tool(letters.control, number, column);
  if (index < 0) return 0.0;
  const NcTool& tool = letters.control.setup.tools[static_cast<size_t>(index)];
  return slot == 0 ? tool.length_mm : 0.5 * tool.diameter_mm;
}

/// Length of H, radius of D, mm: of the block, or as it was named before.
double tool_value(Modes& modes, Zero& zero, LetterDialect& letters, char letter, bool length) {
  const bool here = letters.block.has(letter);
  int& kept = length ? modes.h_number : modes.d_number;
  if (here) kept = whole(letters.block, letter, 0, 99999999, letters.reader, letters.control);
  if (kept == 0) return 0.0;
  const size_t slot = length ? 0 : 2;
  const int column = here ? letters.column(letter) : letters.reader.column_of(letters.block.first);
  return tool_offset(zero, letters, kept, slot, column) + tool_offset(zero, letters, kept, slot + 1, column);
}

/// G92: the present position reads as written. G52: the local shift is as written.
void shift_to_words(Fanuc& fanuc, bool position) {
  const Target values = target_of(fanuc.block, false, fanuc.reader, fanuc.control);
  if (fanuc.planes.turned.on || fanuc.modes.tcp != Tcp::kOff)
    fanuc.control.report.fail("modal-conflict", fanuc.g_column(kFanucOneShot),
                              "the work offset shifts while a turned frame or TCP is on",
                              "switch it off first: G69, G49");
  const std::array<double, kAxisWords> here = nc::position(fanuc.control);
  for (int word = 0; word < kAxisWords; ++word) {
    if (!values.has(word)) continue;
    const int axis = nc::require_axis(fanuc.control, static_cast<AxisWord>(word), values.column);
    const double value = values.value[static_cast<size_t>(word)], now = here[static_cast<size_t>(word)];
    if (position && !std::isfinite(now))
      fanuc.control.report.fail("start-unknown", values.column,
                                "G92 needs the position, which is not known yet",
                                "give the start position: start in [setup] of the scene, swarf check --home");
    if (position)
      fanuc.zero.shift[axis] += now - value;
    else
      fanuc.zero.local[axis] = value;
  }
  update_space(fanuc);
}

}  // namespace swarf::program::nc::fanuc
