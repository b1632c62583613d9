#include "stock/rays/ray_height.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "stock/rays/convex_ray.h"
#include "stock/rays/surface_dexels.h"

namespace swarf::stock {
namespace {

constexpr double kMiss = std::numeric_limits<double>::infinity();
/// Candidates lie on the boundary of the swept set; rounding may put them this far outside, mm.
constexpr double kOnBoundary = 1e-9;
/// Squares of lengths or of ratios below this are treated as zero: directions are not defined by them.
constexpr double kDegenerate = 1e-24;
/// Steps square the error: ticks need two or three, long grazing motions with rotation up to eight.
constexpr int kNewtonSteps = 12;
/// After this many steps a contact that still lies this far from half time is not met during the motion.
constexpr int kSettlingSteps = 2;
constexpr double kFarOutside = 0.75;
/// A step shorter than this (mm in s, and as a share of the motion in t) has converged.
constexpr double kConverged = 1e-13;

struct Instant {
  double t, s;
};

/// A flat end: the solid that the closed form knows.
struct Cylinder {
  double radius, height;
};

/// X(t, s) = P + t D + s N + t s E.
struct Bilinear {
  Vec3 P, D, N, E;
  Vec3 at(const Instant& i) const { return P + i.t * D + i.s * N + (i.t * i.s) * E; }
  /// The same map with t s E replaced by its tangent at `i`.
  Bilinear linearised(const Instant& i) const {
    return {P - (i.t * i.s) * E, D + i.s * E, N + i.t * E, Vec3::Zero()};
  }
};

struct Interval {
  double low = -kMiss, high = kMiss;
  void clip(double a, double b) {
    low = std::max(low, std::min(a, b));
    high = std::min(high, std::max(a, b));
  }
  bool empty() const { return !(low <= high); }
};

/// Both roots of |U + x V| = radius in the xy plane, ascending. `or_nearest`: a line that misses the circle
/// yields its point nearest to it twice.
std::optional<Interval> circle_crossings(const Vec2& U, const Vec2& V, double radius, bool or_nearest) {
  const double a = V.squaredNorm();
  if (a < kDegenerate) return std::nullopt;
  const double b = U.dot(V);
  const double closest2 = std::pow(U.x() * V.y() - U.y() * V.x(), 2) / a;  // without cancellation
  const double half2 = radius * radius - closest2;
  if (half2 < 0.0 && !or_nearest) return std::nullopt;
  const double half = std::sqrt(std::max(half2, 0.0) / a);
  return Interval{-b / a - half, -b / a + half};
}

/// Where the line A + s B enters the standing cutter.
double entry_of_pose(const Vec3& A, const Vec3& B, const Cylinder& cutter) {
  Interval inside;
  if (B.z() * B.z() > kDegenerate) {
    inside.clip(-A.z() / B.z(), (cutter.height - A.z()) / B.z());
  } else if (A.z() < 0.0 || A.z() > cutter.height) {
    return kMiss;
  }
  const auto flank = circle_crossings(A.head<2>(), B.head<2>(), cutter.radius, false);
  if (flank) {
    inside.clip(flank->low, flank->high);
  } else if (A.head<2>().norm() > cutter.radius || B.head<2>().squaredNorm() >= kDegenerate) {
    return kMiss;  // beside the cutter, parallel to its axis or passing it
  }
  return inside.empty() ? kMiss : inside.low;
}

/// The ways to meet the rim of the disc at z = level (branches 0 and 1) and to graze the flank.
enum class Contact { kBottomRim, kTopRim, kFlank };

/// The point (t, s) of a linear map with X_z = level and |X_xy| = radius.
std::optional<Instant> rim_contact(const Bilinear& m, double level, double radius, int branch) {
  const double dz = m.D.z(), nz = m.N.z();
  const double norm2 = dz * dz + nz * nz;
  if (norm2 < kDegenerate) return std::nullopt;
  // The line dz t + nz s = level - Pz, by the parameter x along (nz, -dz).
  const double offset = (level - m.P.z()) / norm2;
  const Instant base{offset * dz, offset * nz};
  const Vec2 U = (m.P + base.t * m.D + base.s * m.N).head<2>();
  const Vec2 V = (nz * m.D - dz * m.N).head<2>();
  // While Newton is under way the tangent may miss the rim that the true line meets; the end is checked.
  const auto crossings = circle_crossings(U, V, radius, true);
  if (!crossings) return std::nullopt;
  const double x = branch == 0 ? crossings->low : crossings->high;
  return Instant{base.t + x * nz, base.s - x * dz};
}

/// The point (t, s) of a linear map on the flank where the motion is tangent to it: the ray grazes the sweep.
std::optional<Instant> flank_contact(const Bilinear& m, double radius, int branch) {
  const Vec2 U = m.P.head<2>(), V = m.N.head<2>(), W = m.D.head<2>();
  const double travel2 = W.squaredNorm();
  if (travel2 < kDegenerate) return std::nullopt;
  const Vec2 across = Vec2(-W.y(), W.x()) / std::sqrt(travel2);
  const double rate = across.dot(V);
  if (rate * rate < kDegenerate) return std::nullopt;
  const double s = ((branch == 0 ? radius : -radius) - across.dot(U)) / rate;
  return Instant{-(U + s * V).dot(W) / travel2, s};
}

std::optional<Instant> contact(const Bilinear& m, Contact kind, int branch, const Cylinder& cutter) {
  switch (kind) {
    case Contact::kBottomRim:
      return rim_contact(m, 0.0, cutter.radius, branch);
    case Contact::kTopRim:
      return rim_contact(m, cutter.height, cutter.radius, branch);
    case Contact::kFlank:
      return flank_contact(m, cutter.radius, branch);
  }
  return std::nullopt;
}

/// The candidate's s when it belongs to the swept set.
double height_of_contact(const Bilinear& map, const Instant& guess, Contact kind, int branch,
                         const Cylinder& cutter) {
  const bool translation = map.E == Vec3::Zero();
  Instant at = guess;
  for (int step = 0; step < (translation ? 1 : kNewtonSteps); ++step) {
    const auto next = contact(map.linearised(at), kind, branch, cutter);
    if (!next) return kMiss;
    const bool converged = std::abs(next->t - at.t) + std::abs(next->s - at.s) < kConverged;
    at = *next;
    if (converged) break;
    if (step >= kSettlingSteps && std::abs(at.t - 0.5) > kFarOutside) return kMiss;
    at.t =
        std::clamp(at.t, 0.0, 1.0);  // the contact is sought here; the map's tangent is useless far outside
  }
  if (!(at.t >= 0.0 && at.t <= 1.0)) return kMiss;
  const Vec3 X = map.at(at);
  const bool inside = X.z() >= -kOnBoundary && X.z() <= cutter.height + kOnBoundary &&
                      X.head<2>().norm() <= cutter.radius + kOnBoundary;
  return inside ? at.s : kMiss;
}

double lowest_contact(const Bilinear& map, const Instant& guess, const Cylinder& cutter) {
  double lowest = kMiss;
  for (const Contact kind : {Contact::kBottomRim, Contact::kTopRim, Contact::kFlank}) {
    for (int branch = 0; branch < 2; ++branch) {
      lowest = std::min(lowest, height_of_contact(map, guess, kind, branch, cutter));
    }
  }
  return lowest;
}

/// Where the ray is closest to the tip at half time.
double height_near_tip(const Bilinear& map) {
  const Vec3 A = map.P + 0.5 * map.D, B = map.N + 0.5 * map.E;
  const double span2 = B.squaredNorm();
  return span2 > kDegenerate ? -A.dot(B) / span2 : 0.0;
}

/// The usual case: a ray that leaves on the tool's side meets the bottom disc itself at both ends. The disc's
/// plane bounds the cutter from below and its height is monotone in t, so the lower end is the answer.
std::optional<double> height_on_disc(const Vec3& P, const Vec3& N, const Vec3& P1, const Vec3& N1,
                                     double radius) {
  constexpr double kFlattest = 0.01;  // below, the quotient loses digits; the general way has no such limit
  if (!(std::min(N.z(), N1.z()) > kFlattest)) return std::nullopt;
  const double s = -P.z() / N.z(), s1 = -P1.z() / N1.z();
  const double radius2 = radius * radius;
  const bool inside =
      (P + s * N).head<2>().squaredNorm() <= radius2 && (P1 + s1 * N1).head<2>().squaredNorm() <= radius2;
  return inside ? std::optional(std::min(s, s1)) : std::nullopt;
}

double lowest_of_cylinder(const Vec3& point, const Vec3& normal, const SweepMap& sweep,
                          const Cylinder& cutter) {
  const Vec3 P = sweep.start(point), P1 = sweep.end(point);
  const Vec3 N = sweep.R0t * normal, N1 = sweep.R1t * normal;
  if (const auto height = height_on_disc(P, N, P1, N1, cutter.radius)) return *height;
  const Bilinear map{P, P1 - P, N, sweep.R0t == sweep.R1t ? Vec3(Vec3::Zero()) : Vec3(N1 - N)};
  double best = std::min(entry_of_pose(P, N, cutter), entry_of_pose(P1, N1, cutter));
  // With rotation Newton needs a start nearby: the lower end, or the tip where neither end is met.
  const Instant guess{0.5, best < kMiss ? best : height_near_tip(map)};
  best = std::min(best, lowest_contact(map, guess, cutter));
  return best;
}

/// Lowest s of the piece's sweep; pieces above `highest` need not be told from a miss.
double lowest_of_piece(const Vec3& point, const Vec3& direction, const SweepMap& map,
                       const cutter::ConvexPiece& piece, double highest) {
  if (piece.is_cylinder()) return lowest_of_cylinder(point, direction, map, {piece.radius, piece.high});
  return lowest_in_sweep(piece, point, direction, map, highest);
}

}  // namespace

double ray_height(const Vec3& point, const Vec3& normal, const SweepMap& map, const CutterSolid& cutter,
                  double highest) {
  double lowest = kMiss;
  for (const cutter::ConvexPiece& piece : cutter.pieces) {
    lowest = std::min(lowest, lowest_of_piece(point, normal, map, piece, std::min(lowest, highest)));
  }
  return lowest;
}

double ray_height(const Vec3& point, const Vec3& normal, const Sweep& sweep, const CutterSolid& cutter) {
  return ray_height(point, normal, sweep_map(sweep), cutter);
}

RayInterval ray_interval(const Vec3& point, const Vec3& normal, const SweepMap& map,
                         const cutter::ConvexPiece& piece) {
  const double low = lowest_of_piece(point, normal, map, piece, kMiss);
  if (low == kMiss) return {};
  // The ray touches the sweep, so its far end cannot be missed; rounding may, at a point of tangency.
  const double high = -lowest_of_piece(point, -normal, map, piece, kMiss);
  return {low, std::max(low, high)};
}

}  // namespace swarf::stock
