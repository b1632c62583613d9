// The rigid motion that brings a measured part onto its design.
#pragma once

#include <span>
#include <utility>

#include "mesh/signed_distance.h"

namespace swarf::measure {

struct Alignment {
  Pose X_design_stock = Pose::Identity();    ///< from the stock's frame to the design's
  double rms_before_mm = 0.0, rms_mm = 0.0;  ///< of the pairs, or of the points over the stock
  size_t points = 0;
  int steps = 0;  ///< that best_fit() took
};

/// A point of the stock and the point of the design that it is to lie on, mm.
using PointPair = std::pair<Vec3, Vec3>;

/// Least squares over three pairs or more (Umeyama 1991, without scale). Throws InputError "points-on-a-line"
/// when the turn about a line would be left open.
Alignment align_points(std::span<const PointPair> pairs);

/// Least squares of the distances between kFitPoints points of the stock, spread evenly over its area, and
/// the design, each along the normal at its foot (Chen & Medioni 1992), from `start` on. What the shapes
/// leave open (a turned part about its axis, a plane along itself) stays as it is. Throws InputError
/// "no-best-fit" where it does not come to rest.
Alignment best_fit(const mesh::SignedDistance& stock, const mesh::SignedDistance& design, const Pose& start);
inline constexpr size_t kFitPoints = 8000;

/// The mesh moved.
TriMesh moved(const TriMesh& mesh, const Pose& pose);

}  // namespace swarf::measure
