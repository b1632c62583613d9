#include "collision/greatest_depth.h"

#include <algorithm>
#include <limits>

namespace swarf::collision {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kFloatMm = 1e-5;  // rounding of float positions
/// Products that a mesh may take: large ones are measured along fewer directions.
constexpr size_t kProductsMost = 200'000;

/// Depth behind a side at the height z of the axis: at + slope z.
struct DepthLine {
  double at, slope;
};

/// max over z of the least of the lines: where a rising and a falling one cross lowest, or the lowest level
/// one.
double highest_of_least(const std::vector<DepthLine>& lines) {
  double highest = kInfinite;
  for (const DepthLine& up : lines)
    for (const DepthLine& down : lines) {
      if (up.slope < 0.0 || down.slope > 0.0) continue;
      const double turn = up.slope - down.slope;
      const double crossing =
          turn > 0.0 ? (down.at * up.slope - up.at * down.slope) / turn : std::min(up.at, down.at);
      highest = std::min(highest, crossing);
    }
  return highest;
}

double deepest_in_solid(const RevolvedSolid& solid) {
  std::vector<DepthLine> lines{{-solid.corners.front().y(), 1.0}, {solid.corners.back().y(), -1.0}};
  for (size_t i = 0; i + 1 < solid.corners.size(); ++i) {
    const Vec2 along = solid.corners[i + 1] - solid.corners[i];
    if (along.norm() == 0.0) continue;
    const Vec2 outward = Vec2(along.y(), -along.x()).normalized();
    lines.push_back({outward.dot(solid.corners[i]), -outward.y()});
  }
  return highest_of_least(lines);
}

double width_along(const std::vector<Triangle>& triangles, const Vec3& direction) {
  double low = kInfinite, high = -kInfinite;
  for (const Triangle& triangle : triangles)
    for (const Vec3& corner : triangle) {
      const double at = corner.dot(direction);
      low = std::min(low, at);
      high = std::max(high, at);
    }
  return high - low;
}

double deepest_in_mesh(const std::vector<Triangle>& triangles) {
  double width = kInfinite;
  for (int i = 0; i < 3; ++i) width = std::min(width, width_along(triangles, Vec3::Unit(i)));
  const size_t directions = std::clamp<size_t>(kProductsMost / (3 * triangles.size()), 1, triangles.size());
  for (size_t k = 0; k < directions; ++k) {
    const Triangle& facet = triangles[k * triangles.size() / directions];
    const Vec3 normal = (facet[1] - facet[0]).cross(facet[2] - facet[0]);
    if (normal.norm() > 0.0) width = std::min(width, width_along(triangles, normal.normalized()));
  }
  return 0.5 * width + kFloatMm;
}

}  // namespace

double greatest_depth(const Body& body) {
  double greatest = 0.0;
  for (const RevolvedSolid& solid : body.solids) greatest = std::max(greatest, deepest_in_solid(solid));
  if (!body.triangles.empty()) greatest = std::max(greatest, deepest_in_mesh(body.triangles));
  return greatest;
}

}  // namespace swarf::collision
