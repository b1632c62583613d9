// Cycles that leave the axis of the hole: 202 boring, 204 back boring, 208 bore milling.
#include <fmt/format.h>

#include <cmath>

#include "base/units.h"
#include "program/heidenhain/executor.h"

namespace swarf::program::nc::heidenhain {

using nc::Motion;

namespace {

/// By which cycle 202 frees the edge from the wall (manual: a fixed way).
constexpr double kFreeMm = 0.2;
constexpr double kTurnsMax = 10000.0;

}  // namespace

/// Q214: 1 -X, 2 -Y, 3 +X, 4 +Y of the working plane.
void Executor::free_edge(int direction, double way, double feed) {
  const nc::PlaneAxes axes = nc::axes_of(control_.modal.plane);
  const int axis = direction % 2 == 1 ? axes.first : axes.second;
  Vec3 to = nc::position_xyz(control_);
  to[axis] += (direction <= 2 ? -way : way) * (stretch_.factor[axis] < 0.0 ? -1.0 : 1.0);
  straight(feed == kRapidFeed ? Motion::kRapid : Motion::kFeed, feed, to);
}

int Executor::disengaging_direction(int least) const {
  const double direction = q(214);
  if (direction != std::floor(direction) || direction < least || direction > 4.0)
    control_.report.fail(
        "out-of-range", 0,
        fmt::format("the disengaging direction Q214 of cycle {} is {:g}", cycle_->number, direction),
        fmt::format("{} to 4: 1 is -X, 2 is -Y, 3 is +X, 4 is +Y", least));
  return static_cast<int>(direction);
}

/// 202: down at Q206, dwell, the oriented edge off the wall by 0.2 mm, out at Q208 and back over the centre.
void Executor::bore() {
  const int direction = disengaging_direction(0);
  const double start = surface() + length(200), out = q(208) > 0.0 ? q(208) : q(206);
  const Vec3 centre = nc::position_xyz(control_);
  const int spindle = control_.modal.spindle;
  go(Motion::kRapid, start, 0.0);
  go(Motion::kFeed, surface() + length(201), q(206));
  if (q(211) > 0.0) nc::dwell(control_.report, control_.modal, q(211));
  control_.modal.spindle = 0;
  if (direction != 0) free_edge(direction, kFreeMm, out);
  go(out == kRapidFeed ? Motion::kRapid : Motion::kFeed, start, out);
  if (q(204) > q(200)) go(Motion::kRapid, surface() + length(204), 0.0);
  Vec3 back = centre;
  const int normal = nc::axes_of(control_.modal.plane).normal;
  back[normal] = nc::position_xyz(control_)[normal];
  straight(Motion::kRapid, 0.0, back);
  control_.modal.spindle = spindle;
}

/// 204: the oriented edge beside the centre down through the bore, then on its axis up into the lower edge of
/// the material by Q249; the tip is Q252 below the edge. Out the same way.
void Executor::back_bore() {
  const int direction = disengaging_direction(1);
  for (const int above_zero : {249, 250, 251, 253, 254}) {
    if (!(q(above_zero) > 0.0))
      control_.report.fail("bad-cycle", 0, fmt::format("Q{} of cycle 204 is not above zero", above_zero),
                           "the counterbore is made upwards, from below the material");
  }
  const double start = surface() + length(200), lower = surface() - length(250) - length(252);
  const double below = lower - length(200), in_feed = q(253);
  const Motion in = in_feed == kRapidFeed ? Motion::kRapid : Motion::kFeed;
  const int spindle = control_.modal.spindle;
  go(Motion::kRapid, start, 0.0);
  control_.modal.spindle = 0;
  free_edge(direction, length(251), in_feed);
  go(in, below, in_feed);
  free_edge(direction, -length(251), in_feed);
  control_.modal.spindle = spindle;
  go(Motion::kFeed, lower + length(249), q(254));
  if (q(255) > 0.0) nc::dwell(control_.report, control_.modal, q(255));
  go(in, below, in_feed);
  control_.modal.spindle = 0;
  free_edge(direction, length(251), in_feed);
  go(Motion::kRapid, start, 0.0);
  if (q(204) > q(200)) go(Motion::kRapid, surface() + length(204), 0.0);
  free_edge(direction, -length(251), kRapidFeed);
  control_.modal.spindle = spindle;
}

/// 208: half a circle from the centre to the wall, a helix of Q334 a turn down to the depth, a whole circle
/// there, back to the centre and out. Where on the wall the helix starts does not change the bore.
void Executor::mill_bore() {
  const NcTool* tool = nc::active_tool(control_);
  if (tool == nullptr)
    control_.report.fail("compensation-no-tool", 0, "cycle 208 without a tool of the table in the spindle",
                         "TOOL CALL 5 Z");
  const double cutter = 0.5 * tool->diameter_mm + delta_radius_, radius = 0.5 * length(335) - cutter;
  if (radius < -1e-9)
    control_.report.fail(
        "bad-cycle", 0,
        fmt::format("the bore of {:g} mm is narrower than the tool of {:g} mm", length(335), 2.0 * cutter),
        "take a smaller tool");
  if (q(342) == 0.0 && length(335) > 4.0 * cutter + 1e-9)
    control_.report.fail(
        "unsupported-word", 0,
        fmt::format("the bore of {:g} mm is wider than twice the tool of {:g} mm: controls mill it in "
                    "passes that Q370 sets",
                    length(335), 2.0 * cutter),
        "give the diameter of the hole that is already there: Q342");
  const double start = surface() + length(200), bottom = surface() + length(201),
               turns = (start - bottom) / length(334);
  if (!(q(334) > 0.0 && turns <= kTurnsMax))
    control_.report.fail("bad-cycle", 0, fmt::format("the depth per helix Q334 is {:g}", q(334)), "Q334=1");
  const nc::PlaneAxes axes = nc::axes_of(control_.modal.plane);
  if (stretch_.turns_over(axes.first, axes.second))
    control_.report.fail("unsupported-word", 0, "cycle 208 while one axis is mirrored is not supported",
                         "end cycle 8 before the call");
  go(Motion::kRapid, start, 0.0);
  const bool left = q(351) >= 0.0;  // climb milling with M3
  const Vec3 centre = nc::position_xyz(control_);
  if (radius > 1e-9) {
    const Vec3 wall = centre + radius * Vec3::Unit(axes.first);
    circle_move(q(206), wall, 0.5 * (centre + wall), left, 0);
    const double angle = (left ? 360.0 : -360.0) * turns;
    Vec3 end = centre + Eigen::AngleAxisd(rad_from_deg(angle), Vec3::Unit(axes.normal)) * (wall - centre);
    if (turns == std::floor(turns)) end = wall;
    end[axes.normal] = bottom;
    circle_move(q(206), end, centre, left, static_cast<int>(std::ceil(turns - 1e-12)) - 1);
    circle_move(q(206), end, centre, left, 0);
    Vec3 middle = centre;
    middle[axes.normal] = bottom;
    straight(Motion::kFeed, q(206), middle);
  } else {
    go(Motion::kFeed, bottom, q(206));
  }
  go(Motion::kRapid, start, 0.0);
  if (q(204) > q(200)) go(Motion::kRapid, surface() + length(204), 0.0);
}

}  // namespace swarf::program::nc::heidenhain
