// Cycles that leave the axis of the hole: 202 boring, 204 back boring, 208 bore milling.
#include <fmt/format.h>

#include <cmath>

#include "base/units.h"
#include "program/heidenhain/steps.h"

namespace swarf::program::nc::heidenhain {

using nc::Motion;

namespace {

/// By which cycle 202 frees the edge from the wall (manual: a fixed way).
constexpr double kFreeMm = 0.2;
constexpr double kTurnsMax = 10000.0;

/// Q214: 1 -X, 2 -Y, 3 +X, 4 +Y of the working plane.
void free_edge(nc::Control& control, Frames& frames, int direction, double way, double feed) {
  const nc::PlaneAxes axes = nc::axes_of(control.modal.plane);
  const int axis = direction % 2 == 1 ? axes.first : axes.second;
  Vec3 to = nc::position_xyz(control);
  to[axis] += (direction <= 2 ? -way : way) * (frames.stretch.factor[axis] < 0.0 ? -1.0 : 1.0);
  straight(control, feed == kRapidFeed ? Motion::kRapid : Motion::kFeed, feed, to);
}

int disengaging_direction(nc::Control& control, const Drilling& drilling, int least) {
  const double direction = q(drilling, Q::kDisengaging);
  if (direction != std::floor(direction) || direction < least || direction > 4.0)
    control.report.fail(
        "out-of-range", 0,
        fmt::format("the disengaging direction Q214 of cycle {} is {:g}", drilling.cycle->number, direction),
        fmt::format("{} to 4: 1 is -X, 2 is -Y, 3 is +X, 4 is +Y", least));
  return static_cast<int>(direction);
}

}  // namespace

/// 202: down at Q206, dwell, the oriented edge off the wall by 0.2 mm, out at Q208 and back over the centre.
void bore(Executor& executor) {
  const int direction = disengaging_direction(executor.control, executor.drilling, 0);
  const double start = cycle_surface(executor.control, executor.drilling, executor.frames) +
                       length(executor, Q::kClearance),
               out = q(executor.drilling, Q::kFeedOut) > 0.0 ? q(executor.drilling, Q::kFeedOut)
                                                             : q(executor.drilling, Q::kFeed);
  const Vec3 centre = nc::position_xyz(executor.control);
  const int spindle = executor.control.modal.spindle;
  go(executor.control, Motion::kRapid, start, 0.0);
  go(executor.control, Motion::kFeed,
     cycle_surface(executor.control, executor.drilling, executor.frames) + length(executor, Q::kDepth),
     q(executor.drilling, Q::kFeed));
  if (q(executor.drilling, Q::kDwellBelow) > 0.0)
    nc::dwell(executor.control.report, executor.control.modal, q(executor.drilling, Q::kDwellBelow));
  executor.control.modal.spindle = 0;
  if (direction != 0) free_edge(executor.control, executor.frames, direction, kFreeMm, out);
  go(executor.control, out == kRapidFeed ? Motion::kRapid : Motion::kFeed, start, out);
  if (q(executor.drilling, Q::kSecondClearance) > q(executor.drilling, Q::kClearance))
    go(executor.control, Motion::kRapid,
       cycle_surface(executor.control, executor.drilling, executor.frames) +
           length(executor, Q::kSecondClearance),
       0.0);
  Vec3 back = centre;
  const int normal = nc::axes_of(executor.control.modal.plane).normal;
  back[normal] = nc::position_xyz(executor.control)[normal];
  straight(executor.control, Motion::kRapid, 0.0, back);
  executor.control.modal.spindle = spindle;
}

/// 204: the oriented edge beside the centre down through the bore, then on its axis up into the lower edge of
/// the material by Q249; the tip is Q252 below the edge. Out the same way.
void back_bore(Executor& executor) {
  const int direction = disengaging_direction(executor.control, executor.drilling, 1);
  for (const int above_zero :
       {Q::kCounterbore, Q::kThickness, Q::kEdgeAside, Q::kFeedPositioning, Q::kFeedCounterbore}) {
    if (!(q(executor.drilling, above_zero) > 0.0))
      executor.control.report.fail("bad-cycle", 0,
                                   fmt::format("Q{} of cycle 204 is not above zero", above_zero),
                                   "the counterbore is made upwards, from below the material");
  }
  const double start = cycle_surface(executor.control, executor.drilling, executor.frames) +
                       length(executor, Q::kClearance),
               lower = cycle_surface(executor.control, executor.drilling, executor.frames) -
                       length(executor, Q::kThickness) - length(executor, Q::kEdgeHeight);
  const double below = lower - length(executor, Q::kClearance),
               in_feed = q(executor.drilling, Q::kFeedPositioning);
  const Motion in = in_feed == kRapidFeed ? Motion::kRapid : Motion::kFeed;
  const int spindle = executor.control.modal.spindle;
  go(executor.control, Motion::kRapid, start, 0.0);
  executor.control.modal.spindle = 0;
  free_edge(executor.control, executor.frames, direction, length(executor, Q::kEdgeAside), in_feed);
  go(executor.control, in, below, in_feed);
  free_edge(executor.control, executor.frames, direction, -length(executor, Q::kEdgeAside), in_feed);
  executor.control.modal.spindle = spindle;
  go(executor.control, Motion::kFeed, lower + length(executor, Q::kCounterbore),
     q(executor.drilling, Q::kFeedCounterbore));
  if (q(executor.drilling, Q::kDwellCounterbore) > 0.0)
    nc::dwell(executor.control.report, executor.control.modal, q(executor.drilling, Q::kDwellCounterbore));
  go(executor.control, in, below, in_feed);
  executor.control.modal.spindle = 0;
  free_edge(executor.control, executor.frames, direction, length(executor, Q::kEdgeAside), in_feed);
  go(executor.control, Motion::kRapid, start, 0.0);
  if (q(executor.drilling, Q::kSecondClearance) > q(executor.drilling, Q::kClearance))
    go(executor.control, Motion::kRapid,
       cycle_surface(executor.control, executor.drilling, executor.frames) +
           length(executor, Q::kSecondClearance),
       0.0);
  free_edge(executor.control, executor.frames, direction, -length(executor, Q::kEdgeAside), kRapidFeed);
  executor.control.modal.spindle = spindle;
}

/// 208: half a circle from the centre to the wall, a helix of Q334 a turn down to the depth, a whole circle
/// there, back to the centre and out. Where on the wall the helix starts does not change the bore.
void mill_bore(Executor& executor) {
  const NcTool* tool = nc::active_tool(executor.control);
  if (tool == nullptr)
    executor.control.report.fail("compensation-no-tool", 0,
                                 "cycle 208 without a tool of the table in the spindle", "TOOL CALL 5 Z");
  const double cutter = 0.5 * tool->diameter_mm + executor.modes.delta_radius,
               radius = 0.5 * length(executor, Q::kDiameter) - cutter;
  if (radius < -1e-9)
    executor.control.report.fail("bad-cycle", 0,
                                 fmt::format("the bore of {:g} mm is narrower than the tool of {:g} mm",
                                             length(executor, Q::kDiameter), 2.0 * cutter),
                                 "take a smaller tool");
  if (q(executor.drilling, Q::kRoughDiameter) == 0.0 && length(executor, Q::kDiameter) > 4.0 * cutter + 1e-9)
    executor.control.report.fail(
        "unsupported-word", 0,
        fmt::format("the bore of {:g} mm is wider than twice the tool of {:g} mm: controls mill it in "
                    "passes that Q370 sets",
                    length(executor, Q::kDiameter), 2.0 * cutter),
        "give the diameter of the hole that is already there: Q342");
  const double start = cycle_surface(executor.control, executor.drilling, executor.frames) +
                       length(executor, Q::kClearance),
               bottom = cycle_surface(executor.control, executor.drilling, executor.frames) +
                        length(executor, Q::kDepth),
               turns = (start - bottom) / length(executor, Q::kHelixDepth);
  if (!(q(executor.drilling, Q::kHelixDepth) > 0.0 && turns <= kTurnsMax))
    executor.control.report.fail(
        "bad-cycle", 0, fmt::format("the depth per helix Q334 is {:g}", q(executor.drilling, Q::kHelixDepth)),
        "Q334=1");
  const nc::PlaneAxes axes = nc::axes_of(executor.control.modal.plane);
  if (executor.frames.stretch.turns_over(axes))
    executor.control.report.fail("unsupported-word", 0,
                                 "cycle 208 while one axis is mirrored is not supported",
                                 "end cycle 8 before the call");
  go(executor.control, Motion::kRapid, start, 0.0);
  const bool left = q(executor.drilling, Q::kMillingSense) >= 0.0;  // climb milling with M3
  const Vec3 centre = nc::position_xyz(executor.control);
  if (radius > 1e-9) {
    const Vec3 wall = centre + radius * Vec3::Unit(axes.first);
    circle_move(executor.control, q(executor.drilling, Q::kFeed), wall, 0.5 * (centre + wall), left, 0);
    const double angle = (left ? 360.0 : -360.0) * turns;
    Vec3 end = centre + Eigen::AngleAxisd(rad_from_deg(angle), Vec3::Unit(axes.normal)) * (wall - centre);
    if (turns == std::floor(turns)) end = wall;
    end[axes.normal] = bottom;
    circle_move(executor.control, q(executor.drilling, Q::kFeed), end, centre, left,
                static_cast<int>(std::ceil(turns - 1e-12)) - 1);
    circle_move(executor.control, q(executor.drilling, Q::kFeed), end, centre, left, 0);
    Vec3 middle = centre;
    middle[axes.normal] = bottom;
    straight(executor.control, Motion::kFeed, q(executor.drilling, Q::kFeed), middle);
  } else {
    go(executor.control, Motion::kFeed, bottom, q(executor.drilling, Q::kFeed));
  }
  go(executor.control, Motion::kRapid, start, 0.0);
  if (q(executor.drilling, Q::kSecondClearance) > q(executor.drilling, Q::kClearance))
    go(executor.control, Motion::kRapid,
       cycle_surface(executor.control, executor.drilling, executor.frames) +
           length(executor, Q::kSecondClearance),
       0.0);
}

}  // namespace swarf::program::nc::heidenhain
