// Distances of triangles and meshes by trying everything: the oracle of the collision tests.
#pragma once

#include <algorithm>
#include <cmath>

#include "collision/body.h"
#include "mesh/mesh_distance.h"

namespace swarf::collision {

/// Distance of two segments, by the ends and by the common perpendicular.
inline double brute_segments(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  const auto to_segment = [](const Vec3& x, const Vec3& a, const Vec3& b) {
    const double length = (b - a).squaredNorm();
    const double share = length > 0.0 ? std::clamp((x - a).dot(b - a) / length, 0.0, 1.0) : 0.0;
    return (x - a - share * (b - a)).norm();
  };
  double least = std::min(std::min(to_segment(p, r, s), to_segment(q, r, s)),
                          std::min(to_segment(r, p, q), to_segment(s, p, q)));
  const Vec3 u = q - p, v = s - r, n = u.cross(v);
  const double square = n.squaredNorm();
  if (square < 1e-24) return least;
  const double at = (r - p).cross(v).dot(n) / square, other = (r - p).cross(u).dot(n) / square;
  if (at < 0.0 || at > 1.0 || other < 0.0 || other > 1.0) return least;
  return std::min(least, std::abs((r - p).dot(n)) / std::sqrt(square));
}

/// Whether the segment passes through the triangle.
inline bool brute_pierces(const Vec3& p, const Vec3& q, const Triangle& t) {
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
  const double dp = n.dot(p - t[0]), dq = n.dot(q - t[0]);
  if (dp * dq > 0.0 || dp == dq) return false;
  const Vec3 x = p + (dp / (dp - dq)) * (q - p);
  for (int i = 0; i < 3; ++i) {
    if (n.dot((t[(i + 1) % 3] - t[i]).cross(x - t[i])) < 0.0) return false;
  }
  return true;
}

inline double brute_triangles(const Triangle& a, const Triangle& b) {
  double least = INFINITY;
  for (int i = 0; i < 3; ++i) {
    if (brute_pierces(a[i], a[(i + 1) % 3], b) || brute_pierces(b[i], b[(i + 1) % 3], a)) return 0.0;
    least = std::min(least, (a[i] - mesh::closest_point_on_triangle(a[i], b[0], b[1], b[2])).norm());
    least = std::min(least, (b[i] - mesh::closest_point_on_triangle(b[i], a[0], a[1], a[2])).norm());
    for (int j = 0; j < 3; ++j)
      least = std::min(least, brute_segments(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]));
  }
  return least;
}

/// Of the surfaces, b's home drawing carried into a's by the pose.
inline double brute_distance(const Body& a, const Body& b, const Pose& pose) {
  double least = INFINITY;
  for (const Triangle& other : b.triangles) {
    const Triangle moved{pose * other[0], pose * other[1], pose * other[2]};
    for (const Triangle& one : a.triangles) least = std::min(least, brute_triangles(one, moved));
  }
  return least;
}

}  // namespace swarf::collision
