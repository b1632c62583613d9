// Sets that hold no leftover material, each convex: value(x) <= 0 inside, a convex function of x. Internal to
// this folder.
#pragma once

#include <array>
#include <cstdint>
#include <variant>

#include "base/frames.h"
#include "measure/sweep_cutters.h"
#include "stock/sweep/sweep.h"

namespace swarf::proof {

/// A height over a feature that bounds the distance to it from below: way . (x - foot) + offset.
struct HeightOver {
  Vec3 way = Vec3::Zero(), foot = Vec3::Zero();
  double offset_mm = 0.0;
  double operator()(const Vec3& x) const { return way.dot(x - foot) + offset_mm; }
};

/// What one piece of a cutter removes: along a line, or at the instant that brings a point nearest.
class SweepSet {
 public:
  SweepSet(const stock::Sweep& sweep, const stock::CutterSolid& cutter, size_t piece, const Vec3& near);
  double value(const Vec3& x) const;

 private:
  const stock::CutterSolid* cutter_;
  size_t piece_;
  Mat3 rows_;           ///< W to the tool's frame
  Vec3 origin_, way_;   ///< of the point x = 0, and what the motion adds; tool frame, mm
  bool moves_ = false;  ///< way_ is not 0
};

/// Places nearer to a facet than to the foot of a height.
struct NearerSet {
  std::array<Vec3, 3> facet;
  HeightOver height;
  double value(const Vec3& x) const;
};

/// Places within a distance of a facet.
struct WithinSet {
  std::array<Vec3, 3> facet;
  double mm = 0.0;
  double value(const Vec3& x) const;
};

/// Beyond a plane: normal . x >= offset.
struct BeyondSet {
  Vec3 normal;
  double offset = 0.0;
  double value(const Vec3& x) const { return offset - normal.dot(x); }
};

using ConvexSet = std::variant<SweepSet, NearerSet, WithinSet, BeyondSet>;
double value(const ConvexSet& set, const Vec3& x);

/// Unit, from differences of the value.
Vec3 gradient(const ConvexSet& set, const Vec3& x);

}  // namespace swarf::proof
