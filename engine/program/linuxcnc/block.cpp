// Third and fourth step: the rules of a block's words, then what they do, in the control's order.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angles.h"
#include "base/units.h"
#include "program/linuxcnc/steps.h"

namespace swarf::program::nc::linuxcnc {
namespace {

bool is_cycle(int tenths) {
  return tenths == G::kDrillChipBreak || tenths == G::kTapLeft ||
         (tenths >= G::kDrill && tenths <= G::kBoreDwellOut);
}
bool is_arc(int tenths) {
  return tenths == G::kArcClockwise || tenths == G::kArcCounterClockwise;
}
constexpr int kCubic = 50, kQuadratic = 51, kNurbs = 52;

/// Words that only some codes take.
void check_letters(Modes& modes, LetterDialect& letters) {
  const auto bit = [](char letter) { return 1u << (letter - 'A'); };
  const uint32_t rare =
      bit('D') | bit('E') | bit('H') | 7u << ('I' - 'A') | bit('L') | bit('P') | bit('Q') | bit('R');
  if ((letters.block.given & rare) == 0) return;
  const int non_modal = letters.block.has_g(kNonModal) ? letters.block.g[kNonModal] : -1;
  // A modal motion acts in blocks with axis words only.
  const bool acts = is_axis_given(letters) && !uses_axis_words(letters);
  const int motion = letters.block.has_g(kMotionGroup) ? letters.block.g[kMotionGroup]
                     : acts                            ? modes.motion
                                                       : -1;
  const auto moves = [&](std::initializer_list<int> codes) {
    return std::find(codes.begin(), codes.end(), motion) != codes.end();
  };
  const auto has_m = [&](std::initializer_list<int> codes) {
    return std::any_of(codes.begin(), codes.end(), [&](int code) { return letters.block.has_m(code); });
  };
  const bool cycle = is_cycle(motion), arc = is_arc(motion), data = non_modal == G::kSetData;
  const bool radius =
      letters.block.has_g(kRadiusGroup) && letters.block.g[kRadiusGroup] != G::kCompensationOff;
  const bool path = letters.block.has_g(kPathGroup) && letters.block.g[kPathGroup] == G::kContinuousPath;
  const int length = letters.block.has_g(kLengthGroup) ? letters.block.g[kLengthGroup] : 0;
  letters.check_letter('D', radius, "G41 and G42");
  letters.check_letter('E', has_m({660, 670, 680}), "M66, M67 and M68");
  letters.check_letter('H', length == G::kLengthOn || length == G::kLengthAdded, "G43 and G43.2");
  for (const char letter : {'I', 'J'})
    letters.check_letter(letter, arc || moves({kCubic, kQuadratic, 870}) || data,
                         "G2, G3, G5, G5.1, G87 and G10 L1");
  letters.check_letter('K', arc || motion == G::kBackBore, "G2, G3 and G87");
  letters.check_letter('R', cycle || arc || data || letters.block.has_m(190), "arcs, cycles, G10 L1 and L2");
  letters.check_letter('P',
                       arc || data || non_modal == G::kDwell || path ||
                           moves({kCubic, kNurbs, 730, 740, 820, 830, 840, 860, 880, 890}) ||
                           has_m({190, 500, 510, 520, 530, 620, 630, 640, 650, 660, 980}),
                       "G4, G5, G10, G64, arcs, cycles that dwell and M98");
  letters.check_letter('Q', path || data || moves({kCubic, 730, 830}) || has_m({190, 610, 660, 670, 680}),
                       "G5, G64, G73, G83, M61 and M66");
  letters.check_letter('L', cycle || data || motion == kNurbs || has_m({660, 980}),
                       "G5.2, G10, cycles, M66 and M98");
}

void check_axes_and_motion(Modes& modes, LetterDialect& letters) {
  const bool uses = uses_axis_words(letters);
  if (uses && letters.block.has_g(kMotionGroup) && letters.block.g[kMotionGroup] != G::kCycleOff)
    letters.control.report.fail("modal-conflict", letters.g_column(kMotionGroup),
                                "two G codes of this block both want its axis words",
                                "write them in two blocks");
  if (letters.block.has_g(kMachineGroup)) {
    const int motion = letters.block.has_g(kMotionGroup) ? letters.block.g[kMotionGroup] : modes.motion;
    if (motion != 0 && motion != G::kStraight)
      letters.control.report.fail("modal-conflict", letters.g_column(kMachineGroup),
                                  "G53 goes with G0 and G1 only", "write G53 G0");
    const bool incremental = letters.block.has_g(kDistanceGroup)
                                 ? letters.block.g[kDistanceGroup] == G::kIncremental
                                 : modes.incremental;
    if (incremental)
      letters.control.report.fail("modal-conflict", letters.g_column(kMachineGroup),
                                  "G53 wants a position, and G91 is active", "write G90 before it");
    if (!is_axis_given(letters))
      letters.control.report.fail("missing-word", letters.g_column(kMachineGroup), "G53 has no axis words",
                                  "add the axes that move");
  }
  if (!is_axis_given(letters) || uses) return;
  const int motion = letters.block.has_g(kMotionGroup) ? letters.block.g[kMotionGroup] : modes.motion;
  if (motion < 0 || motion == G::kCycleOff)
    letters.control.report.fail("no-motion-mode", letters.reader.column_of(letters.block.first),
                                "axis words stand here, and no motion (G0 to G3) is active",
                                "write G0 or G1");
}

/// LinuxCNC takes F before G20 and G21 of its block (order of execution).
void warn_of_feed_units(LetterDialect& letters) {
  if (!letters.block.has_g(kUnitsGroup) ||
      letters.control.modal.inches() == (letters.block.g[kUnitsGroup] == G::kInches))
    return;
  if (letters.control.modal.feed_mode == FeedMode::kInverseTime) return;
  letters.control.report.warn_once(
      "feed-before-units", letters.column('F'),
      fmt::format("F{:g} counts in {}: LinuxCNC takes it before the {} of its block", letters.block.get('F'),
                  letters.control.modal.inches() ? "inches" : "millimetres",
                  letters.control.modal.inches() ? "G21" : "G20"),
      "write F in a block after it");
}

void apply_feed_and_speed(LetterDialect& letters) {
  if (letters.block.has_g(kFeedGroup)) {
    const int code = letters.block.g[kFeedGroup];
    const FeedMode mode = code == G::kInverseTime ? FeedMode::kInverseTime
                          : code == G::kPerMinute ? FeedMode::kPerMinute
                                                  : FeedMode::kPerRevolution;
    nc::restore_feed(letters.control.modal, mode,
                     0.0);  // F is forgotten, also by the word that holds already
  }
  if (letters.block.has('F')) {
    nc::set_feed(letters.control.report, letters.control.modal, letters.block.get('F'), letters.column('F'));
    warn_of_feed_units(letters);
  }
  if (letters.block.has('S')) letters.control.modal.speed_rpm = letters.block.get('S');
}

void apply_machine_functions(LinuxCnc& linuxcnc) {
  constexpr std::pair<int, int> kSpindle[] = {{30, 1}, {40, -1}, {50, 0}};
  for (const auto& [code, sense] : kSpindle) {
    if (linuxcnc.block.has_m(code)) linuxcnc.control.modal.spindle = sense;
  }
  for (int i = 0; i < linuxcnc.block.m_count; ++i) {
    const int code = linuxcnc.block.m[static_cast<size_t>(i)];
    const int at = linuxcnc.reader.column_of(linuxcnc.block.m_places[static_cast<size_t>(i)]);
    if (code >= M::kSaveState && code <= M::kSaveAndRestoreState) apply_saved_state(linuxcnc, code, at);
    if (code >= M::kFirstKinematics) switch_kinematics(linuxcnc.modes, linuxcnc, code, at);
  }
  if (linuxcnc.block.has_m(70)) linuxcnc.modes.mist = true;
  if (linuxcnc.block.has_m(80)) linuxcnc.modes.flood = true;
  if (linuxcnc.block.has_m(90)) linuxcnc.modes.mist = linuxcnc.modes.flood = false;
}

void apply_offsets(Zero& zero, LetterDialect& letters) {
  if (!letters.block.has_g(kOffsetGroup)) return;
  const int code = letters.block.g[kOffsetGroup];
  nc::set_work_offset(letters.control, code <= 590 ? (code - 530) / 10 : code - 584);
  update_shift(zero, letters);
}

void apply_path_mode(LetterDialect& letters) {
  if (!letters.block.has_g(kPathGroup)) return;
  const int code = letters.block.g[kPathGroup];
  letters.control.modal.exact_stop = code != G::kContinuousPath;
  if (code == G::kContinuousPath && letters.block.has('Q'))
    letters.control.report.without_effect("G64 Q (merging of short blocks)");
  letters.control.modal.corner_tolerance_mm = code == G::kContinuousPath && letters.block.has('P')
                                                  ? letters.control.modal.mm(letters.block.get('P'))
                                                  : 0.0;
}

}  // namespace

/// @ (distance from the zero point) and ^ (degrees from +X) become X and Y. What is left out, and what G91
/// counts from, is that of the present position.
void polar_words(LinuxCnc& linuxcnc) {
  LetterBlock& block = linuxcnc.block;
  if (!block.distance.given && !block.angle.given) return;
  const size_t place = block.distance.given ? block.distance.place : block.angle.place;
  const auto fail = [&](const char* code, const char* text, const char* fix) {
    linuxcnc.control.report.fail(code, linuxcnc.reader.column_of(place), text, fix);
  };
  if (block.has('X') || block.has('Y'))
    fail("words-conflict", "@ and ^ stand beside X or Y", "write G1 @10 ^30, or X and Y");
  if (block.has_g(kOffsetGroup) || block.has_g(kUnitsGroup) || block.has_g(kNonModal))
    fail("words-conflict", "@ and ^ stand beside a change of offset or unit", "write it in a block before");
  if (block.has_g(kMachineGroup))
    fail("words-conflict", "@ and ^ stand beside G53: they count from the zero point of the part",
         "write X and Y behind G53");
  const int own = block.has_g(kPlaneGroup) ? block.g[kPlaneGroup] : G::kPlaneXY;
  if (linuxcnc.control.modal.plane != Plane::kXY || own != G::kPlaneXY)
    fail("words-conflict", "@ and ^ lie in the plane XY, and G18 or G19 is in force",
         "write G17 in a block before, or X, Y and Z");
  const bool incremental =
      block.has_g(kDistanceGroup) ? block.g[kDistanceGroup] == G::kIncremental : linuxcnc.modes.incremental;
  const bool counts = incremental || !block.distance.given || !block.angle.given;
  const Vec3 here =
      counts ? Vec3(nc::position_xyz(linuxcnc.control) / linuxcnc.control.modal.mm(1.0)) : Vec3(Vec3::Zero());
  const double now = std::hypot(here.x(), here.y());
  if (!std::isfinite(now))
    fail("start-unknown", "@ or ^ counts from a position that is not known yet",
         "position X and Y before it");
  if (counts && now < 1e-9 && (incremental || !block.angle.given))
    fail("bad-polar", "the angle of the present position is none: it is the zero point",
         "write @ and ^ under G90");
  const double turned = deg_from_rad(std::atan2(here.y(), here.x()));
  const double radius = block.distance.given ? block.distance.value + (incremental ? now : 0.0) : now;
  const double angle = block.angle.given ? block.angle.value + (incremental ? turned : 0.0) : turned;
  const double x = radius * cos_deg(angle), y = radius * sin_deg(angle);
  block.set('X', incremental ? x - here.x() : x, place);
  block.set('Y', incremental ? y - here.y() : y, place);
}

bool uses_axis_words(const LetterDialect& letters) {
  if (!letters.block.has_g(kNonModal)) {
    const int length = letters.block.has_g(kLengthGroup) ? letters.block.g[kLengthGroup] : 0;
    return length == G::kLengthBy || (length == G::kLengthAdded && !letters.block.has('H'));
  }
  const int code = letters.block.g[kNonModal];
  return code == G::kSetData || code == G::kToReference || code == G::kToSecondReference ||
         code == G::kLocalShift || code == G::kShift;
}

void check_words(Modes& modes, Curves& curves, LetterDialect& letters) {
  for (const char letter : {'U', 'V', 'W'}) {
    if (letters.block.has(letter))
      letters.control.report.fail(
          "axis-missing", letters.column(letter),
          fmt::format("the machine {} has no axis {}", letters.control.setup.machine.name, letter),
          "take the word out, or choose the machine that the program was posted for");
  }
  if (curves.nurbs) return check_nurbs_words(curves, letters);
  check_letters(modes, letters);
  check_axes_and_motion(modes, letters);
  if (letters.block.has_g(kNonModal) && letters.block.g[kNonModal] == G::kDwell) letters.need('P', "G4");
  letters.check_feed_and_speed();
}

void apply(LinuxCnc& linuxcnc) {
  apply_feed_and_speed(linuxcnc);
  if ((linuxcnc.block.given & (1u << ('T' - 'A'))) != 0 || linuxcnc.block.m_count > 0) {
    if (linuxcnc.block.has_m(660)) read_input(linuxcnc.modes, linuxcnc);
    if (linuxcnc.block.has_m(680)) warn_of_output(linuxcnc);
    apply_tool(linuxcnc.modes, linuxcnc.curves, linuxcnc);
    apply_machine_functions(linuxcnc);
  }
  constexpr uint32_t kModal = 1u << kPlaneGroup | 1u << kUnitsGroup | 1u << kRadiusGroup |
                              1u << kLengthGroup | 1u << kOffsetGroup | 1u << kPathGroup |
                              1u << kDistanceGroup | 1u << kArcDistanceGroup | 1u << kRetractGroup;
  if (linuxcnc.block.has_g(kNonModal) && linuxcnc.block.g[kNonModal] == G::kDwell)
    nc::dwell(linuxcnc.control.report, linuxcnc.control.modal, linuxcnc.block.get('P'));
  if ((linuxcnc.block.g_given & kModal) != 0) {
    if (linuxcnc.block.has_g(kPlaneGroup))
      nc::set_plane(linuxcnc.control, linuxcnc.block.g[kPlaneGroup] == G::kPlaneXY   ? Plane::kXY
                                      : linuxcnc.block.g[kPlaneGroup] == G::kPlaneZX ? Plane::kZX
                                                                                     : Plane::kYZ);
    if (linuxcnc.block.has_g(kUnitsGroup))
      nc::set_inches(linuxcnc.control.modal, linuxcnc.block.g[kUnitsGroup] == G::kInches);
    apply_compensation(linuxcnc.modes, linuxcnc.zero, linuxcnc);
    apply_length(linuxcnc.zero, linuxcnc);
    apply_offsets(linuxcnc.zero, linuxcnc);
    apply_path_mode(linuxcnc);
    if (linuxcnc.block.has_g(kDistanceGroup))
      linuxcnc.modes.incremental = linuxcnc.block.g[kDistanceGroup] == G::kIncremental;
    if (linuxcnc.block.has_g(kArcDistanceGroup))
      linuxcnc.modes.arc_absolute = linuxcnc.block.g[kArcDistanceGroup] == G::kArcAbsolute;
    if (linuxcnc.block.has_g(kRetractGroup)) {
      linuxcnc.modes.retract_to_r = linuxcnc.block.g[kRetractGroup] == G::kRetractToR;
      linuxcnc.modes.retract_known = true;
    }
  }
  if (linuxcnc.block.has_g(kNonModal)) non_modal(linuxcnc);
  if (linuxcnc.block.has_g(kMotionGroup) || (is_axis_given(linuxcnc) && !uses_axis_words(linuxcnc)))
    motion(linuxcnc);
}

bool apply_end(LinuxCnc& linuxcnc) {
  for (int i = 0; i < linuxcnc.block.m_count; ++i) {
    const int code = linuxcnc.block.m[static_cast<size_t>(i)];
    const int at = linuxcnc.reader.column_of(linuxcnc.block.m_places[static_cast<size_t>(i)]);
    if (code == M::kEnd || code == M::kEndExchange) return false;
    if (code == M::kCall) {
      linuxcnc.need('P', "M98");
      const long times = linuxcnc.block.has('L')
                             ? whole(linuxcnc.block, 'L', 0, 1'000'000, linuxcnc.reader, linuxcnc.control)
                             : 1;
      call_number(linuxcnc.calls, linuxcnc,
                  whole(linuxcnc.block, 'P', 0, 99999999, linuxcnc.reader, linuxcnc.control), times, at);
    }
    if (code == M::kReturn && linuxcnc.calls.stack.called() && frame(linuxcnc.calls).numbered) {
      leave(linuxcnc);
    } else if (code == M::kReturn && linuxcnc.calls.stack.called()) {
      linuxcnc.control.report.fail("bad-o-word", at, "M99 ends a subprogram that was called with O... call",
                                   "end it with endsub");
    } else if (code == M::kReturn) {
      linuxcnc.control.report.warn_once("main-program-repeats", at,
                                        "M99 repeats the main program for ever; it was run once",
                                        "end it with M2 where that is meant");
      return false;
    }
  }
  return true;
}

}  // namespace swarf::program::nc::linuxcnc
