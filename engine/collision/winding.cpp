#include "collision/winding.h"

#include <array>
#include <cmath>
#include <optional>

#include "base/units.h"

namespace swarf::collision {
namespace {

/// Of a sum of products of positions, relative to them: a few thousand of its roundings.
constexpr double kRaySlack = 1e-12;

/// The solid angle of the triangle from the point, over 4 pi.
double solid_angle(const Triangle& triangle, const Vec3& point) {
  const Vec3 a = triangle[0] - point, b = triangle[1] - point, c = triangle[2] - point;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double volume = a.dot(b.cross(c));
  const double below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return volume == 0.0 && below == 0.0 ? 0.0 : std::atan2(volume, below) / (2.0 * kPi);
}

/// The ray leaves (+1) or enters (-1) the solid through the triangle, or misses it (0); none: not to be told
/// from its edges or from the point. After Moeller & Trumbore (1997).
std::optional<int> crossing(const Triangle& triangle, const Vec3& point, const Vec3& ray) {
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

bool passes(const BodyNode& node, const Vec3& point, const Vec3& one_over_ray) {
  double from = 0.0, to = INFINITY;
  for (int i = 0; i < 3; ++i) {
    const double middle = (node.centre[i] - point[i]) * one_over_ray[i];
    const double half = (node.half[i] + kRaySlack * (std::abs(point[i]) + std::abs(node.centre[i]))) *
                        std::abs(one_over_ray[i]);
    from = std::max(from, middle - half);
    to = std::min(to, middle + half);
  }
  return from <= to * (1.0 + kRaySlack);
}

std::optional<int> crossings(const Body& body, size_t at, const Vec3& point, const Vec3& ray,
                             const Vec3& one_over_ray) {
  const BodyNode& node = body.nodes[at];
  if (!passes(node, point, one_over_ray)) return 0;
  if (node.child < 0) {
    const bool facet = node.primitive < body.triangles.size();
    return facet ? crossing(body.triangles[node.primitive], point, ray) : 0;
  }
  const auto child = static_cast<size_t>(node.child);
  const std::optional<int> first = crossings(body, child, point, ray, one_over_ray);
  if (!first) return {};
  const std::optional<int> second = crossings(body, child + 1, point, ray, one_over_ray);
  if (!second) return {};
  return *first + *second;
}

}  // namespace

double winding_number(const Body& body, const Vec3& point) {
  // Across no axis, plane or diagonal that parts are drawn along.
  static const std::array<Vec3, 3> kRays{Vec3(0.5374, 0.2963, 0.7897), Vec3(-0.6871, 0.6317, -0.3588),
                                         Vec3(0.2219, -0.8903, 0.3977)};
  for (const Vec3& ray : kRays)
    if (const std::optional<int> count = crossings(body, 0, point, ray, ray.cwiseInverse())) return *count;
  double turns = 0.0;
  for (const Triangle& triangle : body.triangles) turns += solid_angle(triangle, point);
  return turns;
}

}  // namespace swarf::collision
