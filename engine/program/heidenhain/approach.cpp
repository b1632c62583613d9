// APPR and DEP: onto the contour and away from it.
//
//      PS .                                 PS, PN: where the tool stands before and after, R0
//          `.  H                            A, E:   first and last contour point, a cutter radius aside with
//            +-----.                                RL and RR; t the contour's direction there, n the side of
//        arc  \     contour                         the cutter across it
//               A---------> t
//
//   LT   H = A - LEN t, straight along the contour
//   LN   H = A + LEN n, straight across it
//   CT   an arc that ends in A along t, of radius R about A + R n, through the angle CCA; R < 0: about the
//        other side
//   LCT  the arc of radius R about A + R n, and the straight line from PS that touches it
//
// and the same backwards from E. R is the radius of the cutter centre's path: the manual's own examples have
// arcs smaller than the cutter. The tool axis moves in PH (APPR) and in PN (DEP), where the block has it.
#include <fmt/format.h>

#include <cmath>

#include "base/units.h"
#include "program/heidenhain/steps.h"

namespace swarf::program::nc::heidenhain {

using nc::Compensation;

using nc::Motion;

namespace {

constexpr double kNoWay = 1e-9;

/// Across t, to the side on which the cutter goes.
Vec3 across(const nc::PlaneAxes& axes, const Vec3& t, Compensation side) {
  const Vec3 left = Vec3::Unit(axes.normal).cross(t);
  return side == Compensation::kLeft ? left : Vec3(-left);
}

Vec3 flat(const nc::PlaneAxes& axes, Vec3 v) {
  v[axes.normal] = 0.0;
  return v;
}

/// Where the straight way from a point in the plane touches a circle that it then goes round; none from
/// within. `arriving` false: where the circle is left towards the point.
std::optional<Vec3> touch(const nc::PlaneAxes& axes, const Vec3& point, const Vec3& centre, double radius,
                          bool counter_clockwise, bool arriving) {
  const Vec3 out = flat(axes, point - centre);
  const double distance = out.norm();
  if (!(distance > radius)) return std::nullopt;
  const Vec3 u = out / distance, v = Vec3::Unit(axes.normal).cross(u);
  const double c = radius / distance, s = std::sqrt(1.0 - c * c);
  return flat(axes, centre) + radius * (c * u + (counter_clockwise == arriving ? s : -s) * v);
}

/// First direction of a piece of contour in the plane.
std::optional<Vec3> start_direction(const nc::PlaneAxes& axes, Motion motion, const nc::ArcWords& arc,
                                    const Vec3& from, const Vec3& to) {
  Vec3 along = flat(axes, to - from);
  if (arc.centre) {
    along = Vec3::Unit(axes.normal).cross(flat(axes, from - *arc.centre));
    if (motion == Motion::kClockwise) along = -along;
  }
  if (!(along.norm() > kNoWay)) return std::nullopt;
  return along.normalized();
}

void round(nc::Control& control, Motion motion, double feed, const Vec3& to, const Vec3& centre,
           bool counter_clockwise) {
  if ((to - nc::position_xyz(control)).norm() <= kNoWay) return;
  if (motion == Motion::kRapid)
    control.report.fail("unexpected-word", 0, "an arc is not moved at FMAX", "write F with a value");
  circle_move(control, feed, to, centre, counter_clockwise, 0);
}

/// LEN, CCA and R, as the kind wants them.
void check_approach(BlockReader& reader, const std::string& kind, const MotionWords& words, size_t start) {
  const bool line = kind == "LT" || kind == "LN", arc = kind == "CT";
  const auto need = [&](const Amount& word, bool wanted, const char* name, const char* fix) {
    if (word && !wanted)
      reader.fail("unexpected-word", word.offset, fmt::format("{} does not belong to {}", name, kind),
                  "take it out");
    if (!word && wanted) reader.fail("missing-word", start, fmt::format("{} has no {}", kind, name), fix);
  };
  need(words.length, line, "LEN", "LEN15");
  need(words.radius, !line, "R", "R10");
  need(words.angle, arc, "CCA", "CCA90");
  if (line && !(words.length.value > 0.0))
    reader.fail("out-of-range", words.length.offset, "LEN is not above zero", "LEN15");
  if (arc && !(words.angle.value > 0.0 && words.angle.value <= 360.0))
    reader.fail("out-of-range", words.angle.offset, "CCA is between 0 and 360 degrees", "CCA90");
  if (!line && !(arc ? words.radius.value != 0.0 : words.radius.value > 0.0))
    reader.fail("out-of-range", words.radius.offset, arc ? "R is zero" : "R is not above zero", "R10");
  if (words.any_rotary())
    reader.fail("unsupported-word", start, "rotary axes in APPR and DEP are not supported",
                "turn them in a block before it");
}

}  // namespace

void straight(nc::Control& control, Motion motion, double feed, const Vec3& to) {
  if (motion == Motion::kFeed && feed > 0.0) set_feed(control, feed, false);
  nc::Target target;
  target.column = control.report.place.column;
  for (int i = 0; i < 3; ++i) target.set(i, to[i], false);
  nc::line(control, motion, target);
}

void circle_move(nc::Control& control, double feed, const Vec3& to, const Vec3& centre,
                 bool counter_clockwise, int further_turns) {
  if (feed > 0.0) set_feed(control, feed, false);
  nc::Target target;
  target.column = control.report.place.column;
  for (int i = 0; i < 3; ++i) target.set(i, to[i], false);
  nc::ArcWords arc;
  arc.centre = centre;
  arc.further_turns = further_turns;
  arc.column = target.column;
  nc::arc(control, counter_clockwise ? Motion::kCounterClockwise : Motion::kClockwise, target, arc);
}

/// APPR LT X+20 Y+20 Z-10 LEN15 RR F100; LN; CT .. CCA180 R10; LCT .. R10; with a P before: PR and PA.
void approach(Executor& executor, BlockReader& reader, size_t start) {
  no_open_corner(executor.path, reader, start);
  std::string kind(reader.take_letters());
  const bool by_pole = kind.starts_with('P');
  if (by_pole) kind.erase(0, 1);
  if (kind != "LT" && kind != "LN" && kind != "CT" && kind != "LCT")
    refuse_word(reader, start, "APPR " + kind);
  const MotionWords words = read_motion_words(
      reader, kAxesAllowed | kRadiusAllowed | kApproachAllowed | kAlways | (by_pole ? kPolarAllowed : 0u));
  check_approach(reader, kind, words, start);
  if (executor.control.contour.side() != Compensation::kOff)
    reader.fail("compensation-active", start, "APPR while RL or RR is already on",
                "write DEP or R0 before it");
  const nc::PlaneAxes axes = nc::axes_of(executor.control.modal.plane);
  Approach next;
  next.kind = kind;
  next.place = executor.control.report.place;
  next.side = side_of(executor.control, executor.frames, words.compensation.value_or(Compensation::kOff));
  if (next.side == Compensation::kOff && kind != "LT")
    reader.fail("missing-word", start,
                fmt::format("APPR {} needs RL or RR: they say to which side it turns", kind),
                "write RL or RR");
  const double scale = plane_scale(executor.control, executor.frames, reader, start);
  next.length = scale * executor.control.modal.mm(words.length.value);
  next.radius = scale * executor.control.modal.mm(words.radius.value);
  next.angle = rad_from_deg(words.angle.value);
  next.entry = executor.modes.last_rapid ? Motion::kRapid : Motion::kFeed;
  next.entry_feed = executor.modes.feed;
  next.feed = feed_of(executor.control, executor.modes, reader, words, next.motion);
  // LCT goes to its arc at the feed of its own block, the others at what held before.
  if (kind == "LCT") next.entry = next.motion, next.entry_feed = next.feed;
  nc::Target target = target_of(executor.control, executor.modes, executor.frames, reader, words);
  if (by_pole) {
    const Vec3 end = polar_end(executor.control, executor.path, executor.frames, reader, words, start);
    target.set(axes.first, end[axes.first], false);
    target.set(axes.second, end[axes.second], false);
  }
  next.contour = end_of(executor.control, executor.path, target);
  if (!executor.control.path.started || !next.contour.allFinite())
    reader.fail("start-unknown", start, "APPR starts, and the position is not known yet",
                "position all axes before it");
  if (next.side != Compensation::kOff) next.cutter = cutter_radius(executor.control, executor.modes, reader);
  functions_before(executor, reader, words);
  functions_after(executor, reader, words.functions);
  executor.path.approach = next;
}

void close_approach(nc::Control& control, PathState& path, const Element& first) {
  const Approach here = *path.approach;
  path.approach.reset();
  const nc::Place place = control.report.place;
  control.report.at(here.place.file, here.place.line, here.place.column);
  const nc::PlaneAxes axes = nc::axes_of(control.modal.plane);
  const auto t = start_direction(axes, first.motion, first.arc, first.from, first.to);
  if (!t)
    control.report.fail("bad-approach", 0,
                        "the first piece of contour behind APPR has no way in the working plane",
                        "write a piece of contour in the plane right behind APPR");
  const bool on = here.side != Compensation::kOff;
  const Vec3 n = across(axes, *t, here.side), start = nc::position_xyz(control);
  const double radius = here.cutter;
  const Vec3 A = here.contour + radius * n, centre = A + here.radius * n;
  const bool counter_clockwise = (here.side == Compensation::kLeft) == (here.radius > 0.0);
  Vec3 H = here.kind == "LT" ? Vec3(A - here.length * *t) : Vec3(A + here.length * n);
  if (here.kind == "CT") {
    const Eigen::AngleAxisd back(counter_clockwise ? -here.angle : here.angle, Vec3::Unit(axes.normal));
    H = centre + back * (A - centre);
  } else if (here.kind == "LCT") {
    const auto found = touch(axes, start, centre, here.radius, counter_clockwise, true);
    if (!found)
      control.report.fail(
          "bad-approach", 0,
          fmt::format("the tool stands {:.4f} mm from the centre of the arc of radius {:.4f} mm: no "
                      "straight line from there touches it",
                      flat(axes, start - centre).norm(), here.radius),
          "start further away, or make R smaller");
    H = *found;
  }
  H[axes.normal] = start[axes.normal];
  straight(control, here.entry, here.entry_feed, H);
  H[axes.normal] = A[axes.normal];
  straight(control, here.entry, here.entry_feed, H);
  if (here.kind == "LT" || here.kind == "LN") {
    straight(control, here.motion, here.feed, A);
  } else {
    round(control, here.motion, here.feed, A, centre, counter_clockwise);
  }
  if (on) nc::enter_compensation(control, here.side, radius, here.contour);
  control.report.at(place.file, place.line, place.column);
}

/// DEP LT LEN12 F100, DEP LN LEN12, DEP CT CCA90 R8, DEP LCT X+10 Y+12 R8, DEP PLCT PR+20 PA+0 R8.
void depart(Executor& executor, BlockReader& reader, size_t start) {
  no_open_corner(executor.path, reader, start);
  const std::string written(reader.take_letters());
  const std::string kind = written == "PLCT" ? "LCT" : written;
  if (kind != "LT" && kind != "LN" && kind != "CT" && kind != "LCT")
    refuse_word(reader, start, "DEP " + kind);
  const MotionWords words = read_motion_words(reader, kAxesAllowed | kRadiusAllowed | kApproachAllowed |
                                                          kAlways | (written == "PLCT" ? kPolarAllowed : 0u));
  check_approach(reader, kind, words, start);
  const nc::PlaneAxes axes = nc::axes_of(executor.control.modal.plane);
  const auto in_plane = [&](int i) { return words.axes[static_cast<size_t>(i)].given; };
  if (kind != "LCT" && (in_plane(axes.first) || in_plane(axes.second)))
    reader.fail("unexpected-word", start, fmt::format("DEP {} has no end of its own in the plane", kind),
                "take the coordinates out");
  if (words.compensation.value_or(Compensation::kOff) != Compensation::kOff)
    reader.fail("words-conflict", start, "DEP ends RL and RR", "take it out");
  const Compensation side = executor.control.contour.side();
  if (side == Compensation::kOff && kind != "LT")
    reader.fail("missing-word", start,
                fmt::format("DEP {} needs RL or RR before it: they say to which side it turns", kind),
                "write RL or RR in the APPR block");
  if (!executor.path.tangent)
    reader.fail("bad-approach", start, "DEP follows no piece of contour", "write it behind L, C, CR or CP");
  const double scale = plane_scale(executor.control, executor.frames, reader, start);
  const double length = scale * executor.control.modal.mm(words.length.value),
               R = scale * executor.control.modal.mm(words.radius.value);
  const Vec3 t = *executor.path.tangent, n = across(axes, t, side),
             programmed = present(executor.control, executor.path);
  Motion motion = Motion::kFeed;
  const double feed = feed_of(executor.control, executor.modes, reader, words, motion);
  const nc::Target target = target_of(executor.control, executor.modes, executor.frames, reader, words);
  Vec3 N = end_of(executor.control, executor.path, target);
  if (written == "PLCT")
    N = polar_end(executor.control, executor.path, executor.frames, reader, words, start);
  functions_before(executor, reader, words);
  nc::set_compensation(executor.control, Compensation::kOff, 0.0, 0);
  nc::flush(executor.control);
  const Vec3 E = nc::position_xyz(executor.control), centre = E + R * n;
  const bool counter_clockwise = (side == Compensation::kLeft) == (R > 0.0);
  if (kind == "LT" || kind == "LN") {
    straight(executor.control, motion, feed, kind == "LT" ? Vec3(E + length * t) : Vec3(E + length * n));
  } else if (kind == "CT") {
    const double angle = rad_from_deg(words.angle.value);
    const Eigen::AngleAxisd on(counter_clockwise ? angle : -angle, Vec3::Unit(axes.normal));
    round(executor.control, motion, feed, centre + on * (E - centre), centre, counter_clockwise);
  } else {
    const auto found = touch(axes, N, centre, R, counter_clockwise, false);
    if (!found)
      reader.fail(
          "bad-approach", start,
          fmt::format("the end of DEP lies {:.4f} mm from the centre of the arc of radius {:.4f} mm: no "
                      "straight line touches it",
                      flat(axes, N - centre).norm(), R),
          "end further away, or make R smaller");
    Vec3 H = *found;
    H[axes.normal] = E[axes.normal];
    round(executor.control, motion, feed, H, centre, counter_clockwise);
    Vec3 end = N;
    end[axes.normal] = E[axes.normal];
    straight(executor.control, motion, feed, end);
  }
  if (in_plane(axes.normal)) {
    Vec3 end = nc::position_xyz(executor.control);
    const auto normal = static_cast<size_t>(axes.normal);
    end[axes.normal] = target.is_incremental(axes.normal) ? programmed[axes.normal] + target.value[normal]
                                                          : target.value[normal];
    straight(executor.control, motion, feed, end);
  }
  executor.path.tangent.reset();
  finish_motion(executor, reader, words);
}

}  // namespace swarf::program::nc::heidenhain
