// The tool path in the work frame: passes on a surface and free moves between them, or the blocks of a CL
// program.
#pragma once

#include <string>

#include "base/diagnostics.h"
#include "base/frames.h"
#include "cutter/cutter.h"
#include "program/surface_blocks/program.h"
#include "toolpath/contact_end.h"
#include "toolpath/elements.h"

namespace swarf::toolpath {

struct ToolPath {
  std::string planner;  ///< "constant_scallop" | "lin_koren" | "isoparametric"; "cl" for CL programs
  Elements elements;
  int passes = 0;
  double pass_length_mm = 0.0;  ///< contact length, without links
  double link_length_mm = 0.0;
};

/// True for the path of a CL program: its elements are blocks and nothing else.
bool holds_blocks(const ToolPath& path);

/// Tool pose in contact at a curve point: axis = normal turned by lead (about the cross direction, towards
/// the feed) and tilt (towards the left of the feed). With zero lean the tip is the contact point; leaned,
/// the contact lies on the rim of the flat bottom or on the corner that is rolled about it. `unit_feed` is
/// the direction of travel.
ToolPose pose_in_contact(const Vec3& contact, const Vec3& normal, const Vec3& unit_feed, double lead_rad,
                         double tilt_rad, const ContactEnd& end);

enum class Planner { kConstantScallop, kLinKoren, kIsoparametric };
/// "constant_scallop" and so on; nullptr-safe names for reports and TOML.
const char* planner_name(Planner planner);

struct PlanOptions {
  Planner planner = Planner::kConstantScallop;
  double safe_distance_mm = 5.0;  ///< retract along the tool axis between passes
  double overrun_mm = 1.5;        ///< each pass runs on past the edge of the part by this much
  double rapid_clearance_mm =
      20.0;                   ///< first approach and last retract, above the highest point of the stock
  double stock_top_mm = 0.0;  ///< W, highest point of the stock
  double approach_feed_fraction = 0.5;
};

/// Plans every operation of the program. Alarms of theory 1.6 that need the cutter (saddle or concave without
/// lean, P beyond D R/(R+h)) and operations that cannot be planned go to `diagnostics`.
ToolPath plan(const program::Program& program, const cutter::Cutter& cutter, const PlanOptions& options,
              Diagnostics& diagnostics);

}  // namespace swarf::toolpath
