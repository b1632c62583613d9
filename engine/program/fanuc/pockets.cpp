// Circular pockets (G12, G13) and holes in patterns, which the 30i has not and controls derived from it have.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "program/fanuc/steps.h"

namespace swarf::program::nc::fanuc {
namespace {

/// A pocket in XY, mm. The radii are those of the wall.
struct Pocket {
  double first = 0.0, last = 0.0, step = 0.0;
  double cutter = 0.0;  ///< radius by which the tool's centre stays away from the wall
  bool clockwise = false;
};

/// Radius of D, or of the D that stood last.
double pocket_cutter(Fanuc& fanuc) {
  if (fanuc.block.has('D')) return tool_value(fanuc.modes, fanuc.zero, fanuc, 'D', false);
  const int number = fanuc.modes.d_number, at = fanuc.g_column(kFanucOneShot);
  if (number == 0)
    fanuc.control.report.fail("missing-word", at, "the pocket has no D, and none stood before it",
                              "add D with the tool's number; D0 moves the tool's centre on the circle");
  return tool_offset(fanuc.zero, fanuc, number, 2, at) + tool_offset(fanuc.zero, fanuc, number, 3, at);
}

Pocket pocket_of(Fanuc& fanuc, bool clockwise) {
  const std::string name = fanuc.g_name(kFanucOneShot);
  const auto mm = [&](char letter) { return fanuc.control.modal.mm(fanuc.block.get(letter)); };
  fanuc.need('I', name.c_str());
  Pocket pocket;
  pocket.clockwise = clockwise;
  pocket.cutter = pocket_cutter(fanuc);
  pocket.first = pocket.last = mm('I');
  if (fanuc.block.has('K') != fanuc.block.has('Q'))
    fanuc.control.report.fail("missing-word", fanuc.column(fanuc.block.has('K') ? 'K' : 'Q'),
                              fmt::format("K and Q of {} stand together", name),
                              "write the finished radius K with the step Q, or the radius I alone");
  if (fanuc.block.has('K')) pocket.last = mm('K'), pocket.step = mm('Q');
  if (!(pocket.first > pocket.cutter) || pocket.last < pocket.first)
    fanuc.control.report.fail(
        "bad-pocket", fanuc.column('I'),
        fmt::format("a cutter of radius {:g} mm cannot go round in radius {:g} mm and out to "
                    "{:g} mm",
                    pocket.cutter, pocket.first, pocket.last),
        "I must be larger than the cutter's radius, and K not below I");
  if (fanuc.block.has('Q') && !(pocket.step > 0.0))
    fanuc.control.report.fail("out-of-range", fanuc.column('Q'),
                              fmt::format("Q {:g} is no step", pocket.step), "write Q above zero");
  return pocket;
}

/// What the circles leave standing depends on the half circles that lead from one to the next, whose side no
/// manual gives.
void warn_of_rests(Fanuc& fanuc, const Pocket& pocket) {
  const NcTool* tool = nc::active_tool(fanuc.control);
  const double width = tool != nullptr ? tool->diameter_mm : 2.0 * pocket.cutter;
  if (pocket.first - pocket.cutter <= 0.5 * width && pocket.step <= width) return;
  fanuc.control.report.warn_once(
      "pocket-rests", fanuc.g_column(kFanucOneShot),
      fmt::format(
          "the circles of {} leave a core or rings standing: where the half circles between them cut through "
          "these is not published (here they begin at X+)",
          fanuc.g_name(kFanucOneShot)),
      "write I not above the cutter's diameter and Q below it");
}

void arc_to(Fanuc& fanuc, const Pocket& pocket, const Vec2& to, const Vec2& centre) {
  Target target;
  target.column = fanuc.g_column(kFanucOneShot);
  target.set(kX, to.x(), false);
  target.set(kY, to.y(), false);
  ArcWords words;
  words.column = target.column;
  words.centre = Vec3(centre.x(), centre.y(), 0.0);
  nc::arc(fanuc.control, pocket.clockwise ? Motion::kClockwise : Motion::kCounterClockwise, target, words);
}

/// Each circle begins where a half circle meets it without a corner: from the centre to X+, from there to X-
/// of the next circle, and so on; the last half circle ends in the centre. None leaves its circle.
void mill(Fanuc& fanuc, const Pocket& pocket, const Vec2& centre) {
  Vec2 at = centre;
  double side = 1.0;
  for (double wall = pocket.first;; wall = std::min(wall + pocket.step, pocket.last), side = -side) {
    const Vec2 start(centre.x() + side * (wall - pocket.cutter), centre.y());
    arc_to(fanuc, pocket, start, 0.5 * (at + start));
    arc_to(fanuc, pocket, start, centre);
    at = start;
    if (wall >= pocket.last) break;
  }
  arc_to(fanuc, pocket, centre, 0.5 * (at + centre));
}

void check_pocket(Fanuc& fanuc) {
  const int at = fanuc.g_column(kFanucOneShot);
  const std::string name = fanuc.g_name(kFanucOneShot);
  if (fanuc.control.modal.plane != Plane::kXY)
    fanuc.control.report.fail("unsupported-word", at, name + " is read in G17 only", "write G17 before it");
  if (fanuc.control.contour.side() != Compensation::kOff || fanuc.modes.cycle != G::kCycleOff)
    fanuc.control.report.fail("modal-conflict", at,
                              name + " stands while cutter compensation or a canned cycle is on",
                              "write G40 and G80 before it");
  const Target written = target_of(fanuc.block, fanuc.modes.incremental, fanuc.reader, fanuc.control);
  const Vec3 here = nc::position_xyz(fanuc.control);
  for (const int i : {0, 1}) {
    const double there = written.value[static_cast<size_t>(i)] + (written.is_incremental(i) ? here[i] : 0.0);
    if (written.has(i) && !(std::abs(there - here[i]) <= 1e-9))
      fanuc.control.report.fail(
          "unsupported-word", written.column,
          fmt::format("the centre of {} lies elsewhere: whether the tool goes there at feed or "
                      "rapid is not published",
                      name),
          "move to the centre in the block before it");
  }
}

}  // namespace

void circular_pocket(Fanuc& fanuc, bool clockwise) {
  check_pocket(fanuc);
  const Pocket pocket = pocket_of(fanuc, clockwise);
  const int times = fanuc.block.has('L') ? whole(fanuc.block, 'L', 1, 9999, fanuc.reader, fanuc.control) : 1;
  if (times > 1 && !fanuc.modes.incremental)
    fanuc.control.report.fail("modal-conflict", fanuc.column('L'), "L repeats one depth under G90",
                              "write Z of each step under G91");
  warn_of_rests(fanuc, pocket);
  const Vec3 here = nc::position_xyz(fanuc.control);
  if (!here.allFinite())
    fanuc.control.report.fail("start-unknown", fanuc.g_column(kFanucOneShot),
                              "the pocket lies about the present position, which is not known yet",
                              "move to its centre before it");
  fanuc.modes.moved = true;
  for (int i = 0; i < times; ++i) {
    Target down;
    down.column = fanuc.g_column(kFanucOneShot);
    if (fanuc.block.has('Z')) {
      down.set(kZ, fanuc.control.modal.mm(fanuc.block.get('Z')), fanuc.modes.incremental);
      nc::line(fanuc.control, Motion::kFeed, down);
    }
    mill(fanuc, pocket, here.head<2>());
  }
}

std::vector<Vec2> holes_on_circle(const Vec2& centre, double radius_mm, double start_deg, double step_deg,
                                  int count) {
  std::vector<Vec2> holes;
  std::string why;
  for (int i = 0; i < count; ++i) {
    const double angle = start_deg + step_deg * i;
    holes.push_back(centre + radius_mm * Vec2(*nc::apply(Function::kCos, angle, why),
                                              *nc::apply(Function::kSin, angle, why)));
  }
  return holes;
}

std::vector<Vec2> holes_on_line(const Vec2& first, double distance_mm, double angle_deg, int count) {
  std::string why;
  const Vec2 along(*nc::apply(Function::kCos, angle_deg, why), *nc::apply(Function::kSin, angle_deg, why));
  std::vector<Vec2> holes;
  for (int i = 0; i < count; ++i) holes.push_back(first + distance_mm * i * along);
  return holes;
}

Vec2 pattern_place(Fanuc& fanuc) {
  const Target written = target_of(fanuc.block, fanuc.modes.incremental, fanuc.reader, fanuc.control);
  if (fanuc.control.modal.plane != Plane::kXY)
    fanuc.control.report.fail("unsupported-word", fanuc.g_column(kFanucOneShot),
                              fanuc.g_name(kFanucOneShot) + " is read in G17 only", "write G17 before it");
  Vec2 place = nc::position_xyz(fanuc.control).head<2>();
  for (const int i : {0, 1}) {
    const double value = written.value[static_cast<size_t>(i)];
    if (written.has(i)) place[i] = written.is_incremental(i) ? place[i] + value : value;
  }
  return place;
}

}  // namespace swarf::program::nc::fanuc
