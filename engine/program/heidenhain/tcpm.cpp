// M128, FUNCTION TCPM and FUNCTION PROG PATH: what the tool point and its orientation mean.
#include <fmt/format.h>

#include <cmath>

#include "base/units.h"
#include "program/heidenhain/steps.h"

namespace swarf::program::nc::heidenhain {
namespace {

/// TIP-TIP, TIP-CENTER, CENTER-CENTER: what is programmed, and about what the tool turns. Tip and centre of
/// the corner are one point where the tool has no corner radius.
void reference_point(nc::Control& control, Modes& modes, BlockReader& reader, size_t at) {
  const std::string first(reader.take_letters());
  const bool dash = reader.take_char('-');
  const std::string second(reader.take_letters());
  const auto known = [](const std::string& word) { return word == "TIP" || word == "CENTER"; };
  if (!known(first) || !dash || !known(second) || (first == "CENTER" && second == "TIP"))
    reader.fail("unknown-word", at, fmt::format("REFPNT {}-{} is no reference point", first, second),
                "REFPNT TIP-TIP");
  const NcTool* tool = nc::active_tool(control);
  const double corner = tool == nullptr ? 0.0 : tool->corner_radius_mm + modes.delta_corner;
  if (second == "CENTER" && corner != 0.0)
    reader.fail("unsupported-word", at,
                fmt::format("REFPNT {}-{} is not supported for a tool with a corner radius of {:g} mm", first,
                            second, corner),
                "post the program for the tip: REFPNT TIP-TIP");
}

/// FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS [REFPNT TIP-TIP] [F500]
void tcpm(nc::Control& control, Modes& modes, Orientation& orientation, BlockReader& reader) {
  bool spatial = false, vector = false, axis_given = false, path_given = false, feed_given = false;
  reader.done();
  const size_t start = reader.offset();
  while (!reader.done()) {
    const size_t at = reader.offset();
    const std::string word(reader.take_letters());
    if (word == "F" && (reader.take("TCP") || reader.letters() == "CONT")) {
      if (reader.take("CONT")) reader.fail("unsupported-word", at, "F CONT is not supported", "F TCP");
      feed_given = true;
    } else if (word == "F" && reader.value_follows()) {
      reader.value();  // the largest feed of compensating moves: dynamics of the machine
    } else if (word == "AXIS") {
      axis_given = true;
      spatial = reader.take("SPAT");
      if (!spatial && !reader.take("POS")) reader.fail("missing-word", at, "AXIS is POS or SPAT", "AXIS POS");
    } else if (word == "PATHCTRL") {
      path_given = true;
      vector = reader.take("VECTOR");
      if (!vector && !reader.take("AXIS"))
        reader.fail("missing-word", at, "PATHCTRL is AXIS or VECTOR", "PATHCTRL AXIS");
    } else if (word == "REFPNT") {
      reference_point(control, modes, reader, at);
    } else {
      refuse_word(reader, at, word.empty() ? std::string(1, reader.peek()) : word);
    }
  }
  if (!axis_given || !path_given || !feed_given)
    reader.fail("missing-word", start, "FUNCTION TCPM needs F, AXIS and PATHCTRL",
                "FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS");
  set_tcpm(control, orientation, true, vector, spatial, true);
}

}  // namespace

void set_tcpm(nc::Control& control, Orientation& orientation, bool on, bool by_vector, bool spatial,
              bool chosen) {
  if (!on && !orientation.tcpm) return;
  if (on && orientation.compensates_heads)
    control.report.fail("words-conflict", 0, "M128 or FUNCTION TCPM while M114 or M144 is on",
                        "write M115 or M145 before it");
  orientation.tcpm = on;
  orientation.spatial = on && spatial;
  orientation.path_chosen = on && chosen;
  nc::set_tcp(control, !on ? nc::Tcp::kOff : by_vector ? nc::Tcp::kVector : nc::Tcp::kAxes);
  if (!on && orientation.tilted) nc::set_coordinates(control, nc::Coordinates::kWork);
}

/// How the next block turns the tool, unless PATHCTRL says it for all.
void turn_by(nc::Control& control, Orientation& orientation, nc::Tcp law) {
  if (orientation.tcpm && !orientation.path_chosen && control.offsets.tcp != law) nc::set_tcp(control, law);
}

/// FUNCTION TCPM ..., FUNCTION RESET TCPM, FUNCTION PROG PATH ...
void function_word(nc::Control& control, Modes& modes, Orientation& orientation, BlockReader& reader,
                   size_t start) {
  if (reader.take("TCPM")) return tcpm(control, modes, orientation, reader);
  if (reader.take("RESET")) {
    if (!reader.take("TCPM"))
      reader.fail("unsupported-word", start, "of FUNCTION RESET, only TCPM is supported",
                  "FUNCTION RESET TCPM");
    reader.expect_end();
    return set_tcpm(control, orientation, false, false, false, false);
  }
  if (reader.take("PROG") && reader.take("PATH")) {
    if (reader.take("OFF")) {
      orientation.path_is_contour = false;
    } else if (reader.take("IS") && reader.take("CONTOUR")) {
      orientation.path_is_contour = true;
    } else {
      reader.fail("unknown-word", start, "FUNCTION PROG PATH IS CONTOUR or OFF",
                  "FUNCTION PROG PATH IS CONTOUR");
    }
    return reader.expect_end();
  }
  if (reader.take("MODE")) {
    if (reader.take("MILL")) {
      control.report.without_effect("FUNCTION MODE MILL");
      return reader.expect_end();
    }
    reader.fail("unsupported-word", start, "FUNCTION MODE other than MILL is not supported",
                "FUNCTION MODE MILL");
  }
  const std::string word(reader.take_letters());
  reader.fail("unsupported-word", start, fmt::format("FUNCTION {} is not supported", word),
              "FUNCTION TCPM is");
}

/// M114, M144: X Y Z are those of the tip, with the heads as they stand at the end of each block; the way to
/// there is that of the axes. The manual defines this for swivelling heads.
void compensate_heads(nc::Control& control, Orientation& orientation, BlockReader& reader, size_t offset,
                      bool on) {
  if (on == orientation.compensates_heads) return;
  for (const kinematics::Axis& axis : control.setup.machine.axes) {
    if (on && axis.kind == kinematics::AxisKind::kRotary && axis.side != kinematics::Side::kHead)
      reader.fail(
          "unsupported-word", offset,
          fmt::format("M114 and M144 are supported with swivelling heads, and {} turns the table", axis.name),
          "M128 keeps the tip on the part");
  }
  if (on && (orientation.tcpm || orientation.tilted))
    reader.fail("words-conflict", offset, "M114 or M144 in a tilted plane, or with M128 on",
                "use one of them");
  orientation.compensates_heads = on;
  if (!orientation.tcpm && !orientation.tilted)
    nc::set_coordinates(control, on ? nc::Coordinates::kWork : nc::Coordinates::kAxes);
}

/// The feed as the control counts it. With M116, F counts mm a minute on the circles that the tip describes
/// on rotary tables; their radii are those at the start of the block.
double rotary_feed(nc::Control& control, const Modes& modes, const Orientation& orientation,
                   const Element& element) {
  const bool turns = (element.target.given & 0x38u) != 0;
  if (!modes.rotary_feed_mm || !turns || orientation.tcpm || !control.path.started ||
      control.modal.feed_mode != nc::FeedMode::kPerMinute)
    return element.feed;
  const kinematics::MachineModel machine =
      kinematics::with_tool(control.setup.machine, control.space.length());
  const kinematics::AxisValues& q = control.path.q;
  const Vec3 tip_W = kinematics::forward(machine, q).tip_W;
  double degrees_squared = 0.0, way_squared = (element.to - element.from).squaredNorm();
  const double linear_squared = way_squared;
  for (int slot = 0; slot < 3; ++slot) {
    const int axis = control.space.axis_of(static_cast<nc::AxisWord>(slot + 3));
    if (!element.target.has(slot + 3) || axis < 0) continue;
    const double value = element.target.value[static_cast<size_t>(slot) + 3];
    const double now = q[axis] - control.space.rotary_zero(slot);
    double turn = element.target.is_incremental(slot + 3) ? value : value - now;
    if (element.target.way[static_cast<size_t>(slot)] == nc::RotaryWay::kShortest)
      turn = std::remainder(turn, 2.0 * kPi);
    kinematics::AxisValues opposite = q;
    opposite[axis] += kPi;
    const double radius = 0.5 * (kinematics::forward(machine, opposite).tip_W - tip_W).norm();
    degrees_squared += std::pow(deg_from_rad(turn), 2);
    way_squared += std::pow(radius * turn, 2);
  }
  if (degrees_squared == 0.0) return element.feed;
  if (!(way_squared > 1e-18))
    control.report.fail("bad-feed", 0,
                        "M116 counts the feed on a circle, and the tip stands on the rotary axis",
                        "M117, and F in degrees a minute");
  // Degrees alone are counted without the unit of the program.
  const double unit = linear_squared == 0.0 && control.modal.inches() ? 2.54 : 1.0;
  return unit * element.feed * std::sqrt((linear_squared + degrees_squared) / way_squared);
}

}  // namespace swarf::program::nc::heidenhain
