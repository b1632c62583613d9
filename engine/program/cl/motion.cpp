#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "base/units.h"
#include "program/cl/interpreter.h"

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
          "give x,y,z,i,j,k in the first position after MULTAX/ON, or TLAXIS/i,j,k before it");
    return false;
  }
  pose.axis_W = axis_W_;
  return true;
}

void ClInterpreter::go_to(const ClStatement& s) {
  if (circle_ && s.arguments.size() > 3) {
    go_round(s);
  } else {
    ToolPose to;
    if (pose_of(s, to)) {
      if (cycle_) {
        drill(s, to);
      } else if (!continues_arc(s, to.tip_W)) {
        move_to(s, to);
      }
    }
  }
  rapid_ = false;
  circle_.reset();
}

void ClInterpreter::go_delta(const ClStatement& s) {
  Vec3 axis = axis_W_;
  if (!positioned_) {
    fault("no-position", s, "GODLTA moves from a position, and none has been given",
          "give FROM or GOTO first");
  } else if (cycle_) {
    fault("bad-cycle", s, "GODLTA stands inside of a cycle", "give the hole with GOTO, or write CYCLE/OFF");
  } else if (numbers(s, 3, 6, "GODLTA/dx,dy,dz or GODLTA/dx,dy,dz,i,j,k (unit vector)")) {
    const bool turned = s.arguments.size() == 6;
    if (!turned || unit_vector(s, 3, "tool axis", axis)) {
      if (turned) axis = X_WC_.linear() * axis;
      move_to(s, {pose_.tip_W + X_WC_.linear() * point_at(s, 0), axis});
    }
  }
  rapid_ = false;
  circle_.reset();
}

void ClInterpreter::from(const ClStatement& s) {
  ToolPose pose;
  if (!pose_of(s, pose)) return;
  if (!positioned_) {
    start_at(s, pose);
    home_ = pose;
    return;
  }
  constexpr double kSame = 1e-6;  // mm, and of unit vectors
  if ((pose.tip_W - pose_.tip_W).norm() <= kSame && (pose.axis_W - pose_.axis_W).norm() <= kSame) return;
  fault("from-not-first", s, "FROM stands after a position has been given, and the tool is elsewhere",
        "FROM gives the start: put it first, or write GOTO");
}

void ClInterpreter::go_home(const ClStatement& s) {
  if (!not_compensated(s)) return;
  if (!s.arguments.empty()) return go_to(s);  // NX gives the place: a position like another
  if (!home_) {
    fault("no-home", s, "GOHOME, and no FROM says where that is",
          "give FROM at the start of the file, or write GOTO");
    return;
  }
  rapid_ = true;
  move_to(s, *home_);
  rapid_ = false;
}

void ClInterpreter::start_at(const ClStatement& s, const ToolPose& pose) {
  program_.start = pose_ = pose;
  axis_W_ = pose.axis_W;
  program_.start_line = s.line;
  positioned_ = axis_known_ = true;
}

void ClInterpreter::move_to(const ClStatement& s, const ToolPose& to) {
  if (!positioned_) {
    if (circle_) fault("no-position", s, "an arc needs a position to start from", "give FROM or GOTO first");
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
  if (circle_) return add_arc(s, to);
  add_move(s, to, rapid_ ? 0.0 : feed_mm_s_, 0.0);
}

void ClInterpreter::add_move(const ClStatement& s, const ToolPose& to, double feed_mm_s, double dwell_s) {
  send(s, to, std::nullopt, feed_mm_s, dwell_s);
}

void ClInterpreter::send(const ClStatement& s, const ToolPose& to, const std::optional<ClArc>& arc,
                         double feed_mm_s, double dwell_s) {
  const double dwell = dwell_s + std::exchange(dwell_s_, 0.0);
  if (cutter_ >= 0) program_.cutters[static_cast<size_t>(std::exchange(cutter_, -1))].tool = tool_;
  if (compensation_) {
    compensate(s, to, arc, feed_mm_s, dwell);
  } else {
    ClMove move;
    move.from = pose_;
    move.to = to;
    move.arc = arc;
    move.feed_mm_s = feed_mm_s;
    move.dwell_s = dwell;
    move.spindle_rpm = spindle_rpm_;
    move.tool = tool_;
    move.line = s.line;
    move.column = s.column;
    emit(move);
  }
  pose_ = to;
  axis_W_ = to.axis_W;
}

void ClInterpreter::emit(const ClMove& move) {
  ++program_.motions;
  sink_.move(move);
}

void ClInterpreter::drill(const ClStatement& s, const ToolPose& hole) {
  const auto at = [&](double height) { return ToolPose{hole.tip_W + height * hole.axis_W, hole.axis_W}; };
  const ToolPose above = at(cycle_->arrive_mm);
  ClCycle cycle = *cycle_;
  if (!positioned_) {
    start_at(s, above);
    cycle_start_W_ = above.tip_W;
  } else {
    add_move(s, above, 0.0, 0.0);
  }
  if (cycle.retract_to_start) {
    cycle.retract_mm = (cycle_start_W_ - hole.tip_W).dot(hole.axis_W);
    if (cycle.retract_mm < cycle.arrive_mm) {
      fault("bad-cycle", s,
            fmt::format("RTRCTO,AUTO goes back to where the tool stood before the cycle, {:g} mm above this "
                        "hole: below its clearance of {:g} mm",
                        cycle.retract_mm, cycle.arrive_mm),
            "write RTRCTO with a distance");
      return;
    }
  }
  for (const ClCycleStep& step : cycle_steps(cycle))
    add_move(s, at(step.height_mm), step.rapid ? 0.0 : cycle.feed_mm_s, step.dwell_s);
}

void ClInterpreter::rapid(const ClStatement& s) {
  if (!s.arguments.empty()) {
    fault("wrong-arguments", s.arguments[0], "RAPID has an argument", "write RAPID alone");
  }
  rapid_ = true;
}

void ClInterpreter::clearance_plane(const ClStatement& s) {
  const char* form = "CLEARP/XYPLAN,50 or CLEARP/PLANE,0,0,1,50 (normal and distance from zero), CLEARP/OFF";
  if (fits(s, "OFF")) {
    clearance_.reset();
    return;
  }
  Vec3 normal = Vec3::UnitZ();
  if (fits(s, "YZPLAN #")) normal = Vec3::UnitX();
  if (fits(s, "ZXPLAN #")) normal = Vec3::UnitY();
  if (fits(s, "PLANE ####") || fits(s, "####")) {
    if (!unit_vector(s, s.arguments.size() - 4, "normal of the plane", normal)) return;
  } else if (!fits(s, "XYPLAN #") && !fits(s, "YZPLAN #") && !fits(s, "ZXPLAN #")) {
    fault("wrong-arguments", s, "CLEARP gives no plane", fmt::format("write {}", form));
    return;
  }
  clearance_ = Plane{X_WC_ * Vec3(mm(s.arguments.back().value) * normal), X_WC_.linear() * normal};
}

void ClInterpreter::retract(const ClStatement& s) {
  if (!not_compensated(s)) return;
  if (!s.arguments.empty() || !clearance_ || !positioned_) {
    fault(clearance_ ? "wrong-arguments" : "unsupported-word", s,
          "RETRCT lifts the tool to a plane, and no CLEARP gives one",
          "write CLEARP/XYPLAN,50 before it, or the lift as RAPID and GOTO");
    return;
  }
  const double height = (clearance_->point_W - pose_.tip_W).dot(clearance_->normal_W);
  const double along = pose_.axis_W.dot(clearance_->normal_W);
  constexpr double kLeastSlope = 1e-3;
  if (height < 0.0) return;  // above it already
  if (along < kLeastSlope) {
    fault("out-of-range", s, "RETRCT: the tool axis does not lead to the plane of CLEARP",
          "write the lift as RAPID and GOTO");
    return;
  }
  rapid_ = true;
  move_to(s, {pose_.tip_W + height / along * pose_.axis_W, pose_.axis_W});
  rapid_ = false;
}

}  // namespace swarf::program
