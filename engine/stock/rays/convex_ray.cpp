#include "stock/rays/convex_ray.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "stock/sweep/convex_motion.h"

namespace swarf::stock {
namespace {

constexpr double kRayMiss = std::numeric_limits<double>::infinity();
/// Distance (mm) at which the sweep counts as met: a few times what nearest_instant leaves open.
constexpr double kMet = 5e-12;
/// Newton squares the error; only a ray that grazes the sweep takes more steps, halving the error each time.
constexpr int kStepsBeforeSplit = 8;
constexpr int kMostRaySteps = 100;
/// Parts shorter than this share of the motion are not split: their slopes agree to a millionth.
constexpr double kShortestPart = 1e-6;

/// X(t, s) = P + t D + s (N + t E).
struct SlabPassage {
  const cutter::ConvexPiece& piece;
  Vec3 P, D, N, E;

  Vec3 normal_at(double t) const { return N + t * E; }
  Nearest nearest(double s, double t0, double t1) const {
    return nearest_instant(piece, P + s * N, D + s * E, t0, t1);
  }
};

/// A height below all that the piece can reach. It lies in a ball about a point c of its axis; with b the
/// mean direction of the ray, b . (X - c) >= -radius, and b . N(t) lies between cos(theta / 2) and 1.
double below_all(const SlabPassage& passage) {
  const cutter::ConvexPiece& piece = passage.piece;
  const Vec3 c(0.0, 0.0, 0.5 * (piece.low + piece.high));
  const double radius = std::hypot(piece.radius, 0.5 * (piece.high - piece.low));
  const Vec3 mean = passage.N + 0.5 * passage.E;
  const double cosine = mean.norm();
  SWARF_CHECK(cosine > 1e-6, "a sweep turns the axis by less than half a turn");
  const Vec3 b = mean / cosine;
  const double clear = b.dot(c) - radius - std::max(b.dot(passage.P), b.dot(passage.P) + b.dot(passage.D));
  return clear < 0.0 ? clear / cosine : clear;
}

/// Lowest s in [s, highest) that the part [t0, t1] of the motion covers.
double lowest_in_part(const SlabPassage& passage, double t0, double t1, double s, double highest) {
  const bool splittable = !passage.E.isZero(0.0) && t1 - t0 > kShortestPart;
  for (int step = 0; step < (splittable ? kStepsBeforeSplit : kMostRaySteps); ++step) {
    const Nearest nearest = passage.nearest(s, t0, t1);
    if (nearest.value <= kMet) return s;
    const double slope =
        std::min(nearest.normal.dot(passage.normal_at(t0)), nearest.normal.dot(passage.normal_at(t1)));
    if (slope >= 0.0) return kRayMiss;
    const double next = s - nearest.floor / slope;
    if (next >= highest) return kRayMiss;
    if (next == s) return s;
    s = next;
  }
  if (!splittable) return s;
  const double middle = 0.5 * (t0 + t1);
  const double first = lowest_in_part(passage, t0, middle, s, highest);
  return std::min(first, lowest_in_part(passage, middle, t1, s, std::min(first, highest)));
}

/// Whether the ray keeps off the sweep all the way up to `highest`: it is outside there, and on the way down
/// no nearer to the tangent plane of what is nearest, so F >= floor + (s - highest) n . N(t) > 0.
bool stays_above(const SlabPassage& passage, double highest) {
  if (!std::isfinite(highest)) return false;
  const Nearest nearest = passage.nearest(highest, 0.0, 1.0);
  return nearest.floor > kMet && nearest.normal.dot(passage.normal_at(0.0)) <= 0.0 &&
         nearest.normal.dot(passage.normal_at(1.0)) <= 0.0;
}

}  // namespace

double lowest_in_sweep(const cutter::ConvexPiece& piece, const Vec3& point, const Vec3& direction,
                       const SweepMap& map, double highest) {
  const Vec3 P = map.start(point), N = map.R0t * direction;
  const bool translation = map.R0t == map.R1t;
  const SlabPassage passage{piece, P, map.end(point) - P, N,
                            translation ? Vec3(Vec3::Zero()) : Vec3(map.R1t * direction - N)};
  if (stays_above(passage, highest)) return kRayMiss;
  return lowest_in_part(passage, 0.0, 1.0, below_all(passage), highest);
}

}  // namespace swarf::stock
