// LP, CC, C, CR, CT and CP of Heidenhain programs.
#include <fmt/format.h>

#include <cmath>

#include "base/angles.h"
#include "base/units.h"
#include "program/heidenhain/steps.h"
#include "program/letters/arithmetic.h"

namespace swarf::program::nc::heidenhain {

using nc::Motion;

namespace {

constexpr double kRadiusTolerance = 0.016;

/// The point at an angle in degrees about the origin, in the plane; exact at multiples of 90 degrees.
Vec3 polar(const nc::PlaneAxes& axes, double radius, double angle_deg) {
  Vec3 p = Vec3::Zero();
  p[axes.first] = radius * cos_deg(angle_deg);
  p[axes.second] = radius * sin_deg(angle_deg);
  return p;
}

/// +1 counter-clockwise, -1 clockwise in the control's frame.
int sense(nc::Control& control, Frames& frames, BlockReader& reader, const MotionWords& words, size_t start) {
  if (words.sense == 0)
    reader.fail("missing-word", start, "the arc has no DR", "DR+ turns counter-clockwise, DR- clockwise");
  const nc::PlaneAxes axes = nc::axes_of(control.modal.plane);
  plane_scale(control, frames, reader, start);
  return frames.stretch.turns_over(axes) ? -words.sense : words.sense;
}

/// The way from the pole to a point at this radius and angle, as it lies in the control's frame.
Vec3 from_pole(nc::Control& control, const Frames& frames, double radius_mm, double angle_deg) {
  return frames.stretch.factor.cwiseProduct(polar(nc::axes_of(control.modal.plane), radius_mm, angle_deg));
}

void refuse_height(BlockReader& reader, const MotionWords& words, int normal) {
  const Amount& word = words.axes[static_cast<size_t>(normal)];
  if (word)
    reader.fail("unsupported-word", word.offset,
                fmt::format("{} leaves the plane of this arc", nc::kAxisLetters[normal]),
                "helices are programmed with CP and IPA");
}

/// Arcs move in the working plane.
void only_plane(nc::Control& control, BlockReader& reader, const MotionWords& words) {
  refuse_height(reader, words, nc::axes_of(control.modal.plane).normal);
}

const Vec3& centre(PathState& path, BlockReader& reader, size_t offset) {
  if (!path.centre) reader.fail("missing-centre", offset, "there is no CC before this block", "CC X+10 Y+20");
  if (path.centre_normal)
    reader.fail("unsupported-word", offset, "the last CC lies across the working plane: only C goes about it",
                "CC with both axes of the working plane");
  return *path.centre;
}

/// CC X+10 Z-5 with the tool axis Z: the axis that it leaves out, across the plane of its circle.
int normal_of_pole(const nc::PlaneAxes& axes, const Frames& frames, BlockReader& reader,
                   const MotionWords& words, size_t start) {
  const bool first = static_cast<bool>(words.axes[static_cast<size_t>(axes.first)]);
  const bool second = static_cast<bool>(words.axes[static_cast<size_t>(axes.second)]);
  if (first == second)
    reader.fail("unexpected-word", start, "a pole has two coordinates", "CC X+10 Y+20, or CC X+10 Z-5");
  if (!frames.stretch.none())
    reader.fail("unsupported-word", start,
                "a circle across the working plane while mirror images or scalings are on is not supported",
                "end them before it");
  return first ? axes.second : axes.first;
}

/// C about a CC across the working plane; counter-clockwise seen against the axis that is left out.
void circle_across(Executor& executor, BlockReader& reader, const MotionWords& words, size_t start) {
  const int normal = *executor.path.centre_normal;
  refuse_height(reader, words, normal);
  if (executor.control.contour.side() != nc::Compensation::kOff ||
      (words.compensation && *words.compensation != nc::Compensation::kOff))
    reader.fail("compensation-plane", start, "RL or RR at a circle across the working plane", "write R0");
  if (words.sense == 0)
    reader.fail("missing-word", start, "the arc has no DR", "DR+ turns counter-clockwise, DR- clockwise");
  Element element;
  element.offset = start;
  element.motion = words.sense > 0 ? Motion::kCounterClockwise : Motion::kClockwise;
  element.target = target_of(executor.control, executor.modes, executor.frames, reader, words);
  if (!words.any_linear()) reader.fail("missing-word", start, "C has no end", "C X+10 Z+20 DR+");
  element.arc.centre = executor.path.centre;
  element.arc.normal = Vec3::Unit(normal);
  element.arc.column = executor.control.report.place.column;
  element.arc.radius_tolerance_mm = kRadiusTolerance;
  move(executor, reader, words, element);
}

}  // namespace

/// Where PR and PA, which are modal, lead about the pole CC.
Vec3 polar_end(nc::Control& control, PathState& path, Frames& frames, BlockReader& reader,
               const MotionWords& words, size_t start) {
  const nc::PlaneAxes axes = nc::axes_of(control.modal.plane);
  if (words.any_rotary() || words.axes[static_cast<size_t>(axes.first)] ||
      words.axes[static_cast<size_t>(axes.second)])
    reader.fail("unexpected-word", start, "a polar end is given by PR, PA and the height alone",
                "LP PR+20 PA+30 Z-5");
  const Vec3 about = centre(path, reader, start);
  for (const auto& [word, kept, factor] :
       {std::tuple{&words.polar_radius, &path.polar_radius, control.modal.mm(1.0)},
        std::tuple{&words.polar_angle, &path.polar_angle, 1.0}}) {
    if (!*word) continue;
    if (word->incremental && !kept->given)
      reader.fail("missing-word", word->offset, "an incremental polar word follows no absolute one",
                  "write PR and PA first");
    *kept = {(word->incremental ? kept->value : 0.0) + factor * word->value, word->offset, true, false};
  }
  if (!path.polar_radius || !path.polar_angle)
    reader.fail("missing-word", start, "a polar end needs PR and PA", "LP PR+20 PA+30");
  return about + from_pole(control, frames, path.polar_radius.value, path.polar_angle.value);
}

/// LP PR+20 IPA+30: about the pole CC.
void polar_line(Executor& executor, BlockReader& reader, size_t start) {
  const MotionWords words = read_motion_words(reader, kAxesAllowed | kPolarAllowed | kAlways);
  const nc::PlaneAxes axes = nc::axes_of(executor.control.modal.plane);
  const Vec3 end = polar_end(executor.control, executor.path, executor.frames, reader, words, start);
  Element element;
  element.offset = start;
  element.target = target_of(executor.control, executor.modes, executor.frames, reader, words);
  element.target.set(axes.first, end[axes.first], false);
  element.target.set(axes.second, end[axes.second], false);
  move(executor, reader, words, element);
}

/// CC X+10 Y+20, CC IX+5, or CC alone: the last position.
void pole(nc::Control& control, PathState& path, Frames& frames, BlockReader& reader) {
  const size_t start = reader.offset();
  const MotionWords words = read_motion_words(reader, kAxesAllowed);
  const nc::PlaneAxes axes = nc::axes_of(control.modal.plane);
  if (words.any_rotary()) reader.fail("unexpected-word", start, "a pole has no rotary axes", "CC X+10 Y+20");
  const bool across = static_cast<bool>(words.axes[static_cast<size_t>(axes.normal)]);
  const int normal = across ? normal_of_pole(axes, frames, reader, words, start) : axes.normal;
  const Vec3 here = present(control, path);
  const bool none = !words.any_linear();
  Vec3 at = Vec3::Zero();
  for (const int i : {(normal + 1) % 3, (normal + 2) % 3}) {
    const Amount& word = words.axes[static_cast<size_t>(i)];
    if (word && !word.incremental) {
      at[i] = frames.stretch.along(i, control.modal.mm(word.value), false);
    } else if (word || none) {
      at[i] = here[i] + (word ? frames.stretch.along(i, control.modal.mm(word.value), true) : 0.0);
    } else if (path.centre && !path.centre_normal) {
      at[i] = (*path.centre)[i];
    } else {
      reader.fail("missing-word", start, "this pole needs both coordinates: there was none before",
                  "CC X+10 Y+20");
    }
  }
  if (!at.allFinite())
    reader.fail("start-unknown", start, "the pole counts from a position that is not known yet",
                "position all axes before it");
  path.centre = at;
  path.centre_normal = across ? std::optional(normal) : std::nullopt;
}

void circle(Executor& executor, BlockReader& reader, size_t start) {
  const MotionWords words = read_motion_words(reader, kAxesAllowed | kSenseAllowed | kAlways);
  if (executor.path.centre_normal) return circle_across(executor, reader, words, start);
  only_plane(executor.control, reader, words);
  Element element;
  element.offset = start;
  element.motion = sense(executor.control, executor.frames, reader, words, start) > 0
                       ? Motion::kCounterClockwise
                       : Motion::kClockwise;
  element.target = target_of(executor.control, executor.modes, executor.frames, reader, words);
  if (!words.any_linear()) reader.fail("missing-word", start, "C has no end", "C X+10 Y+20 DR+");
  element.arc.centre = centre(executor.path, reader, start);
  element.arc.column = executor.control.report.place.column;
  element.arc.radius_tolerance_mm = kRadiusTolerance;
  move(executor, reader, words, element);
}

/// CR X Y R DR: R above 0 takes the arc below 180 degrees.
void circle_by_radius(Executor& executor, BlockReader& reader, size_t start) {
  const MotionWords words =
      read_motion_words(reader, kAxesAllowed | kSenseAllowed | kRadiusAllowed | kAlways);
  only_plane(executor.control, reader, words);
  if (!words.radius) reader.fail("missing-word", start, "CR has no R", "CR X+10 Y+20 R+15 DR+");
  Element element;
  element.offset = start;
  const int turn = sense(executor.control, executor.frames, reader, words, start);
  element.motion = turn > 0 ? Motion::kCounterClockwise : Motion::kClockwise;
  element.target = target_of(executor.control, executor.modes, executor.frames, reader, words);
  element.arc.column = executor.control.report.place.column;
  const nc::PlaneAxes axes = nc::axes_of(executor.control.modal.plane);
  const Vec3 from = present(executor.control, executor.path);
  Vec3 chord = end_of(executor.control, executor.path, element.target) - from;
  chord[axes.normal] = 0.0;
  const double radius = plane_scale(executor.control, executor.frames, reader, start) *
                        executor.control.modal.mm(words.radius.value),
               half = 0.5 * chord.norm();
  if (!chord.allFinite())
    reader.fail("start-unknown", start, "this arc starts at a position that is not known yet",
                "position all axes before it");
  if (!(std::abs(radius) > 0.0) || !(half > 0.0) || half > std::abs(radius) + 0.5 * kRadiusTolerance) {
    reader.fail("bad-arc", words.radius.offset,
                fmt::format("no arc of radius {:.4f} mm joins ends that are {:.4f} mm apart",
                            std::abs(radius), 2.0 * half),
                "correct R or the end of the arc; whole circles are programmed with CC and C");
  }
  const double height = std::sqrt(std::max(0.0, radius * radius - half * half));
  const double side = (turn > 0) == (radius > 0.0) ? 1.0 : -1.0;
  element.arc.centre = from + 0.5 * chord + side * height * Vec3::Unit(axes.normal).cross(chord.normalized());
  element.arc.radius_tolerance_mm = kRadiusTolerance;
  move(executor, reader, words, element);
}

/// CT X Y: touches the piece before it.
void circle_tangential(Executor& executor, BlockReader& reader, size_t start) {
  const MotionWords words = read_motion_words(reader, kAxesAllowed | kAlways);
  only_plane(executor.control, reader, words);
  Element element;
  element.offset = start;
  element.target = target_of(executor.control, executor.modes, executor.frames, reader, words);
  const nc::PlaneAxes axes = nc::axes_of(executor.control.modal.plane);
  if (!executor.path.tangent || executor.path.held)
    reader.fail("missing-tangent", start,
                executor.path.held ? "CT cannot follow a corner" : "CT follows no piece of contour",
                "write a straight piece or an arc before it");
  plane_scale(executor.control, executor.frames, reader, start);
  const Vec3 from = present(executor.control, executor.path);
  Vec3 chord = end_of(executor.control, executor.path, element.target) - from;
  chord[axes.normal] = 0.0;
  const Vec3 left = Vec3::Unit(axes.normal).cross(*executor.path.tangent);
  const double off = chord.dot(left);
  if (!(std::abs(off) > 1e-9 * chord.norm()))
    reader.fail("bad-arc", start, "the end of CT lies straight ahead or where it starts: there is no arc",
                "write L");
  const double radius = chord.squaredNorm() / (2.0 * off);
  element.motion = radius > 0.0 ? Motion::kCounterClockwise : Motion::kClockwise;
  element.arc.centre = from + radius * left;
  element.arc.column = executor.control.report.place.column;
  move(executor, reader, words, element);
}

/// CP PA+90 DR+, CP IPA-720 IZ-10 DR-: about the pole, IPA may be many turns.
void polar_circle(Executor& executor, BlockReader& reader, size_t start) {
  const MotionWords words = read_motion_words(reader, kAxesAllowed | kPolarAllowed | kSenseAllowed | kAlways);
  const nc::PlaneAxes axes = nc::axes_of(executor.control.modal.plane);
  if (words.any_rotary() || words.polar_radius || words.axes[static_cast<size_t>(axes.first)] ||
      words.axes[static_cast<size_t>(axes.second)])
    reader.fail("unexpected-word", start, "CP takes PA, DR and the height alone", "CP IPA+360 IZ+5 DR+");
  if (!words.polar_angle) reader.fail("missing-word", start, "CP has no PA", "CP PA+90 DR+");
  const int turn = sense(executor.control, executor.frames, reader, words, start);
  const Vec3 about = centre(executor.path, reader, start);
  Element element;
  element.offset = start;
  element.motion = turn > 0 ? Motion::kCounterClockwise : Motion::kClockwise;
  element.target = target_of(executor.control, executor.modes, executor.frames, reader, words);
  Vec3 out = present(executor.control, executor.path) - about;
  out[axes.normal] = 0.0;
  if (!out.allFinite())
    reader.fail("start-unknown", start, "this arc starts at a position that is not known yet",
                "position all axes before it");
  const double angle = words.polar_angle.value;
  double end_deg = angle;
  const Vec3 written = out.cwiseQuotient(executor.frames.stretch.factor);
  if (words.polar_angle.incremental) {
    if (angle == 0.0 || (angle > 0.0) != (words.sense > 0))
      reader.fail("words-conflict", words.polar_angle.offset, "IPA and DR turn to different sides",
                  "give both the same sign");
    end_deg += deg_from_rad(std::atan2(written[axes.second], written[axes.first]));
    const double turns = std::ceil(std::abs(angle) / 360.0 - 1e-12);
    if (turns > 10000.0)
      reader.fail("out-of-range", words.polar_angle.offset, "this helix has more than 10000 turns",
                  "correct IPA");
    element.arc.further_turns = static_cast<int>(turns) - 1;
  }
  const bool whole = words.polar_angle.incremental && std::remainder(angle, 360.0) == 0.0;
  const Vec3 end =
      about + (whole ? out : from_pole(executor.control, executor.frames, written.norm(), end_deg));
  element.target.set(axes.first, end[axes.first], false);
  element.target.set(axes.second, end[axes.second], false);
  element.arc.centre = about;
  element.arc.column = executor.control.report.place.column;
  move(executor, reader, words, element);
  executor.path.polar_angle = {end_deg, start, true, false};
}

}  // namespace swarf::program::nc::heidenhain
