// From a pass to the next one, point by point on the grid: what all walks have in common.
#pragma once

#include <vector>

#include "toolpath/area.h"

namespace swarf::toolpath {

enum class PointOutcome : uint8_t {
  kSolved,
  kFootOutside,  ///< the matching point of the previous pass lies beyond the grid
  kFailed,       ///< no such point
};

/// The new graph at the grid's abscissae, and for each point the parameter of its match on the previous pass.
struct GridPoints {
  explicit GridPoints(int n) : w(n, 0.0), foot(n, 0.0), outcome(n, PointOutcome::kFailed) {}
  std::vector<double> w, foot;
  std::vector<PointOutcome> outcome;
};

/// The next pass, or why there is none and where.
struct NextPass {
  enum Outcome { kOk, kFolds, kNoPoint } outcome = kOk;
  double t = 0.0;  ///< where it went wrong
  CubicSpline w;
};

/// Makes a graph of solved points. Where there is none (the previous pass was too short to answer, or lies
/// beyond the last boundary already, where no pass is needed) the advance across the surface is continued
/// linearly from the solved points: that part lies in the margin, and any smooth continuation serves there.
/// Fails where a point that is needed has no solution, or where the matching points do not follow each other
/// in order (the path folds over itself).
NextPass graph_of(const Area& area, const CubicSpline& previous, const GridPoints& points);

}  // namespace swarf::toolpath
