// Guides whose tool axis follows the part: the normal where the upright tool rests, leaned by lead and tilt.
//
//   1. Along the guide the upright tool is set down (theory 3): contact normal n, direction of travel f.
//   2. axis = cos(lead) (cos(tilt) n + sin(tilt) n x f) + sin(lead) f
//   3. Axis and height of the upright tip become control points of a uniform cubic B-spline, a quarter of
//      the smoothed length apart: the axis turns through creases and steps at a limited rate, twice
//      differentiable. On a circle it is the exact normal but for (step angle / 2 pi)^4.
//   4. The lines run along that axis through the guide's point in XY at that height plus the pivot. What
//      the tool rests on is found along them, exactly, whatever the axis has become.
#pragma once

#include <memory>
#include <vector>

#include "base/diagnostics.h"
#include "toolpath/driven/driven_pass.h"

namespace swarf::toolpath {

struct LeanOptions {
  double lead_rad = 0.0, tilt_rad = 0.0;
  double smooth_mm = 1.0;  ///< above 0
};

/// Unit tool axis and height (mm in W) by a parameter from 0 to end(): uniform cubic B-splines.
class LeanCurve {
 public:
  struct Place {
    Vec3 axis_W = Vec3::UnitZ();
    double height = 0.0;
  };
  /// `places` at even distances from 0 to end, at least two.
  LeanCurve(const std::vector<Place>& places, double end);
  Place at(double x) const;

 private:
  std::vector<Place> control_;  ///< one more before the first place and one after the last
  double step_ = 1.0;
};

/// A guide curve in XY with the axis of a lean curve, which begins `offset_mm` before it.
class LeanedGuide final : public Guide {
 public:
  LeanedGuide(GuideCurve curve, std::shared_ptr<const LeanCurve> lean, double offset_mm, double pivot_mm)
      : curve_(std::move(curve)), lean_(std::move(lean)), offset_mm_(offset_mm), pivot_mm_(pivot_mm) {}
  position::GuideLine line(double x) const override;
  double end() const override { return curve_.end(); }
  std::vector<double> joints() const override { return curve_.joints(); }

 private:
  GuideCurve curve_;
  std::shared_ptr<const LeanCurve> lean_;
  double offset_mm_, pivot_mm_;
};

/// Radius of the profile's corner, mm: about a point so high above the tip the tool is leaned. A ball's
/// centre therefore stays where that of the upright ball is.
double pivot_height(const position::ToolProfile& profile);

/// The lean over guides that follow each other without a gap. Throws InputError "guide-misses-part" where
/// the upright tool rests on nothing, "axis-too-low" where the axis comes within 5 deg of level.
std::shared_ptr<const LeanCurve> lean_curve(const DrivenPart& on, const std::vector<GuideCurve>& chain,
                                            const LeanOptions& options, const SourceLocation& where);

}  // namespace swarf::toolpath
