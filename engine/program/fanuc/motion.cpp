// Motions, NURBS, reference points.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/units.h"
#include "program/control/corner.h"
#include "program/fanuc/steps.h"

namespace swarf::program::nc::fanuc {
namespace {

/// Chords of a NURBS miss it by at most this much: a tenth of what surface checks can see.
constexpr double kNurbsToleranceMm = 1e-4;
/// An axis closer than this (mm, rad) stands at its reference position.
constexpr double kReferenceTolerance = 1e-6;
/// The first control point must be where the tool stands, mm.
constexpr double kNurbsStartMm = 5e-3;

/// G27: rapid to the point; it must be the reference position of the axes that are named.
void check_reference(Modes& modes, Mapping& mapping, LetterDialect& letters) {
  const Target target = words(modes, mapping, letters);
  if (!target.any())
    letters.control.report.fail("missing-word", letters.g_column(kFanucOneShot), "G27 has no axis words",
                                "name the axes: G27 X0");
  nc::line(letters.control, Motion::kRapid, target);
  nc::flush(letters.control);
  for (int word = 0; word < kAxisWords; ++word) {
    if (!target.has(word)) continue;
    const int axis = nc::require_axis(letters.control, static_cast<AxisWord>(word), target.column);
    const double home = letters.control.setup.machine.axes[static_cast<size_t>(axis)].home;
    const double off = letters.control.path.q[axis] - home;
    if (std::abs(off) > kReferenceTolerance)
      letters.control.report.fail(
          "not-at-reference", target.column,
          word < 3 ? fmt::format("{} stands {:.4f} mm from its reference position", kAxisLetters[word], off)
                   : fmt::format("{} stands {:.4f} degrees from its reference position", kAxisLetters[word],
                                 deg_from_rad(off)),
          "correct the point, or cancel offsets before G27");
  }
}

/// G29: from the reference position through the point of the last G28 or G30 to the point written; under G91
/// the words count from that point.
void return_from_reference(Fanuc& fanuc) {
  const Target target = words(fanuc.modes, fanuc.mapping, fanuc);
  if (!target.any())
    fanuc.control.report.fail("missing-word", fanuc.g_column(kFanucOneShot), "G29 has no axis words",
                              "name the axes: G29 X0");
  Target through;
  through.column = target.column;
  for (int word = 0; word < kAxisWords; ++word) {
    if (!target.has(word)) continue;
    const auto& point = fanuc.zero.through[static_cast<size_t>(word)];
    if (!point)
      fanuc.control.report.fail(
          "no-reference", target.column,
          fmt::format("G29 comes back through the point of G28, and {} has none", kAxisLetters[word]),
          "write G28 with this axis before it, or G00");
    through.set(word, *point, false);
  }
  nc::line(fanuc.control, Motion::kRapid, through);
  nc::line(fanuc.control, Motion::kRapid, target);
}

/// G28 alone: all axes at once, wherever they stand.
void all_home(Control& control, int column) {
  Target home;
  home.column = column;
  for (int word = 0; word < kAxisWords; ++word) {
    const int axis = control.space.axis_of(word);
    if (axis >= 0) home.set(word, control.setup.machine.axes[static_cast<size_t>(axis)].home, false);
  }
  nc::machine_line(control, Motion::kRapid, home);
}

/// G28, G30 (P2): through the point that the words give to the reference position. The point is kept for G29.
void reference(Fanuc& fanuc) {
  const kinematics::MachineModel& machine = fanuc.control.setup.machine;
  const bool second = fanuc.block.g[kFanucOneShot] == G::kToSecondReference;
  if (second && fanuc.block.has('P') && whole(fanuc.block, 'P', 2, 4, fanuc.reader, fanuc.control) != 2)
    fanuc.control.report.fail("unsupported-word", fanuc.column('P'),
                              "the third and fourth reference positions are not known",
                              "write G30 P2, which goes to the tool change position");
  if (second && !machine.tool_change)
    fanuc.control.report.fail("no-reference", fanuc.g_column(kFanucOneShot),
                              "G30 goes to the tool change position, and the machine has none",
                              "add tool_change to the machine file, or write G28");
  const Target through = words(fanuc.modes, fanuc.mapping, fanuc);
  if (!through.any() && !second && fanuc.rules.reference_alone)
    return all_home(fanuc.control, fanuc.g_column(kFanucOneShot));
  if (!through.any())
    fanuc.control.report.fail("missing-word", fanuc.g_column(kFanucOneShot), "G28 has no axis words",
                              "name the axes: G91 G28 Z0");
  // G91 G28 Z0 at the head of a program: the point is where the axis stands, known or not.
  const bool at_once =
      !fanuc.control.path.started && through.given == through.incremental &&
      std::all_of(through.value.begin(), through.value.end(), [](double x) { return x == 0.0; });
  if (!at_once) nc::line(fanuc.control, Motion::kRapid, through);
  Target home;
  home.column = fanuc.g_column(kFanucOneShot);
  for (int word = 0; word < kAxisWords; ++word) {
    if (!through.has(word)) continue;
    const auto slot = static_cast<size_t>(word);
    const double passed = nc::position(fanuc.control)[slot];
    fanuc.zero.through[slot] = std::isfinite(passed) ? std::optional(passed) : std::nullopt;
    const int axis = nc::require_axis(fanuc.control, static_cast<AxisWord>(word), through.column);
    home.set(word, second ? (*machine.tool_change)[axis] : machine.axes[static_cast<size_t>(axis)].home,
             false);
  }
  nc::machine_line(fanuc.control, Motion::kRapid, home);
}

void references(Fanuc& fanuc) {
  const int code = fanuc.block.g[kFanucOneShot];
  if (fanuc.calls.stack.top().modals > 0)
    fanuc.control.report.fail("modal-conflict", fanuc.g_column(kFanucOneShot),
                              "a reference point is approached while G66 is on", "write G67 before it");
  if (code == G::kCheckReference) return check_reference(fanuc.modes, fanuc.mapping, fanuc);
  if (code == G::kFromReference) return return_from_reference(fanuc);
  reference(fanuc);
}

void nurbs(Fanuc& fanuc) {
  refuse_mapped(fanuc.mapping, fanuc, fanuc.g_column(kFanucMotion), "a NURBS begins", true);
  Nurbs nurbs;
  nurbs.where = fanuc.control.report.place;
  if (fanuc.block.has('P')) nurbs.order = whole(fanuc.block, 'P', 2, 6, fanuc.reader, fanuc.control);
  if (!fanuc.block.has('K') || (fanuc.block.given & kAxisBits) == 0)
    fanuc.control.report.fail("missing-word", 0, "G06.2 needs a knot K and a control point",
                              "write G06.2 P4 K0 X Y Z");
  fanuc.nurbs = nurbs;
  add_to_nurbs(fanuc.modes, fanuc.nurbs, fanuc);
}

}  // namespace

double seconds_of_p(const Fanuc& fanuc) {
  const bool point = fanuc.rules.point_is_seconds && !without_point(fanuc, 'P');
  return point ? fanuc.block.get('P') : 1e-3 * fanuc.block.get('P');
}

void one_shot(Fanuc& fanuc) {
  const int code = fanuc.block.g[kFanucOneShot];
  if (code != G::kDwell && code != G::kSetData && code != G::kEndSetData && code != G::kExactStopOnce)
    refuse_mapped(fanuc.mapping, fanuc, fanuc.g_column(kFanucOneShot),
                  "coordinate systems, reference points and planes are used",
                  code >= G::kCheckReference && code <= G::kToSecondReference);
  switch (code) {
    case G::kDwell:
      return nc::dwell(fanuc.control.report, fanuc.control.modal,
                       fanuc.block.has('X') ? fanuc.block.get('X') : seconds_of_p(fanuc));
    case G::kSetData:
      return set_data(fanuc.modes, fanuc.zero, fanuc, fanuc.rules);
    case G::kEndSetData:
      return;
    case G::kCheckReference:
    case G::kToReference:
    case G::kFromReference:
    case G::kToSecondReference:
      return references(fanuc);
    case G::kLocalShift:
      return shift_to_words(fanuc, false);
    case G::kShift:
      return shift_to_words(fanuc, true);
    case G::kTiltRotaries:
    case G::kTiltAboutTip:
      return tilt_rotaries(fanuc, fanuc.block.g[kFanucOneShot] == G::kTiltAboutTip);
    default:
      for (const OwnCode& own : fanuc.rules.own_codes) {
        if (own.tenths == code) return own.act(fanuc);
      }
      return motion(fanuc);
  }
}

/// G00 to G03 and G73 to G89 hold from this block on, whatever else it does.
void keep_motion_codes(Modes& modes, Drilling& drilling, LetterDialect& letters) {
  if (letters.block.has_g(kFanucMotion)) {
    modes.motion = letters.block.g[kFanucMotion];
    modes.cycle = 800;
    drilling.words = CycleWords();
  }
  if (!letters.block.has_g(kFanucCycle)) return;
  const int code = letters.block.g[kFanucCycle];
  if (code == G::kCycleOff) drilling.words = CycleWords();
  if (code != G::kCycleOff && modes.cycle == G::kCycleOff)
    drilling.cycle_start = nc::position_xyz(letters.control)[axes_of(letters.control.modal.plane).normal];
  modes.cycle = code;
}

/// ,R and ,C: corners up to one degree are none.
void ask_for_corner(Mapping& mapping, LetterDialect& letters) {
  const LetterBlock::Corner& written = letters.block.corner;
  if (written.letter == 0) return;
  const int column = letters.reader.column_of(written.place);
  if (!(written.value > 0.0))
    letters.control.report.fail("out-of-range", column, "the size of a corner is not above zero",
                                "write ,R2. or ,C1.");
  ArcWords size;
  size.radius = letters.control.modal.mm(written.value);
  size.column = column;
  map_arc(mapping, letters, size);
  CornerWords words;
  words.kind = written.letter == 'R' ? CornerWords::Kind::kRound : CornerWords::Kind::kLegs;
  words.size_mm = size.radius;
  words.smooth_rad = rad_from_deg(1.0);
  words.place = letters.control.report.place;
  words.place.column = column;
  nc::ask_corner(letters.control, words);
}

void motion(Fanuc& fanuc) {
  const bool machine = g(fanuc, kFanucOneShot) == G::kMachineCoordinates;
  if (fanuc.modes.cycle != G::kCycleOff && machine)
    fanuc.control.report.fail("modal-conflict", fanuc.g_column(kFanucOneShot),
                              "G53 stands while a canned cycle is on", "end the cycle first: G80");
  if (fanuc.modes.cycle != G::kCycleOff) return cycle(fanuc, fanuc.modes.cycle);
  if (fanuc.modes.motion == G::kNurbs) return nurbs(fanuc);
  if (machine) refuse_mapped(fanuc.mapping, fanuc, fanuc.g_column(kFanucOneShot), "G53 stands", false);
  Target target = machine ? target_of(fanuc.block, false, fanuc.reader, fanuc.control)
                          : words(fanuc.modes, fanuc.mapping, fanuc);
  if (fanuc.modes.motion == G::kArcClockwise || fanuc.modes.motion == G::kArcCounterClockwise) {
    if (machine)
      fanuc.control.report.fail("modal-conflict", fanuc.g_column(kFanucOneShot),
                                "G53 goes with G00 and G01 only", "write G53 G00");
    std::optional<ArcWords> arc = arc_words(fanuc.block, target, false, fanuc.reader, fanuc.control);
    if (!arc) return;
    fanuc.modes.moved = true;
    map_arc(fanuc.mapping, fanuc, *arc);
    const bool clockwise =
        (fanuc.modes.motion == G::kArcClockwise) != (mapped(fanuc.mapping) && reversed(fanuc.mapping, fanuc));
    ask_for_corner(fanuc.mapping, fanuc);
    nc::arc(fanuc.control, clockwise ? Motion::kClockwise : Motion::kCounterClockwise, target, *arc);
    return;
  }
  if (fanuc.modes.tcp == Tcp::kVector &&
      (fanuc.block.has('I') || fanuc.block.has('J') || fanuc.block.has('K'))) {
    target.axis_P = Vec3(fanuc.block.get('I', 0.0), fanuc.block.get('J', 0.0), fanuc.block.get('K', 0.0));
    if (target.column == 0) target.column = fanuc.reader.column_of(fanuc.block.first);
  }
  if (!target.any()) return;
  fanuc.modes.moved = true;
  ask_for_corner(fanuc.mapping, fanuc);
  const Motion kind = fanuc.modes.motion == 0 ? Motion::kRapid : Motion::kFeed;
  if (machine)
    nc::machine_line(fanuc.control, kind, target);
  else
    nc::line(fanuc.control, kind, target);
}

bool add_to_nurbs(Modes& modes, std::optional<Nurbs>& nurbs, LetterDialect& letters) {
  if (letters.block.has_g(kFanucMotion) && !nurbs->knots.empty()) {
    letters.control.report.fail(
        "bad-nurbs", letters.g_column(kFanucMotion),
        fmt::format("another motion begins after {} knots; {} points of order {} want {}",
                    nurbs->knots.size(), nurbs->points.size(), nurbs->order,
                    nurbs->points.size() + static_cast<size_t>(nurbs->order)),
        "give as many knots as points and order together");
  }
  letters.need('K', "each block of a NURBS");
  if (letters.block.has('F'))
    nc::set_feed(letters.control.report, letters.control.modal, letters.block.get('F'), letters.column('F'));
  nurbs->knots.push_back(letters.block.get('K'));
  const Target target = target_of(letters.block, false, letters.reader, letters.control);
  if (target.any()) {
    if (nurbs->knots.size() != nurbs->points.size() + 1)
      letters.control.report.fail("bad-nurbs", target.column, "a control point follows a knot that has none",
                                  "write the points first");
    CurvePoint point;
    const std::array<double, kAxisWords> here = nc::position(letters.control);
    for (int i = 0; i < 3; ++i) {
      const double before =
          nurbs->points.empty() ? here[static_cast<size_t>(i)] : nurbs->points.back().tip[i];
      point.tip[i] = target.has(i) ? target.value[static_cast<size_t>(i)] : before;
      if (target.has(i + 3)) nc::require_axis(letters.control, static_cast<AxisWord>(i + 3), target.column);
      if (letters.control.space.axis_of(static_cast<AxisWord>(i + 3)) < 0) continue;
      const auto slot = static_cast<size_t>(i);
      const double angle = nurbs->points.empty() ? here[slot + 3] : *nurbs->points.back().rotary[slot];
      point.rotary[slot] = target.has(i + 3) ? target.value[slot + 3] : angle;
    }
    if (nurbs->points.empty() && !((point.tip - nc::position_xyz(letters.control)).norm() <= kNurbsStartMm))
      letters.control.report.fail("bad-nurbs", target.column,
                                  "the first control point is not where the tool stands",
                                  "move there with G01 first");
    nurbs->points.push_back(point);
    nurbs->weights.push_back(letters.block.get('R', 1.0));
  }
  if (nurbs->knots.size() < nurbs->points.size() + static_cast<size_t>(nurbs->order)) return true;
  const Nurbs all = *nurbs;
  nurbs.reset();
  modes.motion = 10;
  try {
    nc::curve(letters.control, NurbsCurve(all.order, all.points, all.weights, all.knots), kNurbsToleranceMm);
  } catch (const std::invalid_argument& problem) {
    letters.control.report.fail("bad-nurbs", 0, problem.what(), "correct the points and knots of the NURBS");
  }
  return true;
}

}  // namespace swarf::program::nc::fanuc
