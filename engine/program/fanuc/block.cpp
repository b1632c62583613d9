// Third and fourth step: rules of a block's words, then modal words in the control's order.
#include <fmt/format.h>

#include <cmath>

#include "base/units.h"
#include "program/fanuc/reader.h"

namespace swarf::program::nc::fanuc {

void Fanuc::check_words() {
  const int one_shot = g(kFanucOneShot);
  if (one_shot == 650 || g(kFanucMacro) == 660) return;  // every letter is an argument
  for (const char letter : {'U', 'V', 'W', 'E'}) {
    if (block_.has(letter))
      control_.report.fail(letter == 'E' ? "unknown-word" : "axis-missing", column(letter),
                           fmt::format("the machine {} has no axis {}", control_.setup.machine.name, letter),
                           "take the word out, or choose the machine that the program was posted for");
  }
  const int motion = g(kFanucMotion) >= 0 ? g(kFanucMotion) : motion_;
  const int cycle = g(kFanucCycle) >= 0 ? g(kFanucCycle) : g(kFanucMotion) >= 0 ? 800 : cycle_;
  const bool in_cycle = cycle != 800, arc = !in_cycle && (motion == 20 || motion == 30),
             turn = (g(kFanucTurn) >= 680 && g(kFanucTurn) != 690) || g(kFanucScale) == 510;
  const bool tilts = one_shot == 531 || one_shot == 536;
  const bool vectors = (tcp_ == Tcp::kVector || g(kFanucLength) == 435) && !arc;
  const bool calls = block_.has_m(980) || block_.has_m(1980), ends = calls || block_.has_m(990);
  const bool bore = cycle == 760 || cycle == 870;
  for (const char letter : {'I', 'J', 'K'})
    check_letter(letter, arc || turn || vectors || motion == 62 || (letter == 'K' ? in_cycle : bore),
                 "G2, G3, G43.5, G51, G68.2");
  check_letter('R', arc || in_cycle || turn || tilts || motion == 62 || one_shot == 100 || block_.free_g > 0,
               "arcs, cycles, G68 and G06.2");
  check_letter('Q', in_cycle || turn || block_.free_g > 0, "pecking cycles and G68.2");
  check_letter('P',
               in_cycle || one_shot == 40 || one_shot == 100 || one_shot == 300 || motion == 62 || ends ||
                   g(kFanucOffset) == 541 || turn || tilts || block_.free_g > 0,
               "G04, G10, M98 and cycles");
  check_letter('L', in_cycle || one_shot == 100 || calls, "G10, M98 and cycles");
  check_letter('D', g(kFanucRadius) > 400, "G41 and G42");
  check_letter('H', (g(kFanucLength) > 400 && g(kFanucLength) != 490) || one_shot == 536, "G43 and G53.6");
  if (g(kFanucCycle) > 800 && g(kFanucMotion) >= 0)
    control_.report.fail("two-motion-words", g_column(kFanucMotion),
                         "a motion and a cycle stand in one block", "write them in two blocks");
  check_feed_and_speed();
  if (one_shot == 40 && !block_.has('P') && !block_.has('X'))
    control_.report.fail("missing-word", g_column(kFanucOneShot), "G04 has no time", "add P (ms) or X (s)");
}

void Fanuc::apply() {
  if (g(kFanucOneShot) == 650) return call_macro();
  if (g(kFanucMacro) == 660) return set_modal_macro();
  apply_machine();
  apply_modes();
  keep_motion_codes();
  if (block_.has_g(kFanucMacro)) set_modal_macro();
  if (block_.has_g(kFanucPolar)) polar(block_.g[kFanucPolar]);
  if (block_.has_g(kFanucScale)) scale(block_.g[kFanucScale]);
  if (block_.has_g(kFanucMirror)) mirror(block_.g[kFanucMirror]);
  const bool axes_given = (block_.given & kAxisBits) != 0;
  if (g(kFanucScale) == 510 || (block_.has_g(kFanucMirror) && axes_given)) return;  // words of the centre
  if (block_.has_g(kFanucTurn)) {
    const bool tilted = turned_.in_work;
    turn(block_.g[kFanucTurn]);
    if (block_.g[kFanucTurn] != 690 || !axes_given) return;
    if (tilted)
      control_.report.fail("unexpected-word", g_column(kFanucTurn),
                           "a move stands with G69 of a tilted plane", "write G69 in a block of its own");
  }
  if (block_.has_g(kFanucOneShot) && block_.g[kFanucOneShot] != 90 && block_.g[kFanucOneShot] != 530)
    return one_shot();
  if (g(kFanucOneShot) == 90) control_.modal.exact_stop_once = true;
  motion();
}

/// The manual lists F among the values whose unit G20 and G21 change, and not what becomes of the one that
/// holds: it is forgotten, so that the next feed wants its own.
void Fanuc::set_units(bool inches) {
  if (inches != control_.modal.inches()) nc::restore_feed(control_.modal, control_.modal.feed_mode, 0.0);
  nc::set_inches(control_.modal, inches);
}

void Fanuc::apply_machine() {
  if (block_.has_g(kFanucUnits)) set_units(block_.g[kFanucUnits] == 200);
  if (block_.has_g(kFanucFeed)) {
    const int code = block_.g[kFanucFeed];
    nc::set_feed_mode(control_.modal, code == 930   ? FeedMode::kInverseTime
                                      : code == 940 ? FeedMode::kPerMinute
                                                    : FeedMode::kPerRevolution);
  }
  if (block_.has('F')) nc::set_feed(control_.report, control_.modal, block_.get('F'), column('F'));
  if (block_.has('S')) control_.modal.speed_rpm = block_.get('S');
  if (block_.has('T')) {
    const int number = whole(block_, 'T', 0, 99999999, reader_, control_);
    nc::select_tool(control_.tools, number == 0 ? -1 : nc::find_tool(control_, number, column('T')), number);
  }
  if (block_.has_m(60)) nc::change_tool(control_);
  for (int i = 0; i < block_.m_count; ++i) {
    const int code = block_.m[static_cast<size_t>(i)];
    if (code == 30 || code == 40 || code == 50) control_.modal.spindle = code == 30 ? 1 : code == 40 ? -1 : 0;
  }
}

void Fanuc::apply_modes() {
  if (block_.g_given == 0) return;
  if (block_.has_g(kFanucPlane))
    nc::set_plane(control_, block_.g[kFanucPlane] == 170   ? Plane::kXY
                            : block_.g[kFanucPlane] == 180 ? Plane::kZX
                                                           : Plane::kYZ);
  if (block_.has_g(kFanucDistance)) incremental_ = block_.g[kFanucDistance] == 910;
  if (block_.has_g(kFanucRetract)) retract_to_r_ = block_.g[kFanucRetract] == 990;
  if (block_.has_g(kFanucPath))
    control_.modal.exact_stop = block_.g[kFanucPath] == 610 || block_.g[kFanucPath] == 611;
  if (block_.has_g(kFanucRadius)) apply_radius();
  if (block_.has_g(kFanucOffset)) {
    const int code = block_.g[kFanucOffset];
    refuse_mapped(g_column(kFanucOffset), "the work offset changes", false);
    if (code == 541) need('P', "G54.1");
    nc::set_work_offset(
        control_, code == 541 ? 100 + whole(block_, 'P', 1, 300, reader_, control_) : (code - 530) / 10);
    update_space();
  }
  if (block_.has_g(kFanucLength)) apply_length();
}

void Fanuc::apply_radius() {
  const int code = block_.g[kFanucRadius], at = g_column(kFanucRadius);
  if (code == 400) return nc::set_compensation(control_, Compensation::kOff, 0.0, at);
  if (!block_.has('D') && nc::active_tool(control_) == nullptr)
    control_.report.fail("compensation-no-tool", at, "cutter compensation has no D word and no tool",
                         "add D with the tool's number");
  const double radius =
      block_.has('D') ? tool_value('D', false) : 0.5 * nc::active_tool(control_)->diameter_mm;
  const bool left = (code == 410) != (mapped() && reversed());
  nc::set_compensation(control_, left ? Compensation::kLeft : Compensation::kRight, radius, at);
}

void Fanuc::apply_length() {
  const int code = block_.g[kFanucLength];
  if (code >= 434 && code <= 435) refuse_mapped(g_column(kFanucLength), "TCP is switched on", true);
  length_code_ = code;
  if (code == 490) {
    tcp_ = Tcp::kOff;
    nc::set_length_compensation(control_, 0.0, false);
    return update_space();
  }
  if (!block_.has('H') && nc::active_tool(control_) == nullptr && !control_.setup.tools.empty())
    control_.report.fail("missing-word", g_column(kFanucLength),
                         "the length compensation has no H word and no tool", "add H with the tool's number");
  const NcTool* tool = nc::active_tool(control_);
  const double length = block_.has('H') ? tool_value('H', true) : tool != nullptr ? tool->length_mm : 0.0;
  nc::set_length_compensation(control_, code == 440 ? -length : length, true);
  tcp_ = code == 434 ? Tcp::kAxes : code == 435 ? Tcp::kVector : Tcp::kOff;
  update_space();
}

/// TCP, tilted plane and shifts as the control understands them: the frame of G68 or G68.2 stands in the work
/// offset with its shifts (30i: G52 and G92 move the workpiece coordinate system).
void Fanuc::update_space() {
  nc::set_shift(control_, shift_ + local_);
  nc::set_tcp(control_, tcp_);
  if (tcp_ == Tcp::kOff && turned_.on && turned_.in_work) nc::set_coordinates(control_, Coordinates::kWork);
  nc::set_frame(control_, turned_.on ? turned_.frame : Pose::Identity());
}

}  // namespace swarf::program::nc::fanuc
