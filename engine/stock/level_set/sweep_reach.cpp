#include "stock/level_set/sweep_reach.h"

#include <algorithm>
#include <cmath>

namespace swarf::stock {
namespace {

/// The two outermost faces or rounds at a point.
struct TwoSupports {
  cutter::Support first{-1e300, Vec2::Zero()}, second{-1e300, Vec2::Zero()};
  void add(const cutter::Support& other) {
    if (other.value > first.value) {
      second = first;
      first = other;
    } else if (other.value > second.value) {
      second = other;
    }
  }
};
TwoSupports outermost(const cutter::ConvexPiece& piece, const Vec2& p) {
  TwoSupports two;
  for (const cutter::Face& face : piece.faces) two.add(cutter::support(face, p));
  for (const cutter::Round& round : piece.rounds) two.add(cutter::support(round, p));
  return two;
}

}  // namespace

ReachBound reach_bound(const SweptPiece& swept, const Vec3& start, const Vec3& end) {
  const Vec3 middle = 0.5 * (start + end);
  const double rho = std::sqrt(middle.x() * middle.x() + middle.y() * middle.y());
  const TwoSupports two = outermost(*swept.piece, {rho, middle.z()});
  // On the axis every direction is a subgradient.
  const double ux = rho > 0.0 ? middle.x() / rho : 1.0, uy = rho > 0.0 ? middle.y() / rho : 0.0;
  const auto linear = [&](const cutter::Support& support) -> LinearBound {
    const Vec3 g(support.normal.x() * ux, support.normal.x() * uy, support.normal.y());
    const double change = 0.5 * g.dot(end - start);
    return {change - support.value, -change - support.value, -(swept.map.R0t.transpose() * g),
            -(swept.map.R1t.transpose() * g)};
  };
  return {{linear(two.first), linear(two.second)}};
}

}  // namespace swarf::stock
