#include "stock/sweep/sweep_map.h"

#include <cmath>

#include "base/angles.h"

namespace swarf::stock {
namespace {

/// Any unit vector perpendicular to a unit vector: the coordinate axis least aligned with it decides.
Vec3 perpendicular(const Vec3& axis) {
  int least = 0;
  axis.cwiseAbs().minCoeff(&least);
  return axis.cross(Vec3::Unit(least)).normalized();
}

/// v turned by the smallest rotation that takes unit vector `from` to unit vector `to` (Rodrigues without
/// angles: R = I + [w] + [w]^2 / (1 + c), w = from x to, c = from . to).
Vec3 turned(const Vec3& v, const Vec3& from, const Vec3& to) {
  const double c = from.dot(to);
  // Nearly opposite axes leave the plane of rotation undefined: half a turn about a fixed perpendicular.
  constexpr double kOpposite = -1.0 + 1e-12;
  if (c < kOpposite) {
    const Vec3 k = perpendicular(from);
    return 2.0 * k * k.dot(v) - v;
  }
  const Vec3 w = from.cross(to);
  const Vec3 wv = w.cross(v);
  return v + wv + w.cross(wv) / (1.0 + c);
}

}  // namespace

SweepMap sweep_map(const Sweep& sweep) {
  const Vec3& a0 = sweep.start.axis_W;
  const Vec3& a1 = sweep.end.axis_W;
  const Vec3 x0 = perpendicular(a0);
  SweepMap map;
  map.R0t.row(0) = x0;
  map.R0t.row(1) = a0.cross(x0);
  map.R0t.row(2) = a0;
  if (a0 == a1) {
    map.R1t = map.R0t;  // bit-exact: a translation must not look like a rotation
  } else {
    const Vec3 x1 = turned(x0, a0, a1);
    map.R1t.row(0) = x1;
    map.R1t.row(1) = a1.cross(x1);
    map.R1t.row(2) = a1;
  }
  map.tip0 = sweep.start.tip_W;
  map.tip1 = sweep.end.tip_W;
  return map;
}

double motion_bound(const SweepMap& map, double lever_mm) {
  return motion_bound(Sweep{{map.tip0, map.R0t.row(2)}, {map.tip1, map.R1t.row(2)}}, lever_mm);
}

double motion_bound(const Sweep& sweep, double lever_mm) {
  const double theta = angle_between(sweep.start.axis_W, sweep.end.axis_W);
  const double travel = (sweep.end.tip_W - sweep.start.tip_W).norm();
  return theta * (theta * lever_mm + 2.0 * travel) / 8.0;
}

}  // namespace swarf::stock
