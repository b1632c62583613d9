#include "collision/winding.h"

#include <array>
#include <cmath>
#include <optional>

#include "mesh/winding.h"

namespace swarf::collision {
namespace {

/// Of a box, relative to its place: a few thousand roundings.
constexpr double kRaySlack = 1e-12;

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
    return facet ? mesh::ray_crossing(body.triangles[node.primitive], point, ray) : 0;
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
  for (const Vec3& ray : mesh::winding_rays())
    if (const std::optional<int> count = crossings(body, 0, point, ray, ray.cwiseInverse())) return *count;
  double turns = 0.0;
  for (const Triangle& triangle : body.triangles) turns += mesh::solid_angle(triangle, point);
  return turns;
}

}  // namespace swarf::collision
