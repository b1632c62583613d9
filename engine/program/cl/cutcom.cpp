#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "program/cl/interpreter.h"

namespace swarf::program {
namespace {

constexpr const char* kForm = "write CUTCOM/LEFT, RIGHT, ON or OFF, a register and XYPLAN, YZPLAN or ZXPLAN";

/// The remedies of control/contour.cpp in words of CL data.
struct Remedy {
  std::string_view code;
  const char* fix;
};
constexpr std::array kRemedies{
    Remedy{"compensation-active", "write CUTCOM/OFF and a straight GOTO in the plane before it"},
    Remedy{"compensation-plane", "write CUTCOM/OFF before it, or give the arc's plane with CUTCOM"},
    Remedy{"compensation-entry",
           "put CUTCOM before a straight GOTO in the plane that is longer than the radius"},
    Remedy{"compensation-exit", "put CUTCOM/OFF before a straight GOTO in the plane"},
    Remedy{"compensation-rapid", "write CUTCOM/OFF before rapid moves, or take the RAPID away"}};

bool is_plane(const std::string& word, nc::Plane& plane) {
  if (word == "XYPLAN") plane = nc::Plane::kXY;
  if (word == "YZPLAN") plane = nc::Plane::kYZ;
  if (word == "ZXPLAN") plane = nc::Plane::kZX;
  return word == "XYPLAN" || word == "YZPLAN" || word == "ZXPLAN";
}

}  // namespace

void ClCompensation::fail(const char* code, int column, std::string text, std::string fix) const {
  for (const Remedy& remedy : kRemedies) {
    if (remedy.code == code) fix = remedy.fix;
  }
  throw InputError(code, {file_, place_.line, column > 0 ? column : place_.column}, std::move(text),
                   std::move(fix));
}

bool ClInterpreter::read_cutcom(const ClStatement& s, nc::Compensation& side, nc::Plane& plane) {
  bool given = false;
  for (const ClArgument& argument : s.arguments) {
    const std::string& word = argument.text;
    if (argument.number || is_plane(word, plane)) continue;  // a number names the control's register
    const bool known = word == "LEFT" || word == "RIGHT" || word == "ON" || word == "OFF";
    if (!known || given) {
      fault("unsupported-word", argument, fmt::format("CUTCOM with '{}' is not followed", word), kForm);
      return false;
    }
    given = true;
    side = word == "LEFT"    ? nc::Compensation::kLeft
           : word == "RIGHT" ? nc::Compensation::kRight
           : word == "ON"    ? last_side_
                             : nc::Compensation::kOff;
    if (word == "ON" && last_side_ == nc::Compensation::kOff) {
      fault("wrong-arguments", argument, "CUTCOM/ON, and no LEFT or RIGHT stands before it", kForm);
      return false;
    }
  }
  if (!given) fault("wrong-arguments", s, "CUTCOM says neither LEFT, RIGHT, ON nor OFF", kForm);
  return given;
}

void ClInterpreter::cutter_compensation(const ClStatement& s) {
  nc::Compensation side = nc::Compensation::kOff;
  nc::Plane plane = last_plane_;
  if (!read_cutcom(s, side, plane)) return;
  const bool on = side != nc::Compensation::kOff;
  const std::optional<ClPoints> points = options_.cutcom ? options_.cutcom : file_cutcom_;
  if (on && !points) {
    fault("cutcom-meaning", s,
          "CUTCOM is on, and nothing says what its points are: the cutter's centre or the part's contour",
          "write cutcom = \"centre\" (points of the cutter's centre, the control's register holds its wear: "
          "taken as 0) or cutcom = \"contour\" (points of the part, the cutter goes its radius aside) in the "
          "scene, or check the file with --cutcom");
    return;
  }
  if (on) {
    last_side_ = side;
    last_plane_ = plane;
  }
  if (on && *points == ClPoints::kContour) return start_contour(s, side, plane);
  if (!on && compensation_) {
    compensation_->at(0, s.line, s.column);
    compensation_->stop();
    if (compensation_->done()) compensation_.reset();
    return;
  }
  if (!on && points != ClPoints::kCentre) return;
  if (on)
    remark(
        "CUTCOM: points are the cutter's centre as they are; the wear offset of the control is taken as 0");
  note(s);
}

void ClInterpreter::start_contour(const ClStatement& s, nc::Compensation side, nc::Plane plane) {
  if (compensation_ && compensation_->side() == side && compensation_->plane() == plane) return;
  if (compensation_) {
    fault("compensation-active", s, "CUTCOM changes its side or plane while it is on",
          "write CUTCOM/OFF and a straight GOTO in the plane before it");
    return;
  }
  const std::optional<double> radius = cutter_radius();
  if (!radius || !positioned_ || cycle_) {
    fault(!radius ? "compensation-no-tool" : "compensation-entry", s,
          !radius       ? "CUTCOM, and neither CUTTER nor the scene gives the cutter's diameter"
          : positioned_ ? "CUTCOM stands inside of a cycle"
                        : "CUTCOM, and no position has been given",
          !radius       ? "write CUTTER/10 before it, or describe the tool in the scene"
          : positioned_ ? "write CYCLE/OFF before it"
                        : "give FROM or GOTO first");
    return;
  }
  remark(
      fmt::format("CUTCOM: points are the part's contour; a cutter of radius {:g} mm goes beside it, its "
                  "lead-in ends across the start of the contour",
                  *radius));
  compensation_ = std::make_unique<ClCompensation>(program_.file, plane, [this](const nc::Segment& segment) {
    ClMove move;
    move.from = {X_WC_ * segment.from, axis_W_};
    move.to = {X_WC_ * segment.to, axis_W_};
    if (segment.is_arc()) move.arc = ClArc{X_WC_ * segment.centre, X_WC_.linear() * segment.normal};
    move.feed_mm_s = segment.motion == nc::Motion::kRapid ? 0.0 : segment.feed;
    move.dwell_s = segment.dwell_s;
    move.spindle_rpm = segment.spindle_rpm;
    move.tool = tool_;
    move.line = segment.place.line;
    move.column = segment.place.column;
    emit(move);
  });
  compensation_->at(0, s.line, s.column);
  compensation_->start(side, *radius);
}

void ClInterpreter::compensate(const ClStatement& s, const ToolPose& to, const std::optional<ClArc>& arc,
                               double feed_mm_s, double dwell_s) {
  compensation_->at(0, s.line, s.column);
  const Vec3 normal_W = X_WC_.linear().col(nc::axes_of(compensation_->plane()).normal);
  constexpr double kStraight = 1e-7;  // rad
  if (to.axis_W.cross(normal_W).norm() > kStraight || to.axis_W.dot(normal_W) < 0.0 ||
      pose_.axis_W.cross(normal_W).norm() > kStraight) {
    compensation_->fail("compensation-plane", s.column,
                        fmt::format("the tool axis ({:g}, {:g}, {:g}) does not stand on the plane of CUTCOM",
                                    to.axis_W.x(), to.axis_W.y(), to.axis_W.z()),
                        "");
  }
  const Pose X_CW = X_WC_.inverse();
  nc::Segment segment;
  segment.motion = feed_mm_s == 0.0 ? nc::Motion::kRapid
                   : arc            ? nc::Motion::kCounterClockwise
                                    : nc::Motion::kFeed;
  segment.from = X_CW * pose_.tip_W;
  segment.to = X_CW * to.tip_W;
  if (arc) {
    segment.centre = X_CW * arc->centre_W;
    segment.normal = X_CW.linear() * arc->normal_W;
  }
  segment.feed = feed_mm_s;
  segment.dwell_s = dwell_s;
  segment.spindle_rpm = spindle_rpm_;
  segment.place = {0, s.line, s.column};
  compensation_->add(segment);
  if (compensation_->done()) compensation_.reset();
}

bool ClInterpreter::not_compensated(const ClStatement& s) {
  if (!compensation_) return true;
  fault("compensation-active", s, fmt::format("{} stands where CUTCOM is on", s.word),
        "write CUTCOM/OFF and a straight GOTO in the plane before it");
  return false;
}

}  // namespace swarf::program
