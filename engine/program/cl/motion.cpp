#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "base/units.h"
#include "program/cl/steps.h"

namespace swarf::program::cldata {
namespace {

void add_move(ClState& cl, const ClStatement& s, const ToolPose& to, double feed_mm_s, double dwell_s) {
  send(cl, s, to, std::nullopt, feed_mm_s, dwell_s);
}

/// Resolves RTRCTO,AUTO; false with a fault where the tool stood too low for it.
bool set_retract(ClState& cl, const ClStatement& s, const ToolPose& hole, ClCycle& cycle) {
  if (!cycle.retract_to_start) return true;
  cycle.retract_mm = (cl.drilling.cycle_start_W - hole.tip_W).dot(hole.axis_W);
  if (cycle.retract_mm >= cycle.arrive_mm) return true;
  fault(cl.reporter, "bad-cycle", s,
        fmt::format("RTRCTO,AUTO goes back to where the tool stood before the cycle, {:g} mm above this "
                    "hole: below its clearance of {:g} mm",
                    cycle.retract_mm, cycle.arrive_mm),
        "write RTRCTO with a distance");
  return false;
}

void drill(ClState& cl, const ClStatement& s, const ToolPose& hole) {
  const auto at = [&](double height) { return ToolPose{hole.tip_W + height * hole.axis_W, hole.axis_W}; };
  const ToolPose above = at(cl.drilling.cycle->arrive_mm);
  ClCycle cycle = *cl.drilling.cycle;
  const bool arrives = cl.path.positioned;
  if (!arrives) {
    start_at(cl.program, cl.path, s, above);
    cl.drilling.cycle_start_W = above.tip_W;
  }
  if (!set_retract(cl, s, hole, cycle)) return;
  const std::vector<ClCycleStep> steps = cycle_steps(cycle);
  if (!cl.compensation.contour)
    cl.sink.hole({hole, cycle, static_cast<int>(steps.size()) + (arrives ? 1 : 0), s.line});
  if (arrives) add_move(cl, s, above, 0.0, 0.0);
  for (const ClCycleStep& step : steps)
    add_move(cl, s, at(step.height_mm), step.rapid ? 0.0 : cycle.feed_mm_s, step.dwell_s);
}

/// To the sink, where nothing but this statement decides on it.
void tell_position(ClState& cl, const ClStatement& s, const ToolPose& pose) {
  if (cl.arcs.circle || cl.compensation.contour) return;
  cl.sink.position({pose, cl.systems.X_WC, cl.systems.unit_mm, s.arguments.size() == 6, s.line});
}

}  // namespace

Vec3 point_at(const ClSystems& systems, const ClStatement& s, size_t first) {
  return {systems.mm(s.arguments[first].value), systems.mm(s.arguments[first + 1].value),
          systems.mm(s.arguments[first + 2].value)};
}

bool axis_stands(Reporter& reporter, const ClPath& path, const ClStatement& s) {
  if (path.axis_known) return true;
  fault(reporter, "missing-axis", s,
        fmt::format("{} gives no tool axis, and none stands before it{}", s.word,
                    path.turned ? " since TRACUT has tilted it" : ""),
        "give x,y,z,i,j,k in the first position after MULTAX/ON or TRACUT, or TLAXIS/i,j,k before it");
  return false;
}

bool pose_of(Reporter& reporter, ClSystems& systems, ClPath& path, const ClStatement& s, ToolPose& pose) {
  const char* form = "x,y,z or x,y,z,i,j,k (unit vector), for example GOTO/10,20,30,0,0,1";
  if (!numbers(reporter, s, 3, 6, form)) return false;
  pose.tip_W = systems.X_WC * point_at(systems, s, 0);
  if (s.arguments.size() == 6) {
    if (!unit_vector(reporter, s, 3, "tool axis", pose.axis_W)) return false;
    pose.axis_W = systems.X_WC.linear() * pose.axis_W;
    path.axis_known = true;
    path.turned = false;
    return true;
  }
  if (!axis_stands(reporter, path, s)) return false;
  pose.axis_W = path.axis_W;
  path.turned = false;
  return true;
}

void go_to(ClState& cl, const ClStatement& s) {
  if (cl.arcs.circle && s.arguments.size() > 3) {
    go_round(cl, s);
  } else {
    ToolPose to;
    if (pose_of(cl.reporter, cl.systems, cl.path, s, to)) {
      if (cl.drilling.cycle) {
        drill(cl, s, to);
      } else if (!continues_arc(cl.reporter, cl.path, cl.arcs, s, to.tip_W)) {
        tell_position(cl, s, to);
        move_to(cl, s, to);
      }
    }
  }
  cl.path.rapid = false;
  cl.arcs.circle.reset();
}

void go_delta(ClState& cl, const ClStatement& s) {
  Vec3 axis = cl.path.axis_W;
  if (!cl.path.positioned) {
    fault(cl.reporter, "no-position", s, "GODLTA moves from a position, and none has been given",
          "give FROM or GOTO first");
  } else if (cl.path.turned) {
    fault(cl.reporter, "no-position", s,
          "GODLTA moves from a position, and TRACUT has changed what positions mean since the last",
          "give GOTO first");
  } else if (cl.drilling.cycle) {
    fault(cl.reporter, "bad-cycle", s, "GODLTA stands inside of a cycle",
          "give the hole with GOTO, or write CYCLE/OFF");
  } else if (numbers(cl.reporter, s, 3, 6, "GODLTA/dx,dy,dz or GODLTA/dx,dy,dz,i,j,k (unit vector)")) {
    const bool turned = s.arguments.size() == 6;
    if (!turned || unit_vector(cl.reporter, s, 3, "tool axis", axis)) {
      if (turned) axis = cl.systems.X_WC.linear() * axis;
      move_to(cl, s, {cl.path.pose.tip_W + cl.systems.X_WC.linear() * point_at(cl.systems, s, 0), axis});
    }
  }
  cl.path.rapid = false;
  cl.arcs.circle.reset();
}

void from(ClState& cl, const ClStatement& s) {
  ToolPose pose;
  if (!pose_of(cl.reporter, cl.systems, cl.path, s, pose)) return;
  if (!cl.path.positioned) {
    start_at(cl.program, cl.path, s, pose);
    cl.path.home = pose;
    return;
  }
  constexpr double kSame = 1e-6;  // mm, and of unit vectors
  if ((pose.tip_W - cl.path.pose.tip_W).norm() <= kSame &&
      (pose.axis_W - cl.path.pose.axis_W).norm() <= kSame)
    return;
  fault(cl.reporter, "from-not-first", s,
        "FROM stands after a position has been given, and the tool is elsewhere",
        "FROM gives the start: put it first, or write GOTO");
}

void go_home(ClState& cl, const ClStatement& s) {
  if (!not_compensated(cl.reporter, cl.compensation, s)) return;
  if (!s.arguments.empty()) return go_to(cl, s);  // NX gives the place: a position like another
  if (!cl.path.home) {
    fault(cl.reporter, "no-home", s, "GOHOME, and no FROM says where that is",
          "give FROM at the start of the file, or write GOTO");
    return;
  }
  cl.path.rapid = true;
  move_to(cl, s, *cl.path.home);
  cl.path.rapid = false;
}

void start_at(ClProgram& program, ClPath& path, const ClStatement& s, const ToolPose& pose) {
  program.start = path.pose = pose;
  path.axis_W = pose.axis_W;
  program.start_line = s.line;
  path.positioned = path.axis_known = true;
  path.turned = false;
}

void move_to(ClState& cl, const ClStatement& s, const ToolPose& to) {
  if (!cl.path.positioned) {
    if (cl.arcs.circle)
      fault(cl.reporter, "no-position", s, "an arc needs a position to start from",
            "give FROM or GOTO first");
    start_at(cl.program, cl.path, s, to);
    return;
  }
  if (!cl.path.rapid && cl.feed.feed_mm_s == 0.0) {
    // Once is enough: every move that follows has the same fault.
    if (!cl.feed.feed_missed) {
      fault(cl.reporter, "missing-feed", s, fmt::format("{} moves without a feed", s.word),
            "write FEDRAT/500,MMPM or RAPID before it");
    }
    cl.feed.feed_missed = true;
  }
  if (cl.arcs.circle) return add_arc(cl, s, to);
  add_move(cl, s, to, cl.path.rapid ? 0.0 : cl.feed.feed_mm_s, 0.0);
}

void send(ClState& cl, const ClStatement& s, const ToolPose& to, const std::optional<Arc>& arc,
          double feed_mm_s, double dwell_s) {
  const double dwell = dwell_s + std::exchange(cl.feed.dwell_s, 0.0);
  if (cl.tool.next_cutter >= 0)
    cl.program.cutters[static_cast<size_t>(std::exchange(cl.tool.next_cutter, -1))].tool = cl.tool.active;
  if (cl.compensation.contour) {
    compensate(cl, s, to, arc, feed_mm_s, dwell);
  } else {
    Move move;
    move.from = cl.path.pose;
    move.to = to;
    move.arc = arc;
    move.rapid = feed_mm_s == 0.0;
    move.feed_mm_s = feed_mm_s;
    move.dwell_s = dwell;
    move.spindle_rpm = cl.feed.spindle_rpm;
    move.tool = cl.tool.active;
    move.line = s.line;
    move.column = s.column;
    emit(cl.sink, cl.program, move);
  }
  cl.path.pose = to;
  cl.path.axis_W = to.axis_W;
}

void emit(ClSink& sink, ClProgram& program, const Move& move) {
  ++program.motions;
  sink.move(move);
}

void rapid(ClState& cl, const ClStatement& s) {
  if (!s.arguments.empty()) {
    fault(cl.reporter, "wrong-arguments", s.arguments[0], "RAPID has an argument", "write RAPID alone");
  }
  cl.path.rapid = true;
}

void clearance_plane(ClState& cl, const ClStatement& s) {
  const char* form = "CLEARP/XYPLAN,50 or CLEARP/PLANE,0,0,1,50 (normal and distance from zero), CLEARP/OFF";
  if (fits(s, "OFF")) {
    cl.path.clearance.reset();
    return;
  }
  if (cl.systems.tracut) {
    fault(
        cl.reporter, "unsupported-word", s,
        "CLEARP stands behind TRACUT, and whether the matrix turns its plane is the post-processor's choice",
        "write CLEARP before TRACUT, or the lift as RAPID and GOTO");
    return;
  }
  Vec3 normal = Vec3::UnitZ();
  if (fits(s, "YZPLAN #")) normal = Vec3::UnitX();
  if (fits(s, "ZXPLAN #")) normal = Vec3::UnitY();
  if (fits(s, "PLANE ####") || fits(s, "####")) {
    if (!unit_vector(cl.reporter, s, s.arguments.size() - 4, "normal of the plane", normal)) return;
  } else if (!fits(s, "XYPLAN #") && !fits(s, "YZPLAN #") && !fits(s, "ZXPLAN #")) {
    fault(cl.reporter, "wrong-arguments", s, "CLEARP gives no plane", fmt::format("write {}", form));
    return;
  }
  cl.path.clearance = Plane{cl.systems.X_WC * Vec3(cl.systems.mm(s.arguments.back().value) * normal),
                            cl.systems.X_WC.linear() * normal};
}

void retract(ClState& cl, const ClStatement& s) {
  if (!not_compensated(cl.reporter, cl.compensation, s)) return;
  if (!s.arguments.empty() || !cl.path.clearance || !cl.path.positioned) {
    fault(cl.reporter, cl.path.clearance ? "wrong-arguments" : "unsupported-word", s,
          "RETRCT lifts the tool to a plane, and no CLEARP gives one",
          "write CLEARP/XYPLAN,50 before it, or the lift as RAPID and GOTO");
    return;
  }
  const double height = (cl.path.clearance->point_W - cl.path.pose.tip_W).dot(cl.path.clearance->normal_W);
  const double along = cl.path.pose.axis_W.dot(cl.path.clearance->normal_W);
  constexpr double kLeastSlope = 1e-3;
  if (height < 0.0) return;  // above it already
  if (along < kLeastSlope) {
    fault(cl.reporter, "out-of-range", s, "RETRCT: the tool axis does not lead to the plane of CLEARP",
          "write the lift as RAPID and GOTO");
    return;
  }
  cl.path.rapid = true;
  move_to(cl, s, {cl.path.pose.tip_W + height / along * cl.path.pose.axis_W, cl.path.pose.axis_W});
  cl.path.rapid = false;
}

}  // namespace swarf::program::cldata
