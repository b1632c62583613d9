// What stays between the statements of CL data, as plain data; steps.h has the handlers of the words.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "program/cl/compensation.h"
#include "program/cl/cycle.h"
#include "program/cl/nurbs.h"
#include "program/cl/program.h"
#include "program/cl/statement.h"
#include "program/reporter.h"

namespace swarf::program::cldata {

/// The circle that the next position goes round.
struct Circle {
  Vec3 centre_W, normal_W;  ///< counter-clockwise about the unit normal
  double radius = 0.0;
  std::optional<double> turns;  ///< TIMES of NX
};
/// A plane that the tip stays on: PSIS, CLEARP.
struct Plane {
  Vec3 point_W, normal_W;
};

/// The systems that positions are given in.
struct ClSystems {
  Pose X_SC = Pose::Identity();  ///< MSYS: from the coordinates of the program to the file's first system
  Pose X_WC = Pose::Identity();  ///< the same with TRACUT, ORIGIN and TRANS: to the work
  std::optional<Pose> tracut;    ///< X_CP: from what GOTO writes to the coordinates of the program
  Vec3 origin = Vec3::Zero();
  std::optional<Vec3> translation;
  std::optional<Pose> first_catia;  ///< of $$*CATIA0: machining axes to the part
  std::optional<std::array<double, 12>> creo_system;
  int catia_lines = 0;  ///< comments of $$*CATIA0 that are still to come
  std::array<double, 12> catia{};
  double unit_mm = 1.0;  ///< 25.4 after UNITS/INCHES; before it ClOptions::unit_mm
  /// A finite number in the units of the program, in mm.
  double mm(double value) const { return value * unit_mm; }
};

/// Elements of a rotation that leave an axis where it is.
constexpr double kAxisStands = 1e-9;

/// Where the tool stands.
struct ClPath {
  ToolPose pose;
  Vec3 axis_W = Vec3::UnitZ();  ///< of a position that gives none
  bool positioned = false;
  bool axis_known = true;  ///< (0,0,1) until MULTAX/ON
  bool multi_axis = false;
  bool turned = false;  ///< by TRACUT, and no position has come since
  bool rapid = false, ended = false;
  std::optional<ToolPose> home;  ///< FROM
  std::optional<Plane> clearance;
};

struct ClRates {
  bool feed_missed = false;
  double feed_mm_s = 0.0, spindle_rpm = 0.0, dwell_s = 0.0;
};

struct ClToolState {
  int active = -1;
  int next_cutter = -1;  ///< index of the CUTTER that the next motion takes up
};

/// What the next arc goes by.
struct ClArcs {
  std::optional<Circle> circle;
  std::optional<Circle> rounded;    ///< the arc of the statement before, in files of Creo
  std::optional<Vec3> direction_W;  ///< INDIRV
  std::optional<Plane> part_surface;
};

struct ClDrilling {
  std::optional<ClCycle> cycle;
  std::optional<ClCycle> cycle_words;  ///< of the last CYCLE, as they were given: what CYCLE/ON changes
  Vec3 cycle_start_W = Vec3::Zero();   ///< where the tip stood when the cycle began
};

struct ClCutcom {
  std::unique_ptr<ClCompensation> contour;
  nc::Compensation last_side = nc::Compensation::kOff;  ///< what CUTCOM/ON switches on again
  nc::Plane last_plane = nc::Plane::kXY;
  std::optional<ClPoints> file_cutcom;  ///< what the file says of its points
};

struct ClState {
  /// All references must outlive the state.
  ClState(const std::string& file, const ClOptions& given, ClSink& moves, Diagnostics& diagnostics)
      : options(given), sink(moves), reporter(diagnostics, file) {
    program.file = file;
    program.unit_assumed = !given.unit_mm;
    systems.unit_mm = given.unit_mm.value_or(1.0);
  }

  const ClOptions& options;
  ClSink& sink;
  Reporter reporter;
  ClProgram program;
  ClSystems systems;
  ClPath path;
  ClRates feed;
  ClToolState tool;
  ClArcs arcs;
  ClDrilling drilling;
  std::optional<ClNurbs> nurbs;  ///< from MOVNRB/3AXIS or 5AXIS to MOVNRB/OFF
  ClCutcom compensation;
};

}  // namespace swarf::program::cldata
