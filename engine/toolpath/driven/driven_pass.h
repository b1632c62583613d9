// A pass that the surface itself drives (Kato et al.): a guide says along which line the tool is set down,
// the part how far. There is no tolerance in it: every place of the path is the exact position of the tool.
#pragma once

#include <memory>
#include <vector>

#include "base/frames.h"
#include "position/part.h"
#include "surface/surface.h"
#include "toolpath/driven/guide_curve.h"

namespace swarf::toolpath {

/// Lines that the tool is set down along, by a parameter x from 0 to end().
class Guide {
 public:
  virtual ~Guide() = default;
  virtual position::GuideLine line(double x) const = 0;
  virtual double end() const = 0;
  /// Parameters where the lines may turn off at an angle.
  virtual std::vector<double> joints() const = 0;
};

/// A curve in the plane square to a fixed axis.
class PlaneGuide final : public Guide {
 public:
  /// `plane`: point_W is the curve's origin, x_W and y_W its directions.
  PlaneGuide(GuideCurve curve, const position::GuideLine& plane) : curve_(std::move(curve)), plane_(plane) {}
  position::GuideLine line(double x) const override;
  double end() const override { return curve_.end(); }
  std::vector<double> joints() const override { return curve_.joints(); }

 private:
  GuideCurve curve_;
  position::GuideLine plane_;
};

/// What all passes of a job set down, and on what.
struct DrivenPart {
  position::Part part;
  position::ToolProfile profile;
};

/// What the operator turns the override to.
struct OverrideChange {
  int pass = 0;        ///< 0-based count of passes
  double at_s = 0.0;   ///< since the pass began
  double share = 1.0;  ///< of the feed from then on; 0: feed hold
};

struct DrivenPass {
  std::shared_ptr<const DrivenPart> on;
  std::shared_ptr<const Guide> guide;
  double feed_mm_s = 0.0;
  double chord_tolerance_mm = 1e-4;  ///< of the chords between two cycles: limits the speed in curves
  int pass = 0;                      ///< 0-based count of passes
  std::vector<OverrideChange> overrides = {};  ///< of this pass, in the order of time

  /// The share of the feed at a time since the pass began.
  double override_at(double time_s) const {
    double share = 1.0;
    for (const OverrideChange& change : overrides)
      if (change.at_s <= time_s) share = change.share;
    return share;
  }
};

/// The tool at rest on one line of a pass.
struct TipPoint {
  ToolPose pose;
  position::Rest rest;
};
/// `near` is where the part was touched last.
TipPoint tip_at(const DrivenPass& pass, double x, position::Near& near);

}  // namespace swarf::toolpath
