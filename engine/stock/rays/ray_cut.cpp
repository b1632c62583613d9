#include "stock/rays/ray_cut.h"

#include <algorithm>
#include <limits>

#include "stock/rays/convex_ray.h"
#include "stock/rays/surface_dexels.h"
#include "stock/sweep/convex_motion.h"

namespace swarf::stock {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// The piece at one end of the sweep holds the point: all from the cut's lower end up to there is gone.
bool covers(const SweepMap& map, const cutter::ConvexPiece& piece, const Vec3& point) {
  const auto holds = [&](const Vec3& X) {
    if (X.z() < piece.low || X.z() > piece.high || X.head<2>().squaredNorm() > piece.radius * piece.radius) {
      return false;
    }
    return piece.is_cylinder() || cutter::signed_distance(piece, X.head<2>().norm(), X.z()) <= 0.0;
  };
  return holds(map.start(point)) || holds(map.end(point));
}

/// The highest point of the ray in the piece's sweep, which the ray is known to meet. A ray that leaves a
/// cylinder through its top disc at both ends is the usual case: the disc's plane bounds the cutter from
/// above and its height is monotone in time.
double exit_height(const RayPassage& ray, const cutter::ConvexPiece& piece) {
  if (piece.is_cylinder()) {
    constexpr double kFlattest = 0.01;  // as in ray_height
    const Vec3 P0 = ray.map.start(ray.point), P1 = ray.map.end(ray.point);
    const Vec3 N0 = ray.map.R0t * ray.normal, N1 = ray.map.R1t * ray.normal;
    if (std::min(N0.z(), N1.z()) > kFlattest) {
      const double s0 = (piece.high - P0.z()) / N0.z(), s1 = (piece.high - P1.z()) / N1.z();
      const double farthest = std::max((P0 + s0 * N0).head<2>().norm(), (P1 + s1 * N1).head<2>().norm());
      if (farthest <= piece.radius) return std::max(s0, s1);
    }
  }
  return ray_interval(ray.point, ray.normal, ray.map, piece).high;
}

/// True only when no point of the ray up to `limit` lies in a cylinder's sweep: it keeps outside its ends or
/// its flank. Rays of a wall that other blocks have milled are told apart from those of this one.
bool passes_beside(const RayPassage& ray, const cutter::ConvexPiece& piece, double limit) {
  const Vec3 top = ray.at(limit), A = ray.map.start(top), B = ray.map.end(top);
  const Vec3 N0 = ray.map.R0t * ray.normal, N1 = ray.map.R1t * ray.normal;
  if (std::min(A.z(), B.z()) > piece.high + kBoundSlack && std::max(N0.z(), N1.z()) <= 0.0) return true;
  if (std::max(A.z(), B.z()) < piece.low - kBoundSlack && std::min(N0.z(), N1.z()) >= 0.0) return true;
  const Vec2 a = A.head<2>(), way = (B - A).head<2>();
  const double length2 = way.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp(-a.dot(way) / length2, 0.0, 1.0) : 0.0;
  const Vec2 nearest = a + t * way;
  return nearest.norm() > piece.radius + kBoundSlack &&
         std::max(nearest.dot(N0.head<2>()), nearest.dot(N1.head<2>())) <= 0.0;
}

/// A ray below the design that runs along the swept surface without entering it: a face beside an edge that
/// was milled exactly to size, seen by the rays of the other face. Rounding must not make a cut of it.
bool only_touches(const RayPassage& ray, const cutter::ConvexPiece& piece, const RayInterval& interval,
                  double probe) {
  constexpr double kTouch = 1e-7;  // mm; rounding of coordinates of a metre
  if (interval.low > -kNoteworthy) return false;
  const auto outside = [&](double s) {
    const Vec3 start = ray.map.start(ray.at(s));
    return nearest_instant(piece, start, ray.map.end(ray.at(s)) - start).floor > -kTouch;
  };
  // With a turning axis the middle may lie in a gap of the interval: its lower end is asked too.
  const double middle = interval.high < kNever ? 0.5 * (interval.low + interval.high) : probe;
  return outside(middle) && outside(interval.low + kNoteworthy);
}

}  // namespace

RayInterval cut_from(double low, const RayPassage& ray, const cutter::ConvexPiece& piece, double limit) {
  // A little above `low`, because the end itself lies on the cutter.
  constexpr double kInside = 1e-6;  // mm
  double probe = std::max(limit, low + kInside);
  if (low < -kSkin) probe = std::max(probe, 0.0);  // whether the cut comes up to the design decides about it
  RayInterval interval{low, kNever};
  if (!covers(ray.map, piece, ray.at(probe))) interval.high = exit_height(ray, piece);
  return only_touches(ray, piece, interval, probe) ? RayInterval{} : interval;
}

RayInterval cut_of_piece(const RayPassage& ray, const cutter::ConvexPiece& piece, double limit) {
  if (!piece.is_cylinder()) {
    const double low = lowest_in_sweep(piece, ray.point, ray.normal, ray.map, limit + kBoundSlack);
    return low > limit ? RayInterval{} : cut_from(low, ray, piece, limit);
  }
  if (passes_beside(ray, piece, limit)) return {};
  const RayInterval interval = ray_interval(ray.point, ray.normal, ray.map, piece);
  const bool misses = interval.low > limit || only_touches(ray, piece, interval, limit);
  return misses ? RayInterval{} : interval;
}

bool beyond_cutter(const RayPassage& ray, const CutterSolid& cutter, const Extent& extent) {
  const Vec3 low = ray.at(extent.low), high = ray.at(extent.high);
  const Vec3 low0 = ray.map.start(low), low1 = ray.map.end(low);
  const Vec3 high0 = ray.map.start(high), high1 = ray.map.end(high);
  if (std::min({low0.z(), low1.z(), high0.z(), high1.z()}) > cutter.height + kBoundSlack) return true;
  // In between the point stays within half its way from one of the two ends.
  const double way = std::max((low1 - low0).head<2>().norm(), (high1 - high0).head<2>().norm());
  const double beside = cutter.radius + 0.5 * way + kBoundSlack;
  const auto leaves = [&](const Vec3& from, const Vec3& to) {
    return from.head<2>().norm() > beside && from.head<2>().dot((to - from).head<2>()) >= 0.0;
  };
  return leaves(low0, high0) && leaves(low1, high1);
}

}  // namespace swarf::stock
