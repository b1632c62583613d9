#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "program/cl/steps.h"

namespace swarf::program::cldata {
namespace {

constexpr const char* kCutcomForm =
    "write CUTCOM/LEFT, RIGHT, ON or OFF, a register and XYPLAN, YZPLAN or ZXPLAN";

bool is_plane(const std::string& word, nc::Plane& plane) {
  if (word == "XYPLAN") plane = nc::Plane::kXY;
  if (word == "YZPLAN") plane = nc::Plane::kYZ;
  if (word == "ZXPLAN") plane = nc::Plane::kZX;
  return word == "XYPLAN" || word == "YZPLAN" || word == "ZXPLAN";
}

bool read_cutcom(Reporter& reporter, ClCutcom& compensation, const ClStatement& s, nc::Compensation& side,
                 nc::Plane& plane) {
  bool given = false;
  for (const ClArgument& argument : s.arguments) {
    const std::string& word = argument.text;
    if (argument.number || is_plane(word, plane)) continue;  // a number names the control's register
    const bool known = word == "LEFT" || word == "RIGHT" || word == "ON" || word == "OFF";
    if (!known || given) {
      fault(reporter, "unsupported-word", argument, fmt::format("CUTCOM with '{}' is not followed", word),
            kCutcomForm);
      return false;
    }
    given = true;
    side = word == "LEFT"    ? nc::Compensation::kLeft
           : word == "RIGHT" ? nc::Compensation::kRight
           : word == "ON"    ? compensation.last_side
                             : nc::Compensation::kOff;
    if (word == "ON" && compensation.last_side == nc::Compensation::kOff) {
      fault(reporter, "wrong-arguments", argument, "CUTCOM/ON, and no LEFT or RIGHT stands before it",
            kCutcomForm);
      return false;
    }
  }
  if (!given)
    fault(reporter, "wrong-arguments", s, "CUTCOM says neither LEFT, RIGHT, ON nor OFF", kCutcomForm);
  return given;
}

void start_contour(ClState& cl, const ClStatement& s, nc::Compensation side, nc::Plane plane) {
  if (cl.compensation.contour && cl.compensation.contour->side() == side &&
      cl.compensation.contour->plane() == plane)
    return;
  if (cl.compensation.contour) {
    fault(cl.reporter, "compensation-active", s, "CUTCOM changes its side or plane while it is on",
          "write CUTCOM/OFF and a straight GOTO in the plane before it");
    return;
  }
  const std::optional<double> radius = cutter_radius(cl.options, cl.program, cl.tool);
  if (!radius || !cl.path.positioned || cl.drilling.cycle) {
    fault(cl.reporter, !radius ? "compensation-no-tool" : "compensation-entry", s,
          !radius              ? "CUTCOM, and neither CUTTER nor the scene gives the cutter's diameter"
          : cl.path.positioned ? "CUTCOM stands inside of a cycle"
                               : "CUTCOM, and no position has been given",
          !radius              ? "write CUTTER/10 before it, or describe the tool in the scene"
          : cl.path.positioned ? "write CYCLE/OFF before it"
                               : "give FROM or GOTO first");
    return;
  }
  remark(cl.program,
         fmt::format("CUTCOM: points are the part's contour; a cutter of radius {:g} mm goes beside it, its "
                     "lead-in ends across the start of the contour",
                     *radius));
  cl.compensation.contour =
      std::make_unique<ClCompensation>(cl.program.file, plane, [&cl](const nc::Segment& segment) {
        Move move;
        move.from = {cl.systems.X_WC * segment.from, cl.path.axis_W};
        move.to = {cl.systems.X_WC * segment.to, cl.path.axis_W};
        if (segment.is_arc())
          move.arc = Arc{cl.systems.X_WC * segment.centre, cl.systems.X_WC.linear() * segment.normal};
        move.rapid = segment.motion == nc::Motion::kRapid;
        move.feed_mm_s = move.rapid ? 0.0 : segment.feed;
        move.dwell_s = segment.dwell_s;
        move.spindle_rpm = segment.spindle_rpm;
        move.tool = cl.tool.active;
        move.line = segment.place.line;
        move.column = segment.place.column;
        emit(cl.sink, cl.program, move);
      });
  cl.compensation.contour->at(0, s.line, s.column);
  cl.compensation.contour->start(side, *radius);
}

}  // namespace

void cutter_compensation(ClState& cl, const ClStatement& s) {
  nc::Compensation side = nc::Compensation::kOff;
  nc::Plane plane = cl.compensation.last_plane;
  if (!read_cutcom(cl.reporter, cl.compensation, s, side, plane)) return;
  const bool on = side != nc::Compensation::kOff;
  const std::optional<ClPoints> points = cl.options.cutcom ? cl.options.cutcom : cl.compensation.file_cutcom;
  if (on && !points) {
    fault(cl.reporter, "cutcom-meaning", s,
          "CUTCOM is on, and nothing says what its points are: the cutter's centre or the part's contour",
          "write cutcom = \"centre\" (points of the cutter's centre, the control's register holds its wear: "
          "taken as 0) or cutcom = \"contour\" (points of the part, the cutter goes its radius aside) in the "
          "scene, or check the file with --cutcom");
    return;
  }
  if (on) {
    cl.compensation.last_side = side;
    cl.compensation.last_plane = plane;
  }
  if (on && *points == ClPoints::kContour) return start_contour(cl, s, side, plane);
  if (!on && cl.compensation.contour) {
    cl.compensation.contour->at(0, s.line, s.column);
    cl.compensation.contour->stop();
    if (cl.compensation.contour->done()) cl.compensation.contour.reset();
    return;
  }
  if (!on && points != ClPoints::kCentre) return;
  if (on)
    remark(
        cl.program,
        "CUTCOM: points are the cutter's centre as they are; the wear offset of the control is taken as 0");
  note(cl, s);
}

void compensate(ClState& cl, const ClStatement& s, const ToolPose& to, const std::optional<Arc>& arc,
                double feed_mm_s, double dwell_s) {
  cl.compensation.contour->at(0, s.line, s.column);
  const Vec3 normal_W = cl.systems.X_WC.linear().col(nc::axes_of(cl.compensation.contour->plane()).normal);
  constexpr double kStraight = 1e-7;  // rad
  if (to.axis_W.cross(normal_W).norm() > kStraight || to.axis_W.dot(normal_W) < 0.0 ||
      cl.path.pose.axis_W.cross(normal_W).norm() > kStraight) {
    cl.compensation.contour->fail(
        "compensation-plane", s.column,
        fmt::format("the tool axis ({:g}, {:g}, {:g}) does not stand on the plane of CUTCOM", to.axis_W.x(),
                    to.axis_W.y(), to.axis_W.z()),
        "");
  }
  const Pose X_CW = cl.systems.X_WC.inverse();
  nc::Segment segment;
  segment.motion = feed_mm_s == 0.0 ? nc::Motion::kRapid
                   : arc            ? nc::Motion::kCounterClockwise
                                    : nc::Motion::kFeed;
  segment.from = X_CW * cl.path.pose.tip_W;
  segment.to = X_CW * to.tip_W;
  if (arc) {
    segment.centre = X_CW * arc->centre_W;
    segment.normal = X_CW.linear() * arc->normal_W;
  }
  segment.feed = feed_mm_s;
  segment.dwell_s = dwell_s;
  segment.spindle_rpm = cl.feed.spindle_rpm;
  segment.place = {0, s.line, s.column};
  cl.compensation.contour->add(segment);
  if (cl.compensation.contour->done()) cl.compensation.contour.reset();
}

bool not_compensated(Reporter& reporter, ClCutcom& compensation, const ClStatement& s) {
  if (!compensation.contour) return true;
  fault(reporter, "compensation-active", s, fmt::format("{} stands where CUTCOM is on", s.word),
        "write CUTCOM/OFF and a straight GOTO in the plane before it");
  return false;
}

}  // namespace swarf::program::cldata
