// Machining modes without CAM (Kato et al., Fig. 2 "machining mode"): the guides of a part's passes, and the
// path that the surface drives along them. For comparison the same as a CAM system would write it.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "toolpath/driven/driven_pass.h"
#include "toolpath/tool_path.h"

namespace swarf::toolpath {

enum class GuideMode {
  kScan,     ///< parallel lines at an angle
  kContour,  ///< parallels to the border of the area, from outside in
  kSpiral,   ///< Archimedes' spiral round a centre
  kGuide,    ///< one curve through given points
};

/// Guides lie in W's XY plane, turned by the shortest way until its Z is the axis (position::turned_line).
struct DrivenPlan {
  Vec3 axis_W = Vec3::UnitZ();  ///< unit: of the tool while it does not follow the part
  bool follows = false;         ///< the part's normal, leaned by lead and tilt; the guides then lie in XY
  double lead_rad = 0.0, tilt_rad = 0.0;  ///< towards the feed and to its left
  double axis_smooth_mm = 0.0;            ///< the normals are averaged over this length of the guide; above 0
  GuideMode mode = GuideMode::kScan;
  std::array<Vec2, 2> area{Vec2::Zero(), Vec2::Zero()};  ///< lower and upper corner, mm in the guides' plane
  double interval_mm = 1.0;                              ///< greatest distance of two passes, in the plane
  double angle_rad = 0.0;                                ///< kScan: of the lines from X
  bool zigzag = true;                                    ///< kScan: else each line in the same direction
  Vec2 centre = Vec2::Zero();
  double radius_from_mm = 0.0, radius_to_mm = 0.0;  ///< kSpiral
  std::vector<Vec2> guide;                          ///< kGuide, at least two points
  double feed_mm_s = 0.0;
  double chord_tolerance_mm = 1e-4;
  std::vector<OverrideChange> overrides;  ///< of the passes, in the order of time
  double spindle_rpm = 0.0;
  /// Above 0: not driven by the surface, but by the straight blocks that stay this close to it.
  double cam_tolerance_mm = 0.0;
  double safe_distance_mm = 5.0;        ///< above the stock, between passes and before the approach
  double rapid_clearance_mm = 20.0;     ///< above the stock, first and last
  double stock_top_mm = 0.0;            ///< along axis_W from the origin of W
  double approach_feed_fraction = 0.5;  ///< of the feed
};

/// Guides of the passes in their order; those that `joined` names begin where the one before has ended.
struct GuidedPass {
  GuideCurve curve;
  bool joined = false;
  int pass = 0;
};
/// "area-too-small" when no guide fits in the area.
std::vector<GuidedPass> guided_passes(const DrivenPlan& plan, Diagnostics& diagnostics);

/// The path over the part, with approach, links and retract. `where` is named by messages.
ToolPath driven_path(const DrivenPlan& plan, const std::shared_ptr<const DrivenPart>& on,
                     const SourceLocation& where, Diagnostics& diagnostics);

}  // namespace swarf::toolpath
