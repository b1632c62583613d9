// Motions, NURBS, reference points.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/units.h"
#include "program/fanuc/reader.h"

namespace swarf::program::nc::fanuc {
namespace {

/// Chords of a NURBS miss it by at most this much: a tenth of what surface checks can see.
constexpr double kNurbsToleranceMm = 1e-4;
/// An axis closer than this (mm, rad) stands at its reference position.
constexpr double kReferenceTolerance = 1e-6;
/// The first control point must be where the tool stands, mm.
constexpr double kNurbsStartMm = 5e-3;

}  // namespace

void Fanuc::one_shot() {
  const int code = block_.g[kFanucOneShot];
  if (code != 40 && code != 100 && code != 110 && code != 90)
    refuse_mapped(g_column(kFanucOneShot), "coordinate systems, reference points and planes are used",
                  code >= 270 && code <= 300);
  switch (block_.g[kFanucOneShot]) {
    case 40:
      return nc::dwell(control_.report, control_.modal,
                       block_.has('X') ? block_.get('X') : 1e-3 * block_.get('P'));
    case 100:
      return set_data();
    case 110:
      return;
    case 270:
    case 280:
    case 290:
    case 300:
      return references();
    case 520:
      return shift_to_words(false);
    case 920:
      return shift_to_words(true);
    case 531:
    case 536:
      return tilt_rotaries(block_.g[kFanucOneShot] == 536);
    default:
      return motion();
  }
}

void Fanuc::references() {
  const int code = block_.g[kFanucOneShot];
  if (calls_.back().modals > 0)
    control_.report.fail("modal-conflict", g_column(kFanucOneShot),
                         "a reference point is approached while G66 is on", "write G67 before it");
  if (code == 270) return check_reference();
  if (code == 290) return return_from_reference();
  reference();
}

/// G28, G30 (P2): through the point that the words give to the reference position. The point is kept for G29.
void Fanuc::reference() {
  const kinematics::MachineModel& machine = control_.setup.machine;
  const bool second = block_.g[kFanucOneShot] == 300;
  if (second && block_.has('P') && whole(block_, 'P', 2, 4, reader_, control_) != 2)
    control_.report.fail("unsupported-word", column('P'),
                         "the third and fourth reference positions are not known",
                         "write G30 P2, which goes to the tool change position");
  if (second && !machine.tool_change)
    control_.report.fail("no-reference", g_column(kFanucOneShot),
                         "G30 goes to the tool change position, and the machine has none",
                         "add tool_change to the machine file, or write G28");
  const Target through = words();
  if (!through.any())
    control_.report.fail("missing-word", g_column(kFanucOneShot), "G28 has no axis words",
                         "name the axes: G91 G28 Z0");
  // G91 G28 Z0 at the head of a program: the point is where the axis stands, known or not.
  const bool at_once =
      !control_.path.started && through.given == through.incremental &&
      std::all_of(through.value.begin(), through.value.end(), [](double x) { return x == 0.0; });
  if (!at_once) nc::line(control_, Motion::kRapid, through);
  Target home;
  home.column = g_column(kFanucOneShot);
  for (int word = 0; word < kAxisWords; ++word) {
    if (!through.has(word)) continue;
    const auto slot = static_cast<size_t>(word);
    const double passed = nc::position(control_)[slot];
    through_[slot] = std::isfinite(passed) ? std::optional(passed) : std::nullopt;
    const int axis = nc::require_axis(control_, static_cast<AxisWord>(word), through.column);
    home.set(word, second ? (*machine.tool_change)[axis] : machine.axes[static_cast<size_t>(axis)].home,
             false);
  }
  nc::machine_line(control_, Motion::kRapid, home);
}

/// G27: rapid to the point; it must be the reference position of the axes that are named.
void Fanuc::check_reference() {
  const Target target = words();
  if (!target.any())
    control_.report.fail("missing-word", g_column(kFanucOneShot), "G27 has no axis words",
                         "name the axes: G27 X0");
  nc::line(control_, Motion::kRapid, target);
  nc::flush(control_);
  for (int word = 0; word < kAxisWords; ++word) {
    if (!target.has(word)) continue;
    const int axis = nc::require_axis(control_, static_cast<AxisWord>(word), target.column);
    const double home = control_.setup.machine.axes[static_cast<size_t>(axis)].home;
    const double off = control_.path.q[axis] - home;
    if (std::abs(off) > kReferenceTolerance)
      control_.report.fail(
          "not-at-reference", target.column,
          word < 3 ? fmt::format("{} stands {:.4f} mm from its reference position", kAxisLetters[word], off)
                   : fmt::format("{} stands {:.4f} degrees from its reference position", kAxisLetters[word],
                                 deg_from_rad(off)),
          "correct the point, or cancel offsets before G27");
  }
}

/// G29: from the reference position through the point of the last G28 or G30 to the point written; under G91
/// the words count from that point.
void Fanuc::return_from_reference() {
  const Target target = words();
  if (!target.any())
    control_.report.fail("missing-word", g_column(kFanucOneShot), "G29 has no axis words",
                         "name the axes: G29 X0");
  Target through;
  through.column = target.column;
  for (int word = 0; word < kAxisWords; ++word) {
    if (!target.has(word)) continue;
    const auto& point = through_[static_cast<size_t>(word)];
    if (!point)
      control_.report.fail(
          "no-reference", target.column,
          fmt::format("G29 comes back through the point of G28, and {} has none", kAxisLetters[word]),
          "write G28 with this axis before it, or G00");
    through.set(word, *point, false);
  }
  nc::line(control_, Motion::kRapid, through);
  nc::line(control_, Motion::kRapid, target);
}

/// G00 to G03 and G73 to G89 hold from this block on, whatever else it does.
void Fanuc::keep_motion_codes() {
  if (block_.has_g(kFanucMotion)) {
    motion_ = block_.g[kFanucMotion];
    cycle_ = 800;
    sticky_ = CycleWords();
  }
  if (!block_.has_g(kFanucCycle)) return;
  const int code = block_.g[kFanucCycle];
  if (code == 800) sticky_ = CycleWords();
  if (code != 800 && cycle_ == 800)
    cycle_start_ = nc::position_xyz(control_)[axes_of(control_.modal.plane).normal];
  cycle_ = code;
}

void Fanuc::motion() {
  const bool machine = g(kFanucOneShot) == 530;
  if (cycle_ != 800 && machine)
    control_.report.fail("modal-conflict", g_column(kFanucOneShot), "G53 stands while a canned cycle is on",
                         "end the cycle first: G80");
  if (cycle_ != 800) return cycle(cycle_);
  if (motion_ == 62) return nurbs();
  if (machine) refuse_mapped(g_column(kFanucOneShot), "G53 stands", false);
  Target target = machine ? target_of(block_, false, reader_, control_) : words();
  if (motion_ == 20 || motion_ == 30) {
    if (machine)
      control_.report.fail("modal-conflict", g_column(kFanucOneShot), "G53 goes with G00 and G01 only",
                           "write G53 G00");
    std::optional<ArcWords> arc = arc_words(block_, target, false, reader_, control_);
    if (!arc) return;
    moved_ = true;
    map_arc(*arc);
    const bool clockwise = (motion_ == 20) != (mapped() && reversed());
    nc::arc(control_, clockwise ? Motion::kClockwise : Motion::kCounterClockwise, target, *arc);
    return;
  }
  if (tcp_ == Tcp::kVector && (block_.has('I') || block_.has('J') || block_.has('K'))) {
    target.axis_P = Vec3(block_.get('I', 0.0), block_.get('J', 0.0), block_.get('K', 0.0));
    if (target.column == 0) target.column = reader_.column_of(block_.first);
  }
  if (!target.any()) return;
  moved_ = true;
  const Motion kind = motion_ == 0 ? Motion::kRapid : Motion::kFeed;
  if (machine)
    nc::machine_line(control_, kind, target);
  else
    nc::line(control_, kind, target);
}

// --- NURBS
// ---------------------------------------------------------------------------------------------------

void Fanuc::nurbs() {
  refuse_mapped(g_column(kFanucMotion), "a NURBS begins", true);
  Nurbs nurbs;
  nurbs.where = control_.report.place;
  if (block_.has('P')) nurbs.order = whole(block_, 'P', 2, 6, reader_, control_);
  if (!block_.has('K') || (block_.given & kAxisBits) == 0)
    control_.report.fail("missing-word", 0, "G06.2 needs a knot K and a control point",
                         "write G06.2 P4 K0 X Y Z");
  nurbs_ = nurbs;
  add_to_nurbs();
}

bool Fanuc::add_to_nurbs() {
  if (block_.has_g(kFanucMotion) && !nurbs_->knots.empty()) {
    control_.report.fail("bad-nurbs", g_column(kFanucMotion),
                         fmt::format("another motion begins after {} knots; {} points of order {} want {}",
                                     nurbs_->knots.size(), nurbs_->points.size(), nurbs_->order,
                                     nurbs_->points.size() + static_cast<size_t>(nurbs_->order)),
                         "give as many knots as points and order together");
  }
  need('K', "each block of a NURBS");
  if (block_.has('F')) nc::set_feed(control_.report, control_.modal, block_.get('F'), column('F'));
  nurbs_->knots.push_back(block_.get('K'));
  const Target target = target_of(block_, false, reader_, control_);
  if (target.any()) {
    if (nurbs_->knots.size() != nurbs_->points.size() + 1)
      control_.report.fail("bad-nurbs", target.column, "a control point follows a knot that has none",
                           "write the points first");
    CurvePoint point;
    const std::array<double, kAxisWords> here = nc::position(control_);
    for (int i = 0; i < 3; ++i) {
      const double before =
          nurbs_->points.empty() ? here[static_cast<size_t>(i)] : nurbs_->points.back().tip[i];
      point.tip[i] = target.has(i) ? target.value[static_cast<size_t>(i)] : before;
      if (target.has(i + 3)) nc::require_axis(control_, static_cast<AxisWord>(i + 3), target.column);
      if (control_.space.axis_of(static_cast<AxisWord>(i + 3)) < 0) continue;
      const auto slot = static_cast<size_t>(i);
      const double angle = nurbs_->points.empty() ? here[slot + 3] : *nurbs_->points.back().rotary[slot];
      point.rotary[slot] = target.has(i + 3) ? target.value[slot + 3] : angle;
    }
    if (nurbs_->points.empty() && !((point.tip - nc::position_xyz(control_)).norm() <= kNurbsStartMm))
      control_.report.fail("bad-nurbs", target.column, "the first control point is not where the tool stands",
                           "move there with G01 first");
    nurbs_->points.push_back(point);
    nurbs_->weights.push_back(block_.get('R', 1.0));
  }
  if (nurbs_->knots.size() < nurbs_->points.size() + static_cast<size_t>(nurbs_->order)) return true;
  const Nurbs all = *nurbs_;
  nurbs_.reset();
  motion_ = 10;
  try {
    nc::curve(control_, NurbsCurve(all.order, all.points, all.weights, all.knots), kNurbsToleranceMm);
  } catch (const std::invalid_argument& problem) {
    control_.report.fail("bad-nurbs", 0, problem.what(), "correct the points and knots of the NURBS");
  }
  return true;
}

}  // namespace swarf::program::nc::fanuc
