// Data of the control that programs set: G10, G52, G92, and the tool offsets behind H and D.
#include <fmt/format.h>

#include <cmath>

#include "program/fanuc/reader.h"

namespace swarf::program::nc::fanuc {

using kinematics::AxisValues;

void Fanuc::set_data() {
  need('L', "G10");
  const int kind = whole(block_, 'L', 0, 100, reader_, control_);
  if (kind == 1 || (kind >= 10 && kind <= 13)) return set_tool_offset(kind == 1 ? 11 : kind);
  if (kind != 2 && kind != 20)
    control_.report.fail(
        "unsupported-word", column('L'),
        kind == 3 ? "G10 L3 registers tool life groups, which are not simulated"
                  : fmt::format("G10 L{} changes data of the control", kind),
        kind == 3 ? "call the tool itself" : "G10 L2 and L20 set work offsets, L10 to L13 tool offsets");
  need('P', "G10");
  const int p = whole(block_, 'P', 1, kind == 2 ? 6 : 300, reader_, control_);
  const int number = kind == 2 ? p : 100 + p;
  only_words("XYZABCP", "G10 L2 and L20");
  const Target values = target_of(block_, false, reader_, control_);
  AxisValues origin = nc::offset_origin(control_.space, control_.offsets, number);
  for (int word = 0; word < kAxisWords; ++word) {
    if (!values.has(word)) continue;
    const int axis = nc::require_axis(control_, static_cast<AxisWord>(word), values.column);
    const double value = values.value[static_cast<size_t>(word)];
    origin[axis] = incremental_ ? origin[axis] + value : value;
  }
  nc::set_offset_origin(control_, number, origin);
}

/// Memory C: L10 length, L11 its wear, L12 radius, L13 its wear; G91 adds. They act with the next H or D.
void Fanuc::set_tool_offset(int kind) {
  need('P', "G10 with a tool offset");
  need('R', "G10 with a tool offset");
  const int number = whole(block_, 'P', 1, 999, reader_, control_);
  const auto slot = static_cast<size_t>(kind - 10);
  const double before = incremental_ ? tool_offset(number, slot, column('P')) : 0.0;
  if (slot >= 2)
    control_.report.warn_once("offset-as-radius", column('R'),
                              "G10 L12 and L13 are read as radii, as machines are delivered (parameter 5004)",
                              "write half of it where the machine keeps diameters");
  offsets_[number][slot] = before + control_.modal.mm(block_.get('R'));
}

/// Slots 0 to 3: length, its wear, radius, its wear. What G10 did not set stands in the tool table.
double Fanuc::tool_offset(int number, size_t slot, int column) {
  const auto found = offsets_.find(number);
  if (found != offsets_.end() && found->second[slot]) return *found->second[slot];
  if (slot % 2 == 1) return 0.0;
  const int index = nc::find_tool(control_, number, column);
  if (index < 0) return 0.0;
  const NcTool& tool = control_.setup.tools[static_cast<size_t>(index)];
  return slot == 0 ? tool.length_mm : 0.5 * tool.diameter_mm;
}

/// Length of H, radius of D, mm.
double Fanuc::tool_value(char letter, bool length) {
  const int number = whole(block_, letter, 0, 99999999, reader_, control_);
  (length ? h_number_ : d_number_) = number;
  if (number == 0) return 0.0;
  const size_t slot = length ? 0 : 2;
  return tool_offset(number, slot, column(letter)) + tool_offset(number, slot + 1, column(letter));
}

/// G92: the present position reads as written. G52: the local shift is as written.
void Fanuc::shift_to_words(bool position) {
  const Target values = target_of(block_, false, reader_, control_);
  if (turned_.on || tcp_ != Tcp::kOff)
    control_.report.fail("modal-conflict", g_column(kFanucOneShot),
                         "the work offset shifts while a turned frame or TCP is on",
                         "switch it off first: G69, G49");
  const std::array<double, kAxisWords> here = nc::position(control_);
  for (int word = 0; word < kAxisWords; ++word) {
    if (!values.has(word)) continue;
    const int axis = nc::require_axis(control_, static_cast<AxisWord>(word), values.column);
    const double value = values.value[static_cast<size_t>(word)], now = here[static_cast<size_t>(word)];
    if (position && !std::isfinite(now))
      control_.report.fail("start-unknown", values.column, "G92 needs the position, which is not known yet",
                           "give the start position in the scene");
    if (position)
      shift_[axis] += now - value;
    else
      local_[axis] = value;
  }
  update_space();
}

}  // namespace swarf::program::nc::fanuc
