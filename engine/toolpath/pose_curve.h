// A motion of the tool as one smooth curve: what a control follows cycle by cycle where no chords of blocks
// lie between (BlockLaw::kCurve).
#pragma once

#include <array>
#include <memory>
#include <span>

#include "base/cubic_spline.h"
#include "base/frames.h"

namespace swarf::toolpath {

/// Tip and axis over the way s of the tip, mm: cubic splines on one even grid, twice continuously
/// differentiable. The axis is the direction of the splined vectors.
class PoseCurve {
 public:
  /// poses[i] stands at s = i * step_mm; at least four, neighbours less than half a radian apart.
  PoseCurve(double step_mm, std::span<const ToolPose> poses);

  ToolPose pose(double s) const;
  double length_mm() const { return step_ * static_cast<double>(intervals_); }

  /// Over a stretch, per mm of s; they hold everywhere on it.
  struct Bounds {
    double tip_rate = 0.0, tip_bend = 0.0;    ///< of |p'|, |p''|
    double axis_rate = 0.0, axis_bend = 0.0;  ///< of |a'|, |a x a''|
  };
  /// |p''| is greatest at a knot or at an end, for p'' is linear between knots; |p'| grows at most by it.
  /// With a = d/|d| and m <= |d|: |a'| <= |d'|/m, |a x a''| <= |d''|/m + 2 |d'|^2/m^2.
  Bounds bounds(double from, double to) const;

 private:
  struct Rates {
    Vec3 tip, tip_bend, axis, axis_bend;
  };
  Rates rates(double s) const;

  double step_ = 1.0;
  size_t intervals_ = 0;
  double shortest_ = 1.0;              ///< m of the whole curve
  std::array<CubicSpline, 6> values_;  ///< tip xyz, axis ijk
};

/// The stretch of a curve that a block follows.
struct CurveSpan {
  std::shared_ptr<const PoseCurve> curve;
  double from = 0.0, to = 0.0;  ///< s, from < to
};

/// One block goes on along the curve where the other has ended.
inline bool continues(const CurveSpan& before, const CurveSpan& next) {
  return before.curve == next.curve && before.to == next.from;
}

}  // namespace swarf::toolpath
