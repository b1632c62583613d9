// A point of the work as a part of the tool passes it, and what the flutes have taken there. Internal to this
// folder.
#pragma once

#include <algorithm>
#include <limits>

#include "stock/contact/contact_finder.h"
#include "stock/sweep/convex_motion.h"

namespace swarf::stock {

constexpr double kExactGap = 1e-3;  // voxels: of distances of grid points
constexpr int kHalvings = 20;

/// The tool's frame at an instant of the sweep.
struct Frame {
  Mat3 rows;
  Vec3 tip;
  Vec3 work(const Vec3& X) const { return tip + rows.transpose() * X; }
};
inline Frame frame_at(const SweepMap& map, double t) {
  Mat3 rows = (1.0 - t) * map.R0t + t * map.R1t;
  const Vec3 z = rows.row(2).normalized();
  const Vec3 x0 = rows.row(0);
  const Vec3 x = (x0 - x0.dot(z) * z).normalized();
  rows.row(0) = x;
  rows.row(1) = z.cross(x);
  rows.row(2) = z;
  return {rows, (1.0 - t) * map.tip0 + t * map.tip1};
}

/// A grid point or any other as it passes the part.
class Passage {
 public:
  Passage(const SweepMap& map, const RevolvedPart& part, const Vec3& point, double gap)
      : part_(part),
        start_(map.start(point)),
        way_(map.end(point) - start_),
        nearest_(part.nearest(start_, way_, gap)) {}

  double least() const { return nearest_.value; }
  double least_t() const { return nearest_.t; }
  Vec3 at(double t) const { return start_ + t * way_; }
  double distance(double t) const { return part_.at(at(t)).value; }
  /// First and last t with a distance of at most `value`, which the least does not exceed.
  double first(double value) const { return border(0.0, value); }
  double last(double value) const { return border(1.0, value); }

 private:
  double border(double outer, double value) const {
    if (distance(outer) <= value) return outer;
    double inner = nearest_.t;
    for (int step = 0; step < kHalvings; ++step) {
      const double middle = 0.5 * (outer + inner);
      (distance(middle) <= value ? inner : outer) = middle;
    }
    return inner;
  }

  const RevolvedPart& part_;
  Vec3 start_, way_;
  RevolvedPart::Nearest nearest_;
};

/// How far a point lies inside what the flutes have taken until then, mm; negative outside.
inline double taken(const OwnCut& own, const Vec3& point, double t) {
  const Vec3 start = own.map.start(point);
  const Vec3 way = own.map.end(point) - start;
  double depth = -std::numeric_limits<double>::infinity();
  for (const cutter::ConvexPiece& piece : own.cutter->pieces) {
    depth = std::max(depth, -nearest_instant(piece, start, way, 0.0, own.with_the_part ? t : 1.0).value);
  }
  return depth;
}

}  // namespace swarf::stock
