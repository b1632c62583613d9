// The axis surface of a pass as one smooth curve of poses: what a control follows without blocks.
#pragma once

#include <memory>

#include "base/cubic_spline.h"
#include "base/diagnostics.h"
#include "flank/feed.h"
#include "toolpath/pose_curve.h"

namespace swarf::flank {

struct AxisCurve {
  std::shared_ptr<const toolpath::PoseCurve> curve;
  CubicSpline u_of_way;  ///< ruling by the way of the tip, mm
};

/// The coarsest of 16, 32 .. 4096 equal intervals whose splines stay within stray_mm of the axis surface, in
/// terms of e: looked at on three places of each interval. Coarse knots keep the jerk low where the surface's
/// second derivatives jump (the knots of a cubic B-spline). Throws InputError "too-many-blocks" at `where`
/// beyond.
AxisCurve axis_curve(const FlankTask& task, const AxisFamily& family, double stray_mm,
                     const SourceLocation& where);

}  // namespace swarf::flank
