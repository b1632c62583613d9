#include "mesh/winding.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace swarf::mesh {
namespace {

/// Of a sum of products of positions, relative to them: a few thousand of its roundings.
constexpr double kRaySlack = 1e-12;

}  // namespace

double solid_angle(const std::array<Vec3, 3>& triangle, const Vec3& point) {
  const Vec3 a = triangle[0] - point, b = triangle[1] - point, c = triangle[2] - point;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double volume = a.dot(b.cross(c));
  const double below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return volume == 0.0 && below == 0.0 ? 0.0 : std::atan2(volume, below) / (2.0 * kPi);
}

std::optional<int> ray_crossing(const std::array<Vec3, 3>& triangle, const Vec3& point, const Vec3& ray) {
  const Vec3 one = triangle[1] - triangle[0], other = triangle[2] - triangle[0], s = point - triangle[0];
  if (one.cross(other).isZero(0.0)) return 0;  // without area: its neighbours meet along it
  const Vec3 h = ray.cross(other), k = s.cross(one);
  const double volume = one.dot(h), size = std::max(one.norm(), other.norm());
  const double slack = kRaySlack * (point.norm() + triangle[0].norm() + size) * size;
  const double sign = volume < 0.0 ? -1.0 : 1.0, whole = std::abs(volume);
  const double u = sign * s.dot(h), v = sign * ray.dot(k), t = sign * other.dot(k);
  // Errors of u and v are those of positions times a side, of t times a side more.
  if (u < -slack || v < -slack || u + v > whole + 2.0 * slack || t < -slack * size) return 0;
  if (u <= slack || v <= slack || u + v >= whole - 2.0 * slack || t <= slack * size) return {};
  return volume < 0.0 ? 1 : -1;
}

const std::array<Vec3, 3>& winding_rays() {
  static const std::array<Vec3, 3> rays{Vec3(0.5374, 0.2963, 0.7897), Vec3(-0.6871, 0.6317, -0.3588),
                                        Vec3(0.2219, -0.8903, 0.3977)};
  return rays;
}

}  // namespace swarf::mesh
