// Where the axis of a flank mill stands on a ruled surface (theory 5, Chu et al. Eq. 2).
//
//      A1 = C1 + rho(c1) N1     the ball at c0 above the tip touches guide curve 0, the one at c1 guide curve
//      1: |                        the paper's placement. On a twisted ruling it cuts too deep between (E18).
//      A0 = C0 + rho(c0) N0
//      |
//     tip = A0 - c0 a,  a = (A1 - A0) / |A1 - A0|,  c1 = c0 + |A1 - A0|
//
// The envelope of the moving flank is that of the balls along all axes. Where an axis lies at A(u, c), the
// envelope is nearest to the surface, or deepest in it, by
//
//     e(u, c) = dist(A(u, c), S) - rho(c),
//
// which needs no velocity and no neighbour. So the greatest error of an axis surface is the greatest of what
// each of its axes has alone, and the best axis surface consists of the best axis of each ruling.
#pragma once

#include <string>
#include <vector>

#include "base/frames.h"
#include "flank/flank_profile.h"
#include "surface/surface.h"

namespace swarf::flank {

enum class Placement {
  kPublished,  ///< "published": on both guide curves (Eq. 2)
  kBalanced,   ///< "balanced": both ends lifted off along their normals until over- and undercut are equal
  kMinimax     ///< "minimax": and turned about the normal at mid ruling: the least maximum
};
const char* placement_name(Placement placement);
std::vector<std::string> placement_names();

/// What is to be milled with what. The surface must be linear in v (measure::is_ruled); the tool's tip is on
/// the side of guide curve 0 (v = 0), its shank on that of curve 1.
struct FlankTask {
  surface::SurfacePtr surface;
  FlankProfile profile;
  Placement placement = Placement::kMinimax;
  double tip_below_mm = 1.0;  ///< c0: the tip reaches this far below guide curve 0; below 0: it ends above it
  double lift_low_mm = 0.0,
         lift_high_mm = 0.0;         ///< off the placement, along the normals at both guide curves
  double u_low = 0.0, u_high = 1.0;  ///< rulings of the pass: beyond [0,1] where it overruns
};

/// The foot of the perpendicular from a point on the surface, from a place nearby.
struct Foot {
  double u = 0.0, v = 0.0;
  double distance_mm = 0.0;  ///< along the outward normal
  Vec3 normal = Vec3::Zero();
};
/// Newton's method on |S - x|^2; u and v may leave [0,1] where the surface continues.
Foot foot_of(const surface::Surface& surface, const Vec3& x, double u, double v);

/// The error of a standing or passing axis between both guide curves.
struct AxisError {
  double least_mm = 0.0, greatest_mm = 0.0;  ///< below 0: too deep
  double least_v = 0.0, greatest_v = 0.0;    ///< where along the ruling
  double most_mm() const { return greatest_mm > -least_mm ? greatest_mm : -least_mm; }
};

/// The pose of the ruling at u.
ToolPose pose_at(const FlankTask& task, double u);

/// e(u, c) of a pose near the ruling at u, where the foot lies between both guide curves and the flank
/// reaches: at kErrorPlaces places along the axis, the extremes refined by a parabola.
AxisError axis_error(const FlankTask& task, const ToolPose& pose, double u);
inline constexpr int kErrorPlaces = 33;

/// What the published axis cuts too deep at least, half way along the ruling at u, whatever the feed (E18):
/// with balls r0 and r1 at both guide curves its middle lies |r0 N0 + r1 N1| / 2 above that of the ruling,
/// and the flank there is (r0 + r1) / 2 thick, or more (barrel). r (1 - cos(psi / 2)) for a cylinder. mm
double twist_bound(const FlankTask& task, double u);

/// The greatest |e| of all rulings: of 257, and the crest between the neighbours of the worst.
struct WorstError {
  double mm = 0.0;  ///< with its sign
  double u = 0.0, v = 0.0;
};
WorstError worst_error(const FlankTask& task);

}  // namespace swarf::flank
