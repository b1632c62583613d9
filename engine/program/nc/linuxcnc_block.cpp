// Third and fourth step: the rules of a block's words, then what they do, in the control's order.
#include <fmt/format.h>

#include <cmath>

#include "base/units.h"
#include "program/nc/linuxcnc.h"

namespace swarf::program::nc {
namespace {

bool is_cycle(int tenths) {
  return tenths == 730 || tenths == 740 || (tenths >= 810 && tenths <= 890);
}
bool is_arc(int tenths) {
  return tenths == 20 || tenths == 30;
}

}  // namespace

bool LinuxCnc::uses_axis_words() const {
  if (!block_.has_g(kNonModal)) return block_.has_g(kLengthGroup) && block_.g[kLengthGroup] == 431;
  const int code = block_.g[kNonModal];
  return code == 100 || code == 280 || code == 300 || code == 520 || code == 920;
}

void LinuxCnc::check_words() {
  for (const char letter : {'U', 'V', 'W'}) {
    if (block_.has(letter))
      control_.fail("axis-missing", column(letter),
                    fmt::format("the machine {} has no axis {}", control_.machine().name, letter),
                    "take the word out, or choose the machine that the program was posted for");
  }
  constexpr uint32_t kRare = (1u << ('D' - 'A')) | (1u << ('H' - 'A')) | (7u << ('I' - 'A')) |
                             (1u << ('L' - 'A')) | (1u << ('P' - 'A')) | (1u << ('Q' - 'A')) |
                             (1u << ('R' - 'A'));
  const int non_modal = block_.has_g(kNonModal) ? block_.g[kNonModal] : -1;
  const int motion = block_.has_g(kMotionGroup) ? block_.g[kMotionGroup] : uses_axis_words() ? -1 : motion_;
  if ((block_.given & kRare) != 0) {
    const bool cycle = is_cycle(motion), arc = is_arc(motion), data = non_modal == 100;
    const bool radius = block_.has_g(kRadiusGroup) && block_.g[kRadiusGroup] != 400;
    const bool path = block_.has_g(kPathGroup) && block_.g[kPathGroup] == 640;
    check_letter('D', radius, "G41 and G42");
    check_letter(
        'H', block_.has_g(kLengthGroup) && (block_.g[kLengthGroup] == 430 || block_.g[kLengthGroup] == 432),
        "G43 and G43.2");
    for (const char letter : {'I', 'J', 'K'}) check_letter(letter, arc, "G2 and G3");
    check_letter('R', cycle || arc || data, "arcs, cycles and G10 L2");
    check_letter('P', cycle || arc || data || non_modal == 40 || path || block_.m_count > 0,
                 "G4, G10, G64, arcs and cycles");
    check_letter('Q', cycle || path || block_.m_count > 0, "G64 and pecking cycles");
    check_letter('L', cycle || data || block_.has_m(980), "G10, cycles and M98");
  }
  check_axes_and_motion();
  if (non_modal == 40) need('P', "G4");
  check_feed_and_speed();
}

void LinuxCnc::check_axes_and_motion() {
  const bool uses = uses_axis_words();
  if (uses && block_.has_g(kMotionGroup) && block_.g[kMotionGroup] != 800)
    control_.fail("modal-conflict", g_column(kMotionGroup),
                  "two G codes of this block both want its axis words", "write them in two blocks");
  if (block_.has_g(kMachineGroup)) {
    const int motion = block_.has_g(kMotionGroup) ? block_.g[kMotionGroup] : motion_;
    if (motion != 0 && motion != 10)
      control_.fail("modal-conflict", g_column(kMachineGroup), "G53 goes with G0 and G1 only",
                    "write G53 G0");
    if (!is_axis_given())
      control_.fail("missing-word", g_column(kMachineGroup), "G53 has no axis words",
                    "add the axes that move");
  }
  if (!is_axis_given() || uses) return;
  const int motion = block_.has_g(kMotionGroup) ? block_.g[kMotionGroup] : motion_;
  if (motion < 0 || motion == 800)
    control_.fail("no-motion-mode", reader_.column_of(block_.first),
                  "axis words stand here, and no motion (G0 to G3) is active", "write G0 or G1");
}

void LinuxCnc::apply() {
  apply_feed_and_speed();
  if ((block_.given & (1u << ('T' - 'A'))) != 0 || block_.m_count > 0) {
    apply_tool();
    apply_spindle();
  }
  constexpr uint32_t kModal = 1u << kPlaneGroup | 1u << kUnitsGroup | 1u << kRadiusGroup |
                              1u << kLengthGroup | 1u << kOffsetGroup | 1u << kPathGroup |
                              1u << kDistanceGroup | 1u << kArcDistanceGroup | 1u << kRetractGroup;
  if (block_.has_g(kNonModal) && block_.g[kNonModal] == 40) control_.dwell(block_.get('P'));
  if ((block_.g_given & kModal) != 0) {
    if (block_.has_g(kPlaneGroup))
      control_.set_plane(block_.g[kPlaneGroup] == 170   ? Plane::kXY
                         : block_.g[kPlaneGroup] == 180 ? Plane::kZX
                                                        : Plane::kYZ);
    if (block_.has_g(kUnitsGroup)) control_.set_inches(block_.g[kUnitsGroup] == 200);
    apply_compensation();
    apply_offsets();
    apply_path_mode();
    if (block_.has_g(kDistanceGroup)) incremental_ = block_.g[kDistanceGroup] == 910;
    if (block_.has_g(kArcDistanceGroup)) arc_absolute_ = block_.g[kArcDistanceGroup] == 901;
    if (block_.has_g(kRetractGroup)) retract_to_r_ = block_.g[kRetractGroup] == 990;
  }
  if (block_.has_g(kNonModal)) non_modal();
  if (block_.has_g(kMotionGroup) || (is_axis_given() && !uses_axis_words())) motion();
}

void LinuxCnc::apply_feed_and_speed() {
  if (block_.has_g(kFeedGroup)) {
    const int code = block_.g[kFeedGroup];
    control_.set_feed_mode(code == 930   ? FeedMode::kInverseTime
                           : code == 940 ? FeedMode::kPerMinute
                                         : FeedMode::kPerRevolution);
  }
  // F counts in the units of its own block.
  if (block_.has_g(kUnitsGroup)) control_.set_inches(block_.g[kUnitsGroup] == 200);
  if (block_.has('F')) control_.set_feed(block_.get('F'), column('F'));
  if (block_.has('S')) control_.set_speed(block_.get('S'));
}

void LinuxCnc::apply_tool() {
  if (block_.has('T')) {
    const int number = whole(block_, 'T', 0, 99999999, reader_, control_);
    control_.select_tool(number == 0 ? -1 : control_.find_tool(number, column('T')), number);
  }
  if (!block_.has_m(60)) return;
  control_.change_tool();
}

void LinuxCnc::apply_spindle() {
  for (int i = 0; i < block_.m_count; ++i) {
    const int code = block_.m[static_cast<size_t>(i)];
    if (code == 30) control_.set_spindle(1);
    if (code == 40) control_.set_spindle(-1);
    if (code == 50) control_.set_spindle(0);
    if (code == 4280 || code == 4290) set_kinematics(code);
  }
}

void LinuxCnc::set_kinematics(int tenths) {
  control_.set_tcp(tenths == 4280 ? Tcp::kAxes : Tcp::kOff);
}

void LinuxCnc::apply_compensation() {
  if (block_.has_g(kRadiusGroup)) {
    const int code = block_.g[kRadiusGroup];
    const int at = g_column(kRadiusGroup);
    if (code == 400) {
      control_.set_compensation(Compensation::kOff, 0.0, at);
    } else {
      double diameter = 0.0;
      if (code == 411 || code == 421) {
        need('D', "G41.1");
        diameter = control_.mm(block_.get('D'));
      } else if (block_.has('D') && block_.get('D') != 0.0) {
        const int index = control_.find_tool(whole(block_, 'D', 0, 99999999, reader_, control_), column('D'));
        if (index >= 0) diameter = control_.tool_at(index).diameter_mm;
      } else if (const NcTool* tool = control_.active_tool()) {
        diameter = tool->diameter_mm;
      } else {
        control_.fail("compensation-no-tool", at, "cutter compensation has no tool to take its radius from",
                      "load a tool that the table knows, or write G41.1 D");
      }
      const bool left = code == 410 || code == 411;
      control_.set_compensation(left == (diameter >= 0.0) ? Compensation::kLeft : Compensation::kRight,
                                0.5 * std::abs(diameter), at);
    }
  }
  if (!block_.has_g(kLengthGroup)) return;
  const int code = block_.g[kLengthGroup];
  if (code == 490) return control_.set_length_compensation(0.0, false);
  if (code == 431) {
    if ((block_.given & kAxisBits) != 1u << ('Z' - 'A'))
      control_.fail("unsupported-word", g_column(kLengthGroup),
                    "G43.1 is read with Z alone (a length along the tool)", "write G43.1 Z");
    return control_.set_length_compensation(control_.mm(block_.get('Z')), true);
  }
  double length = 0.0;
  if (block_.has('H') && block_.get('H') != 0.0) {
    const int index = control_.find_tool(whole(block_, 'H', 0, 99999999, reader_, control_), column('H'));
    if (index >= 0) length = control_.tool_at(index).length_mm;
  } else if (!block_.has('H') && control_.active_tool() != nullptr) {
    length = control_.active_tool()->length_mm;
  }
  if (code == 432) {
    need('H', "G43.2");
    length += control_.length_compensation();
  }
  control_.set_length_compensation(length, true);
}

void LinuxCnc::apply_offsets() {
  if (!block_.has_g(kOffsetGroup)) return;
  const int code = block_.g[kOffsetGroup];
  control_.set_work_offset(code <= 590 ? (code - 530) / 10 : code - 584);
  update_shift();
}

void LinuxCnc::apply_path_mode() {
  if (!block_.has_g(kPathGroup)) return;
  const int code = block_.g[kPathGroup];
  control_.set_exact_stop(code != 640);
  if (code == 640 && block_.has('Q')) control_.without_effect("G64 Q (merging of short blocks)");
  control_.set_corner_tolerance(code == 640 && block_.has('P') ? control_.mm(block_.get('P')) : 0.0);
}

bool LinuxCnc::apply_end() {
  for (int i = 0; i < block_.m_count; ++i) {
    const int code = block_.m[static_cast<size_t>(i)];
    const int at = reader_.column_of(block_.m_places[static_cast<size_t>(i)]);
    if (code == 20 || code == 300) return false;
    if (code == 980) {
      need('P', "M98");
      const long times = block_.has('L') ? whole(block_, 'L', 0, 1'000'000, reader_, control_) : 1;
      call_number(whole(block_, 'P', 0, 99999999, reader_, control_), times, at);
    }
    if (code == 990 && calls_.size() > 1 && frame().numbered) {
      leave();
    } else if (code == 990 && calls_.size() > 1) {
      control_.fail("bad-o-word", at, "M99 ends a subprogram that was called with O... call",
                    "end it with endsub");
    } else if (code == 990) {
      control_.warn_once("main-program-repeats", at, "M99 repeats the main program for ever; it was run once",
                         "end it with M2 where that is meant");
      return false;
    }
  }
  return true;
}

}  // namespace swarf::program::nc
