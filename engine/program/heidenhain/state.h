// What a Heidenhain control keeps from block to block, as plain data; steps.h has what is done with it.
//
// The frame is  T(shift) Rz(turn) R_tilt T(shift') Rz(turn'),  the first pair as cycles 7 and 10 say before a
// plane is tilted, the second as they say within it. R_tilt by spatial angles: Rz(SPC) Ry(SPB) Rx(SPA), that
// is SPA about the fixed X, then SPB about the fixed Y, then SPC about the fixed Z. Mirror images and
// scalings are applied to the words (frame.h).
//
// Settings of the control that a program cannot show are those of delivery: M127 (rotary axes as written),
// M129, R0, preset 1; F in inch programs counts tenths of an inch per minute; a circle's ends may differ by
// 0.016 mm from its radius.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "program/control/control.h"
#include "program/control/cycles.h"
#include "program/control/flat_corner.h"
#include "program/control/offsets.h"
#include "program/control/path.h"
#include "program/control/tilt.h"
#include "program/control/tools.h"
#include "program/heidenhain/codes.h"
#include "program/heidenhain/flow.h"
#include "program/heidenhain/frame.h"
#include "program/heidenhain/words.h"

namespace swarf::program::nc::heidenhain {

/// FMAX as a cycle's feed: what the control keeps of it in the Q parameter.
inline constexpr double kRapidFeed = 99999.999;
/// The number of a cycle and of its part, as in "7.1".
struct CycleNumber {
  int number = 0, part = -1;
};

/// Directions of X Y Z of the machine, and of the tool's own frame, in W.
Mat3 linear_columns_W(const kinematics::MachineModel& machine, const kinematics::AxisValues& q);
Mat3 tool_frame_W(const kinematics::MachineModel& machine, const kinematics::AxisValues& q);

/// A motion that waits for the corner behind it.
struct Element {
  nc::Motion motion = nc::Motion::kFeed;
  nc::Target target;
  nc::ArcWords arc;
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< program coordinates
  double feed = 0.0;
  nc::Place place;
  size_t offset = 0;
};
struct Corner {
  bool round = false;
  double size_mm = 0.0, feed = 0.0;
  nc::Place place;
};
/// APPR, which waits for the first piece of contour behind it.
struct Approach {
  std::string kind;                   ///< LT, LN, CT or LCT
  Vec3 contour = Vec3::Zero();        ///< its first point
  double length = 0.0, radius = 0.0;  ///< LEN and R, mm
  double angle = 0.0;                 ///< CCA, rad
  nc::Compensation side = nc::Compensation::kOff;
  double cutter = 0.0;                   ///< radius that RL or RR compensate, mm
  nc::Motion entry = nc::Motion::kFeed;  ///< of the way to the auxiliary point
  double entry_feed = 0.0;
  nc::Motion motion = nc::Motion::kFeed;  ///< from there
  double feed = 0.0;
  nc::Place place;
};
/// A cycle that CYCL CALL executes.
struct Cycle {
  int number = 0;
  std::map<int, double> q;  ///< by number of the Q parameter
  size_t offset = 0;
};

/// How PLANE goes to its position.
struct Positioning {
  std::string kind;  ///< MOVE, TURN or STAY
  nc::TiltPreference preference;
  nc::Motion motion = nc::Motion::kFeed;
  double feed = 0.0;
  double distance = 0.0;  ///< DIST, mm: from the tip to the point about which MOVE turns
  size_t distance_offset = 0;
  bool turns_table = false;          ///< TABLE ROT
  bool retracts = false;             ///< MB
  std::optional<double> retraction;  ///< mm; none: MB MAX
};
/// A place for a cycle, as programmed, mm.
struct PatternPoint {
  Vec2 at = Vec2::Zero();
  double height = 0.0;  ///< added to the cycle's surface
};
struct Rows {
  Vec2 first, column_step, line_step;
  int columns, lines;
  double height;
  bool frame;  ///< its outline alone
};

/// Modal words.
struct Modes {
  bool begun = false;
  double feed = 0.0;                              ///< as written; 0: none
  double tool_feed = 0.0;                         ///< F of TOOL CALL, for FAUTO
  double delta_radius = 0.0, delta_corner = 0.0;  ///< DR, DR2 of TOOL CALL, mm
  std::map<int, double> defined_radius;           ///< by TOOL DEF where there is no tool table, mm
  bool shortest = false;                          ///< M126
  bool per_revolution = false;                    ///< M136
  bool rotary_feed_mm = false;                    ///< M116
  bool last_rapid = false;                        ///< the last motion block went at FMAX
};

/// M128, FUNCTION TCPM, PLANE.
struct Orientation {
  bool tcpm = false, path_chosen = false, spatial = false;
  bool path_is_contour = false;
  std::array<double, 3> axial_deg{};  ///< A B C of PLANE AXIAL, which are modal
  bool compensates_heads = false;     ///< M114, M144
  Mat3 tilt = Mat3::Identity();
  bool tilted = false;
};

/// What the next piece of contour counts from, and what waits for it.
struct PathState {
  std::optional<Vec3> centre;
  std::optional<int> centre_normal;  ///< CC X Z: the axis across the plane of the circle, no working plane
  Amount polar_radius, polar_angle;  ///< modal, mm and degrees
  std::optional<Vec3> tangent;       ///< at the end of the last element
  std::optional<Element> held;
  std::optional<Corner> corner;
  std::optional<Approach> approach;
};

struct Drilling {
  std::optional<Cycle> cycle;
  int open_cycle = 0;       ///< the old cycle whose parts are being read
  bool modal_call = false;  ///< M89
  std::vector<PatternPoint> pattern;
  double raised = 0.0;  ///< of the point whose cycle runs, mm
};

/// Shifts, mirror images, rotations, scales: outside of a tilted plane and within it.
struct Frames {
  Level outer, inner;
  Stretch stretch;  ///< of the level that holds
};

struct Executor {
  explicit Executor(nc::Control& machine);

  nc::Control& control;
  Parameters parameters;
  Flow flow;
  Modes modes;
  Orientation orientation;
  PathState path;
  Drilling drilling;
  Frames frames;
};

inline Level& level(Orientation& orientation, Frames& frames) {
  return orientation.tilted ? frames.inner : frames.outer;
}
inline const Level& level(const Orientation& orientation, const Frames& frames) {
  return orientation.tilted ? frames.inner : frames.outer;
}

}  // namespace swarf::program::nc::heidenhain
