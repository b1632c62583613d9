// Third and fourth step: rules of a block's words, then modal words in the control's order.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "program/fanuc/steps.h"

namespace swarf::program::nc::fanuc {
namespace {

/// The manual lists F among the values whose unit G20 and G21 change, and not what becomes of the one that
/// holds: it is forgotten, so that the next feed wants its own.
void set_units(LetterDialect& letters, bool inches) {
  if (inches != letters.control.modal.inches())
    nc::restore_feed(letters.control.modal, letters.control.modal.feed_mode, 0.0);
  nc::set_inches(letters.control.modal, inches);
}

void apply_machine(LetterDialect& letters) {
  if (letters.block.has_g(kFanucUnits)) set_units(letters, letters.block.g[kFanucUnits] == 200);
  if (letters.block.has_g(kFanucFeed)) {
    const int code = letters.block.g[kFanucFeed];
    nc::set_feed_mode(letters.control.modal, code == G::kInverseTime ? FeedMode::kInverseTime
                                             : code == G::kPerMinute ? FeedMode::kPerMinute
                                                                     : FeedMode::kPerRevolution);
  }
  if (letters.block.has('F'))
    nc::set_feed(letters.control.report, letters.control.modal, letters.block.get('F'), letters.column('F'));
  if (letters.block.has('S')) letters.control.modal.speed_rpm = letters.block.get('S');
  if (letters.block.has('T')) {
    const int number = whole(letters.block, 'T', 0, 99999999, letters.reader, letters.control);
    nc::select_tool(letters.control.tools,
                    number == 0 ? -1 : nc::find_tool(letters.control, number, letters.column('T')), number);
  }
  if (letters.block.has_m(60) || (letters.control.setup.t_changes_tool && letters.block.has('T')))
    nc::change_tool(letters.control);
  for (int i = 0; i < letters.block.m_count; ++i) {
    const int code = letters.block.m[static_cast<size_t>(i)];
    if (code == M::kSpindleClockwise || code == M::kSpindleCounterClockwise || code == M::kSpindleStop)
      letters.control.modal.spindle = code == M::kSpindleClockwise          ? 1
                                      : code == M::kSpindleCounterClockwise ? -1
                                                                            : 0;
  }
}

void apply_radius(Fanuc& fanuc) {
  const int code = fanuc.block.g[kFanucRadius], at = fanuc.g_column(kFanucRadius);
  if (code == G::kCompensationOff) return nc::set_compensation(fanuc.control, Compensation::kOff, 0.0, at);
  const bool named = fanuc.block.has('D') || fanuc.modes.d_kept;
  if (!named && nc::active_tool(fanuc.control) == nullptr)
    fanuc.control.report.fail("compensation-no-tool", at, "cutter compensation has no D word and no tool",
                              "add D with the tool's number");
  const double radius = named ? tool_value(fanuc.modes, fanuc.zero, fanuc, 'D', false)
                              : 0.5 * nc::active_tool(fanuc.control)->diameter_mm;
  const bool left =
      (code == G::kCompensationLeft) != (mapped(fanuc.mapping) && reversed(fanuc.mapping, fanuc));
  nc::set_compensation(fanuc.control, left ? Compensation::kLeft : Compensation::kRight, radius, at);
}

void apply_length(Fanuc& fanuc) {
  const int code = fanuc.block.g[kFanucLength];
  if (code >= G::kTcpRotaries && code <= G::kTcpVectors)
    refuse_mapped(fanuc.mapping, fanuc, fanuc.g_column(kFanucLength), "TCP is switched on", true);
  fanuc.modes.length_code = code;
  if (code == G::kLengthOff) {
    fanuc.modes.tcp = Tcp::kOff;
    nc::set_length_compensation(fanuc.control, 0.0, false);
    return update_space(fanuc);
  }
  const bool named = fanuc.block.has('H') || fanuc.modes.h_kept;
  if (!named && nc::active_tool(fanuc.control) == nullptr && !fanuc.control.setup.tools.empty())
    fanuc.control.report.fail("missing-word", fanuc.g_column(kFanucLength),
                              "the length compensation has no H word and no tool",
                              "add H with the tool's number");
  const NcTool* tool = nc::active_tool(fanuc.control);
  const double length = named             ? tool_value(fanuc.modes, fanuc.zero, fanuc, 'H', true)
                        : tool != nullptr ? tool->length_mm
                                          : 0.0;
  nc::set_length_compensation(fanuc.control, code == G::kLengthNegative ? -length : length, true);
  fanuc.modes.tcp = code == G::kTcpRotaries ? Tcp::kAxes : code == G::kTcpVectors ? Tcp::kVector : Tcp::kOff;
  update_space(fanuc);
}

void apply_modes(Fanuc& fanuc) {
  if (fanuc.block.g_given == 0) return;
  if (fanuc.block.has_g(kFanucPlane))
    nc::set_plane(fanuc.control, fanuc.block.g[kFanucPlane] == G::kPlaneXY   ? Plane::kXY
                                 : fanuc.block.g[kFanucPlane] == G::kPlaneZX ? Plane::kZX
                                                                             : Plane::kYZ);
  if (fanuc.block.has_g(kFanucDistance))
    fanuc.modes.incremental = fanuc.block.g[kFanucDistance] == G::kIncremental;
  if (fanuc.block.has_g(kFanucRetract))
    fanuc.modes.retract_to_r = fanuc.block.g[kFanucRetract] == G::kRetractToR;
  if (fanuc.block.has_g(kFanucPath))
    fanuc.control.modal.exact_stop =
        fanuc.block.g[kFanucPath] == G::kExactPath || fanuc.block.g[kFanucPath] == G::kExactStopPath;
  if (fanuc.block.has_g(kFanucRadius)) apply_radius(fanuc);
  if (fanuc.block.has_g(kFanucOffset)) {
    const int code = fanuc.block.g[kFanucOffset];
    refuse_mapped(fanuc.mapping, fanuc, fanuc.g_column(kFanucOffset), "the work offset changes", false);
    const bool further = code == G::kFurtherOffset;
    if (further) fanuc.need('P', fanuc.g_name(kFanucOffset).c_str());
    nc::set_work_offset(fanuc.control, further ? 100 + whole(fanuc.block, 'P', 1, fanuc.rules.further_offsets,
                                                             fanuc.reader, fanuc.control)
                                               : work_offset_number(code));
    update_space(fanuc);
  }
  if (fanuc.block.has_g(kFanucLength)) apply_length(fanuc);
}

/// Letters that an own code of the dialect gives a meaning in this block.
std::string_view own_letters(const Rules& rules, int one_shot) {
  const auto own = std::find_if(rules.own_codes.begin(), rules.own_codes.end(),
                                [&](const OwnCode& code) { return code.tenths == one_shot; });
  return own == rules.own_codes.end() ? std::string_view() : own->letters;
}

/// Whether a code of this block gives the letter a meaning of its own.
bool taken_by_code(const LetterDialect& letters, const Rules& rules, char letter) {
  return own_letters(rules, g(letters, kFanucOneShot)).find(letter) != std::string_view::npos ||
         (letters.block.free_g > 0 && rules.free_letters.find(letter) != std::string_view::npos) ||
         (letters.block.listed_m > 0 && rules.listed_letters.find(letter) != std::string_view::npos);
}

/// H and D are modal: without G43 or G41 in the block they only name the offset that the next one takes.
/// Where compensation is on, another number would change it at once, which is not read.
void check_offset_numbers(const Modes& modes, LetterDialect& letters, const Rules& rules, bool h_of_tilt) {
  const bool radius = g(letters, kFanucRadius) > G::kCompensationOff;
  const bool d = letters.block.has('D') && !taken_by_code(letters, rules, 'D'),
             h = letters.block.has('H') && !taken_by_code(letters, rules, 'H');
  if (d && !radius && letters.control.contour.side() != Compensation::kOff)
    letters.check_letter('D', false, "G41 and G42; while one is on, another radius is not read");
  const int code = g(letters, kFanucLength);
  const bool length = code >= G::kLengthOn && code != G::kLengthOff;
  if (h && !length && code < 0 && !h_of_tilt && modes.length_code != G::kLengthOff)
    letters.check_letter('H', false, "G43 and G53.6; while G43 is on, write it again with the new H");
}

/// D and H of a block that compensates nothing: kept for the next G41 and G43.
void keep_offset_numbers(Modes& modes, LetterDialect& letters, const Rules& rules) {
  if (letters.block.has('D') && !taken_by_code(letters, rules, 'D')) {
    modes.d_number = whole(letters.block, 'D', 0, 99999999, letters.reader, letters.control);
    modes.d_kept = g(letters, kFanucRadius) <= G::kCompensationOff;
  }
  if (letters.block.has('H') && !taken_by_code(letters, rules, 'H')) {
    modes.h_number = whole(letters.block, 'H', 0, 99999999, letters.reader, letters.control);
    modes.h_kept = g(letters, kFanucLength) < G::kLengthOn || g(letters, kFanucLength) == G::kLengthOff;
  }
}

/// G254 of Haas is on: what turns a rotary axis, or the frame, ends it first.
void refuse_rotaries(const LetterDialect& letters) {
  for (const char letter : {'A', 'B', 'C'}) {
    if (letters.block.has(letter))
      letters.control.report.fail(
          "modal-conflict", letters.column(letter),
          "a rotary axis is programmed while G254 is on, which holds where they stand",
          "write G255 before it");
  }
  const bool all_home =
      g(letters, kFanucOneShot) == G::kToReference && (letters.block.given & kAxisBits) == 0;
  if (all_home || letters.block.has_g(kFanucTurn) || g(letters, kFanucLength) == G::kTcpRotaries)
    letters.control.report.fail("modal-conflict", letters.reader.column_of(letters.block.first),
                                "G28 of all axes, rotations and TCPC do not go with G254",
                                "write G255 before it");
}

/// ,R and ,C stand in a feed move of G01 to G03 with an end.
void check_corner(const LetterDialect& letters, int motion, bool in_cycle) {
  if (letters.block.corner.letter == 0) return;
  const int one_shot = g(letters, kFanucOneShot);
  const bool alone = (one_shot < 0 || one_shot == G::kExactStopOnce) && g(letters, kFanucMacro) < 0;
  if (alone && !in_cycle && motion >= 10 && motion <= 30 && (letters.block.given & kAxisBits) != 0) return;
  letters.control.report.fail("bad-corner", letters.reader.column_of(letters.block.corner.place),
                              ",R and ,C stand in a block without a feed move",
                              "write them in the G01, G02 or G03 block that leads to the corner");
}

}  // namespace

void check_words(Modes& modes, LetterDialect& letters, const Rules& rules) {
  const int one_shot = g(letters, kFanucOneShot);
  if (modes.rotaries_stand) refuse_rotaries(letters);
  const int motion = g(letters, kFanucMotion) >= 0 ? g(letters, kFanucMotion) : modes.motion;
  const int cycle = g(letters, kFanucCycle) >= 0    ? g(letters, kFanucCycle)
                    : g(letters, kFanucMotion) >= 0 ? 800
                                                    : modes.cycle;
  const bool in_cycle = cycle != G::kCycleOff;
  check_corner(letters, motion, in_cycle);
  if (one_shot == G::kMacroCall || g(letters, kFanucMacro) == G::kModalMacro)
    return;  // every letter is an argument
  const auto taken = [&](char letter) { return taken_by_code(letters, rules, letter); };
  const auto check = [&](char letter, bool allowed, const char* used_with) {
    letters.check_letter(letter, allowed || taken(letter), used_with);
  };
  for (const char letter : {'U', 'V', 'W', 'E'}) {
    if (letters.block.has(letter) && !taken(letter))
      letters.control.report.fail(
          letter == 'E' ? "unknown-word" : "axis-missing", letters.column(letter),
          fmt::format("the machine {} has no axis {}", letters.control.setup.machine.name, letter),
          "take the word out, or choose the machine that the program was posted for");
  }
  const bool arc = !in_cycle && (motion == G::kArcClockwise || motion == G::kArcCounterClockwise),
             turn = (g(letters, kFanucTurn) >= G::kTurnOn && g(letters, kFanucTurn) != G::kTurnOff) ||
                    g(letters, kFanucScale) == G::kScaleOn;
  const bool tilts = one_shot == G::kTiltRotaries || one_shot == G::kTiltAboutTip;
  const bool vectors = (modes.tcp == Tcp::kVector || g(letters, kFanucLength) == G::kTcpVectors) && !arc;
  const bool calls = letters.block.has_m(M::kCall) || letters.block.has_m(M::kCallFile) ||
                     letters.block.has_m(M::kCallLocal),
             ends = calls || letters.block.has_m(M::kReturn);
  const bool bore = cycle == G::kFineBore || cycle == G::kBackBore;
  const auto repeats = [&](char letter) {
    return in_cycle && rules.repeats.find(letter) != rules.repeats.npos;
  };
  for (const char letter : {'I', 'J', 'K'})
    check(letter, arc || turn || vectors || motion == G::kNurbs || (letter == 'K' ? repeats('K') : bore),
          "G2, G3, G43.5, G51, G68.2");
  check('R', arc || in_cycle || turn || tilts || motion == G::kNurbs || one_shot == G::kSetData,
        "arcs, cycles, G68 and G06.2");
  check('Q', in_cycle || turn || (calls && rules.call_label == 'Q'), "pecking cycles and G68.2");
  check('P',
        in_cycle || one_shot == G::kDwell || one_shot == G::kSetData || one_shot == G::kToSecondReference ||
            motion == G::kNurbs || ends || g(letters, kFanucOffset) == G::kFurtherOffset || turn || tilts,
        "G04, G10, M98 and cycles");
  check('L', repeats('L') || one_shot == G::kSetData || calls, "G10, M98 and cycles");
  check_offset_numbers(modes, letters, rules, one_shot == G::kTiltAboutTip);
  if (g(letters, kFanucCycle) > G::kCycleOff && g(letters, kFanucMotion) >= 0)
    letters.control.report.fail("two-motion-words", letters.g_column(kFanucMotion),
                                "a motion and a cycle stand in one block", "write them in two blocks");
  letters.check_feed_and_speed();
  if (one_shot == G::kDwell && !letters.block.has('P') && !letters.block.has('X'))
    letters.control.report.fail("missing-word", letters.g_column(kFanucOneShot), "G04 has no time",
                                "add P (ms) or X (s)");
}

void apply(Fanuc& fanuc) {
  if (g(fanuc, kFanucOneShot) == G::kMacroCall) return call_macro(fanuc);
  if (g(fanuc, kFanucMacro) == G::kModalMacro) return set_modal_macro(fanuc.calls, fanuc);
  apply_machine(fanuc);
  if (fanuc.block.has('D') || fanuc.block.has('H')) keep_offset_numbers(fanuc.modes, fanuc, fanuc.rules);
  apply_modes(fanuc);
  keep_motion_codes(fanuc.modes, fanuc.drilling, fanuc);
  if (fanuc.block.has_g(kFanucMacro)) set_modal_macro(fanuc.calls, fanuc);
  if (fanuc.block.has_g(kFanucPolar)) polar(fanuc.modes, fanuc.mapping, fanuc, fanuc.block.g[kFanucPolar]);
  if (fanuc.block.has_g(kFanucScale)) scale(fanuc, fanuc.block.g[kFanucScale]);
  if (fanuc.block.has_g(kFanucMirror)) mirror(fanuc, fanuc.block.g[kFanucMirror]);
  const bool axes_given = (fanuc.block.given & kAxisBits) != 0;
  if (g(fanuc, kFanucScale) == G::kScaleOn || (fanuc.block.has_g(kFanucMirror) && axes_given))
    return;  // words of the centre
  if (fanuc.block.has_g(kFanucTurn)) {
    const bool tilted = fanuc.planes.turned.in_work;
    turn(fanuc, fanuc.block.g[kFanucTurn]);
    if (fanuc.block.g[kFanucTurn] != G::kTurnOff || !axes_given) return;
    if (tilted)
      fanuc.control.report.fail("unexpected-word", fanuc.g_column(kFanucTurn),
                                "a move stands with G69 of a tilted plane",
                                "write G69 in a block of its own");
  }
  if (fanuc.block.has_g(kFanucOneShot) && fanuc.block.g[kFanucOneShot] != G::kExactStopOnce &&
      fanuc.block.g[kFanucOneShot] != G::kMachineCoordinates)
    return one_shot(fanuc);
  if (g(fanuc, kFanucOneShot) == G::kExactStopOnce) fanuc.control.modal.exact_stop_once = true;
  motion(fanuc);
}

/// TCP, tilted plane and shifts as the control understands them: the frame of G68 or G68.2 stands in the work
/// offset with its shifts (30i: G52 and G92 move the workpiece coordinate system).
void update_space(Fanuc& fanuc) {
  nc::set_shift(fanuc.control, fanuc.zero.shift + fanuc.zero.local);
  nc::set_tcp(fanuc.control, fanuc.modes.tcp);
  if (fanuc.modes.tcp == Tcp::kOff && fanuc.planes.turned.on && fanuc.planes.turned.in_work)
    nc::set_coordinates(fanuc.control, Coordinates::kWork);
  nc::set_frame(fanuc.control, fanuc.planes.turned.on ? fanuc.planes.turned.frame : Pose::Identity());
}

}  // namespace swarf::program::nc::fanuc
