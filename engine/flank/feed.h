// How fast a flank may pass each ruling: the control moves the tool along chords, one each cycle, and a chord
// lies beside the axis surface. Bisection on the error of that chord (Chu et al., s. 3; theory 5).
#pragma once

#include <array>
#include <functional>

#include "base/cubic_spline.h"
#include "flank/placement.h"

namespace swarf::flank {

/// (2/T) sqrt(2 R e - e^2): where a chord of one cycle lies e beside a circle of radius R. mm, s, mm/s.
double sagitta_feed(double radius_mm, double period_s, double error_mm);

/// The poses of all rulings, splined once: what is asked often.
class AxisFamily {
 public:
  /// 2049 rulings from u_low to u_high; parallel.
  explicit AxisFamily(const FlankTask& task);
  ToolPose pose(double u) const;
  /// Way of the tip, mm per unit of u.
  double tip_rate(double u) const;

 private:
  double u_low_, u_high_;
  std::array<CubicSpline, 6> values_;  ///< tip xyz, axis ijk
};

/// Half way between two poses as a control moves them: tips and axes linearly.
ToolPose between(const ToolPose& a, const ToolPose& b, double share = 0.5);

/// Where the tool is half way between two poses of a control's cycles; null: between(). On a machine the axes
/// go evenly, which with rotary ones is another place.
using ChordMiddle = std::function<ToolPose(const ToolPose& from, const ToolPose& to)>;

/// e of the chord of this length about u that a cycle makes.
AxisError chord_error(const FlankTask& task, const AxisFamily& family, double u, double chord_mm,
                      const ChordMiddle& middle = nullptr);

/// The greatest speed of the tip, at most `most_mm_s`, at which the chord of a cycle keeps |e| within the
/// limit; so does every slower one (|placement + k V^2| is convex in V^2). 0: the placement alone exceeds it.
double bisected_feed(const FlankTask& task, const AxisFamily& family, double u, double period_s,
                     double limit_mm, double most_mm_s, const ChordMiddle& middle = nullptr);

/// The same by curvature alone: the lesser sagitta_feed of both guide curves, in terms of the tip's speed.
double curvature_feed(const FlankTask& task, const AxisFamily& family, double u, double period_s,
                      double limit_mm, double most_mm_s);

/// A guide curve of the surface: v = 0 or 1.
struct GuideFigures {
  double length_mm = 0.0;
  double radius_min_mm = 0.0, radius_min_u = 0.0;  ///< least radius of curvature; infinity: it is straight
};
GuideFigures guide_figures(const surface::Surface& surface, double v);

}  // namespace swarf::flank
