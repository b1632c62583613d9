// What a program does, before it is written: axis values and program coordinates of every block, as data.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "kinematics/machine_model.h"
#include "post/tilted_plane.h"
#include "program/cl/program.h"

namespace swarf::post {

enum class StepKind {
  kApproach,  ///< up out of the way, tool change if it has another tool, rotary axes, across, down
  kRapid,
  kFeed,
  kArc,   ///< of the tip, in a plane that the dialect has
  kHole,  ///< a whole drilling cycle; it starts and ends over the hole
};

/// The end of a block and how the machine comes there.
struct PlanStep {
  StepKind kind = StepKind::kRapid;
  kinematics::AxisValues q = kinematics::AxisValues::Zero();
  ToolPose pose;                   ///< W
  Vec3 p = Vec3::Zero();           ///< program X Y Z, mm: of the tip with TCP or in a plane, else of the axes
  Vec3 axes_p = Vec3::Zero();      ///< kApproach: the same without TCP
  std::array<double, 3> rotary{};  ///< A B C, rad; 0 for those that the machine lacks
  Vec3 centre = Vec3::Zero();      ///< kArc: program coordinates
  int plane = 0;                   ///< kArc: 0 XY, 1 ZX, 2 YZ
  bool clockwise = false;          ///< kArc: seen against the plane's normal
  double feed_mm_s = 0.0;          ///< of the tip as programmed; 0: rapid
  double tip_mm = 0.0;             ///< way of the tip
  double way_mm = 0.0,
         turn_deg = 0.0;            ///< of the linear axes (kArc: of the tip), of the rotary axes together
  double duration_s = 0.0;          ///< at that feed, or at the axes' speed limits where they are slower
  double dwell_s = 0.0;             ///< before it
  double spindle_rpm = 0.0;         ///< below 0: counter-clockwise
  double deviation_mm = 0.0;        ///< bound of the tip from the CL move up to here, digits included
  int tool = -1;                    ///< index into PostJob::tools
  int line = 0;                     ///< of the CL data
  int hole = -1;                    ///< kHole: index into PlannedStretch::holes
  bool tcp = false, timed = false;  ///< TCP is on; feeds are inverse times, or counted anew
  bool turns = false;               ///< a rotary axis moves
  bool at_cl_point = false;         ///< it ends at a position of the CL data
  std::shared_ptr<const TiltedPlane> tilt;  ///< p counts in it, and TCP is off; null: none
};

/// A note of the CL data, with the number of steps of the stretch that come before it.
struct PlacedNote {
  size_t before = 0;
  program::ClNote note;
};

/// What lies between two places at which the tool is out of the way.
struct PlannedStretch {
  std::vector<PlanStep> steps;
  std::vector<program::ClHole> holes;
  std::vector<PlacedNote> notes;
};

/// What all of it comes to.
struct PlanSummary {
  long points = 0, steps = 0, arcs = 0, holes = 0, approaches = 0;
  long tilts = 0;                                     ///< times that a tilted plane is entered
  long pole_turns = 0;                                ///< steps that turn the rotary axes at rest
  long slowed = 0;                                    ///< steps that an axis does not let run at their feed
  double feed_s = 0.0, rapid_s = 0.0, dwell_s = 0.0;  ///< without accelerations and tool changes
  kinematics::AxisValues travel = kinematics::AxisValues::Zero();
  kinematics::AxisValues low = kinematics::AxisValues::Constant(1e300);
  kinematics::AxisValues high = kinematics::AxisValues::Constant(-1e300);
  double deviation_mm = 0.0;  ///< greatest bound of the tip; digits included
  double digits_mm = 0.0;     ///< of which the written digits alone, greatest
  int deviation_line = 0;

  double time_s() const { return feed_s + rapid_s + dwell_s; }
};

}  // namespace swarf::post
