// From segments to complete moves: axis values, poses, law, time.
#include "program/control/emit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/units.h"
#include "program/control/curve.h"
#include "program/control/tools.h"
#include "program/move_way.h"

namespace swarf::program::nc {
namespace {

/// Shorter ways are rounding of coordinates (mm); a segment without way and without dwell is none.
constexpr double kAxesNoWay = 1e-10;

/// A program that is longer than this at its programmed feeds would be refused where it is driven
/// (motion/cycles), and is a loop without an end where it has so many moves.
constexpr long kMovesOfALoop = 100'000;

/// Way of the rotary axes as F counts it: degrees, unless radii are set.
double turn_way(const std::array<double, 3>& from, const std::array<double, 3>& to,
                const std::array<double, 3>& radii_mm) {
  double sum = 0.0;
  for (size_t i = 0; i < 3; ++i) {
    const double weight = radii_mm[i] / kDegreePerMm;
    sum += weight * weight * (to[i] - from[i]) * (to[i] - from[i]);
  }
  return deg_from_rad(std::sqrt(sum));
}

double arc_way(const Segment& arc, double angle) {
  const Vec3 a = arc.from - arc.centre;
  const double radius = (a - a.dot(arc.normal) * arc.normal).norm();
  const double height = (arc.to - arc.from).dot(arc.normal);
  return std::hypot(radius * angle, height);
}

void set_time(const ModalState& modal, const Offsets& offsets, const Segment& segment, double way,
              double turn, double share, NcMove& move) {
  if (segment.motion == Motion::kRapid) return;
  if (segment.feed_mode == FeedMode::kInverseTime) {
    move.duration_s = share * 60.0 / segment.feed;
    return;
  }
  const bool per_minute = segment.feed_mode == FeedMode::kPerMinute;
  const double rate = per_minute ? 1.0 : std::abs(segment.spindle_rpm);
  const double mm_s = segment.feed * segment.feed_unit_mm * rate / 60.0, deg_s = segment.feed * rate / 60.0;
  const bool tip_alone = offsets.tcp != Tcp::kOff || turn == 0.0;
  if (way > kAxesNoWay && (tip_alone || modal.feed_rule == FeedRule::kLinearFirst)) {
    move.duration_s = way / mm_s;
    if (tip_alone) move.feed_mm_s = mm_s;
  } else if (way > kAxesNoWay) {
    move.duration_s = std::hypot(way, turn) / mm_s;
  } else {
    move.duration_s = turn / deg_s;
  }
}

void place_arc(Report& report, WorkSpace& space, Offsets& offsets, const Segment& segment, NcMove& move) {
  const std::array<double, 3>& rotary = segment.rotary_to;
  if (space.coordinates() == Coordinates::kWork) {
    const Pose X_WP = space.X_WP();
    Arc arc{X_WP * segment.centre, X_WP.linear() * segment.normal};
    // The true tip stands off the compensated one along the axis when both lengths differ.
    const Vec3 linear = space.linear_of(move.q_to);
    const LinearMap real = space.real(rotary);
    const LinearMap& assumed = space.compensated(rotary);
    arc.centre_W += (real.base_W + real.columns_W * linear) - (assumed.base_W + assumed.columns_W * linear);
    move.arc = arc;
    return;
  }
  if (!offsets.axes_rigid) {
    report.fail("arc-axes", segment.place.column,
                "X Y Z of this machine are not perpendicular in the work: an arc of them is no circle",
                "program the arc with TCP on");
  }
  const LinearMap& map = space.real(rotary);
  const Vec3 centre = space.linear_from_program(segment.centre, rotary);
  const Vec3 normal = space.frame().linear() * segment.normal;
  const double mirror = map.columns_W.determinant() < 0.0 ? -1.0 : 1.0;
  move.arc = Arc{map.base_W + map.columns_W * centre, mirror * (map.columns_W * normal).normalized()};
}

/// The first way of a program that has not said its unit.
void warn_of_unit(Control& control, int column) {
  control.modal.unit_known = true;
  control.report.warn_once("units-assumed", column,
                           "the program moves here and has not said its unit (G20, G21), nor does the "
                           "machine: lengths are taken as "
                           "mm; if they are inches, everything is 25.4 times as large",
                           "write G21 or G20 at its head, or say it: units = \"mm\" or \"inch\" in the "
                           "machine's file or in [setup] "
                           "of the scene, swarf check --units");
}

/// A cut without a called length.
void tell_of_length(Control& control, int column) {
  if (tip_is_reference(control)) {
    control.report.summary.tip_positions = true;
    return;
  }
  control.report.warn_once(
      "length-not-compensated", column,
      fmt::format("the tool length compensation is off: programmed coordinates are those of the gauge "
                  "line, the tip stands {:.4f} mm further",
                  active_tool(control)->length_mm),
      fmt::format("switch it on before the cut ({}), unless the program means it so",
                  control.report.words.length_on));
}

/// A loop without an end is told long before its moves fill the memory.
void refuse_endless(Control& control, const NcMove& move, int column) {
  const auto refuse = [&](const std::string& what) {
    control.report.fail("too-many-moves", column, what + ": the program seems to loop for ever here",
                        "correct the loop, or the feed or dwell of its blocks");
  };
  if (++control.report.summary.moves > control.setup.moves_max)
    refuse(fmt::format("more than {} moves", control.setup.moves_max));
  control.path.seconds += move.duration_s + move.dwell_s;
  if (control.path.seconds > 3600.0 * kHoursMax && control.report.summary.moves > kMovesOfALoop)
    refuse(fmt::format("more than {:g} h of feeds and dwells in {} moves", kHoursMax,
                       control.report.summary.moves));
}

void send(Control& control, const Segment& segment, NcMove& move) {
  if (!control.modal.unit_known && !segment.machine) warn_of_unit(control, segment.place.column);
  move.q_from = control.path.q;
  move.rapid = segment.motion == Motion::kRapid;
  move.dwell_s = segment.dwell_s;
  move.exact_stop = segment.exact_stop;
  move.corner_tolerance_mm = segment.corner_tolerance_mm;
  move.spindle_rpm = segment.spindle_rpm;
  move.tool = control.tools.active;
  move.file = segment.place.file;
  move.line = segment.place.line;
  move.column = segment.place.column;
  if (!move.rapid && control.tools.active >= 0) {
    auto& used = control.report.summary.tools_used;
    if (used.empty() || (used.back() != control.tools.active &&
                         std::find(used.begin(), used.end(), control.tools.active) == used.end()))
      used.push_back(control.tools.active);
    if (!control.tools.length_on && control.setup.machine.gauge_M && active_tool(control)->length_mm > 0.0)
      tell_of_length(control, segment.place.column);
  }
  refuse_endless(control, move, segment.place.column);
  control.path.jumps = 0;
  control.path.q = move.q_to;
  control.path.pose = move.to;
  if (!control.report.sink.move(move)) throw ProgramStopped();
}

void emit_piece(Control& control, const Segment& segment, const Vec3& p_to,
                const std::array<double, 3>& rotary_to, double share, double angle) {
  NcMove move;
  const Vec3 linear = segment.machine ? p_to : control.space.linear_from_program(p_to, rotary_to);
  move.q_to = control.space.axis_values(linear, rotary_to);
  if (!move.q_to.allFinite()) {
    control.report.fail("out-of-range", segment.place.column,
                        "a coordinate of this block is not a finite number",
                        "write numbers that a machine can reach");
  }
  const bool arc = angle > 0.0;
  const bool stands = !arc && (move.q_to - control.path.q).cwiseAbs().maxCoeff() <= kAxesNoWay;
  if (stands && segment.dwell_s == 0.0) return;
  const double turn =
      segment.turns_rotaries ? turn_way(segment.rotary_from, rotary_to, control.modal.feed_radii_mm) : 0.0;
  move.law = segment.machine                     ? segment.law
             : control.offsets.tcp == Tcp::kOff  ? BlockLaw::kJoint
             : control.offsets.tcp == Tcp::kAxes ? BlockLaw::kTcpAxes
                                                 : BlockLaw::kTcp;
  if (turn > 0.0 && move.law != BlockLaw::kJoint && control.space.length() != 0.0 &&
      control.setup.machine.gauge_M && active_tool(control) != nullptr &&
      std::abs(active_tool(control)->length_mm - control.space.length()) > 1e-9) {
    control.report.fail(
        "tcp-length", segment.place.column,
        fmt::format("TCP turns about a tip {:.4f} mm from the gauge line, but the tool is {:.4f} mm long",
                    control.space.length(), active_tool(control)->length_mm),
        "compensate the length of the tool in the spindle");
  }
  const LinearMap& map = control.space.real(rotary_to);
  move.from = control.path.pose;
  move.to = {map.base_W + map.columns_W * linear, map.axis_W};
  if (arc) {
    place_arc(control.report, control.space, control.offsets, segment, move);
    if (move.law == BlockLaw::kJoint) move.law = BlockLaw::kTcpAxes;  // standing rotaries: the same motion
  }
  if (!stands)
    set_time(control.modal, control.offsets, segment,
             arc ? arc_way(segment, angle) : (p_to - segment.from).norm(), turn, share, move);
  send(control, segment, move);
}

}  // namespace

void emit(Control& control, const Segment& segment) {
  if (!segment.is_arc()) {
    emit_piece(control, segment, segment.to, segment.rotary_to, 1.0, 0.0);
    return;
  }
  const double last = swept(segment);
  const double whole = last + kTurn * segment.further_turns;
  Segment piece = segment;
  piece.exact_stop = false;  // whole turns go on
  const double rise = (segment.to - segment.from).dot(segment.normal);
  for (int i = 0; i < segment.further_turns; ++i) {
    const double share = kTurn / whole;
    piece.to = piece.from + share * rise * segment.normal;
    for (size_t k = 0; k < 3; ++k) {
      piece.rotary_to[k] = piece.rotary_from[k] + share * (segment.rotary_to[k] - segment.rotary_from[k]);
    }
    emit_piece(control, piece, piece.to, piece.rotary_to, share, kTurn);
    piece.from = piece.to;
    piece.rotary_from = piece.rotary_to;
    piece.dwell_s = 0.0;
  }
  piece.to = segment.to;
  piece.rotary_to = segment.rotary_to;
  piece.exact_stop = segment.exact_stop;
  emit_piece(control, piece, piece.to, piece.rotary_to, last / whole, last);
}

}  // namespace swarf::program::nc
