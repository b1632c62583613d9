#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/units.h"
#include "program/cl_interpreter.h"

namespace swarf::program {

Vec3 ClInterpreter::point_at(const ClStatement& s, size_t first) const {
  return {mm(s.arguments[first].value), mm(s.arguments[first + 1].value), mm(s.arguments[first + 2].value)};
}

bool ClInterpreter::pose_of(const ClStatement& s, ToolPose& pose) {
  const char* form = "x,y,z or x,y,z,i,j,k (unit vector), for example GOTO/10,20,30,0,0,1";
  if (!numbers(s, 3, 6, form)) return false;
  pose.tip_W = X_WC_ * point_at(s, 0);
  if (s.arguments.size() == 6) {
    if (!unit_vector(s, 3, "tool axis", pose.axis_W)) return false;
    pose.axis_W = X_WC_.linear() * pose.axis_W;
    return true;
  }
  if (!axis_known_) {
    fault("missing-axis", s, fmt::format("{} gives no tool axis, and none stands before it", s.word),
          "give x,y,z,i,j,k in the first position after MULTAX/ON");
    return false;
  }
  pose.axis_W = axis_W_;
  return true;
}

void ClInterpreter::go_to(const ClStatement& s) {
  ToolPose to;
  if (pose_of(s, to)) {
    if (cycle_) {
      drill(s, to);
    } else {
      move_to(s, to);
    }
  }
  rapid_ = false;
  arc_.reset();
}

void ClInterpreter::go_delta(const ClStatement& s) {
  if (!positioned_) {
    fault("no-position", s, "GODLTA moves from a position, and none has been given",
          "give FROM or GOTO first");
  } else if (numbers(s, 3, 3, "GODLTA/dx,dy,dz")) {
    move_to(s, {pose_.tip_W + X_WC_.linear() * point_at(s, 0), axis_W_});
  }
  rapid_ = false;
  arc_.reset();
}

void ClInterpreter::from(const ClStatement& s) {
  if (positioned_) {
    fault("from-not-first", s, "FROM stands after a position has been given",
          "FROM gives the start: put it first, or write GOTO");
    return;
  }
  ToolPose pose;
  if (pose_of(s, pose)) start_at(s, pose);
}

void ClInterpreter::start_at(const ClStatement& s, const ToolPose& pose) {
  program_.start = pose_ = pose;
  axis_W_ = pose.axis_W;
  program_.start_line = s.line;
  positioned_ = axis_known_ = true;
}

void ClInterpreter::move_to(const ClStatement& s, const ToolPose& to) {
  if (!positioned_) {
    if (arc_) fault("no-position", s, "an arc needs a position to start from", "give FROM or GOTO first");
    start_at(s, to);
    return;
  }
  if (!rapid_ && feed_mm_s_ == 0.0) {
    // Once is enough: every move that follows has the same fault.
    if (!feed_missed_) {
      fault("missing-feed", s, fmt::format("{} moves without a feed", s.word),
            "write FEDRAT/500,MMPM or RAPID before it");
    }
    feed_missed_ = true;
  }
  add_move(s, to, rapid_ ? 0.0 : feed_mm_s_, 0.0);
}

void ClInterpreter::add_move(const ClStatement& s, const ToolPose& to, double feed_mm_s, double dwell_s) {
  ClMove move{pose_, to, arc_, feed_mm_s, dwell_s + dwell_s_, spindle_rpm_, tool_, s.line, s.column};
  dwell_s_ = 0.0;
  if (!arc_ || arc_fits(s, move)) program_.moves.push_back(std::move(move));
  pose_ = to;
  axis_W_ = to.axis_W;
}

void ClInterpreter::drill(const ClStatement& s, const ToolPose& hole) {
  if (arc_) fault("bad-arc", s, "an arc stands inside a cycle", "write CYCLE/OFF before it");
  const auto at = [&](double height) { return ToolPose{hole.tip_W + height * hole.axis_W, hole.axis_W}; };
  const ToolPose above = at(cycle_->clear_mm);
  if (!positioned_) {
    start_at(s, above);
  } else {
    add_move(s, above, 0.0, 0.0);
  }
  for (const ClCycleStep& step : cycle_steps(*cycle_))
    add_move(s, at(step.height_mm), step.rapid ? 0.0 : cycle_->feed_mm_s, step.dwell_s);
}

bool ClInterpreter::arc_fits(const ClStatement& s, const ClMove& move) {
  if (rapid_) {
    fault("bad-arc", s, "an arc stands in a rapid move", "take the RAPID away: an arc needs a feed");
    return false;
  }
  for (const Vec3& tip : {move.from.tip_W, move.to.tip_W}) {
    const Vec3 arm = tip - move.arc->centre_W;
    const double height = arm.dot(move.arc->normal_W);
    const double radius = (arm - height * move.arc->normal_W).norm();
    if (std::abs(radius - arc_radius_) <= kArcTolerance && std::abs(height) <= kArcTolerance) continue;
    fault("bad-arc", s,
          fmt::format("({:.4f}, {:.4f}, {:.4f}) does not lie on the circle of radius {:.4f} mm: its "
                      "distance from the axis is {:.4f} mm, from the plane {:.4f} mm",
                      tip.x(), tip.y(), tip.z(), arc_radius_, radius, std::abs(height)),
          fmt::format("both ends must lie on the circle within {:g} mm", kArcTolerance));
    return false;
  }
  return true;
}

void ClInterpreter::circle(const ClStatement& s) {
  const char* form = "CIRCLE/cx,cy,cz,i,j,k,r (unit vector)";
  // CAM systems append tolerances and the tool's diameter; they are checked to be numbers, not used.
  if (s.arguments.size() < 7) {
    fault("wrong-arguments", s, fmt::format("CIRCLE has {} arguments", s.arguments.size()),
          fmt::format("write {}", form));
    return;
  }
  Vec3 axis;
  if (!numbers(s, s.arguments.size(), 7, form) || !unit_vector(s, 3, "circle's axis", axis)) return;
  arc_radius_ = mm(s.arguments[6].value);
  if (arc_radius_ <= kArcTolerance) {
    fault("out-of-range", s.arguments[6], fmt::format("the circle's radius is {:g} mm", arc_radius_),
          fmt::format("it must be above {:g} mm", kArcTolerance));
    return;
  }
  // Clockwise about the axis; ClArc runs counter-clockwise about its normal.
  arc_ = ClArc{X_WC_ * point_at(s, 0), -(X_WC_.linear() * axis)};
}

void ClInterpreter::system(const ClStatement& s) {
  if (!numbers(s, 9, 9, "MSYS/ox,oy,oz, xi,xj,xk, yi,yj,yk (origin, unit X axis, unit Y axis)")) return;
  Vec3 x, y;
  if (!unit_vector(s, 3, "X axis of the system", x) || !unit_vector(s, 6, "Y axis of the system", y)) return;
  if (std::abs(x.dot(y)) > kAxisLengthTolerance) {
    fault("out-of-range", s.arguments[6],
          fmt::format("the axes of the system stand at {:.6g} deg to each other",
                      deg_from_rad(std::acos(std::clamp(x.dot(y), -1.0, 1.0)))),
          "give two axes at right angles");
    return;
  }
  Mat3 R;
  R.col(0) = x;
  R.col(2) = x.cross(y).normalized();
  R.col(1) = R.col(2).cross(x);
  X_WC_.linear() = R;
  X_WC_.translation() = point_at(s, 0);
}

void ClInterpreter::rapid(const ClStatement& s) {
  if (!s.arguments.empty()) {
    fault("wrong-arguments", s.arguments[0], "RAPID has an argument", "write RAPID alone");
  }
  rapid_ = true;
}
}  // namespace swarf::program
