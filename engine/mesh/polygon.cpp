#include "mesh/polygon.h"

#include <cmath>
#include <iterator>

#include "base/frames.h"

namespace swarf::mesh {
namespace {

struct Point2 {
  double x, y;
};

/// Twice the signed area of a, b, c; exact enough here: the coordinates are floats, so that differences are
/// exact in double to a relative 2^-52.
double turn_of(const Point2& a, const Point2& b, const Point2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool same(const Point2& a, const Point2& b) {
  return a.x == b.x && a.y == b.y;
}

/// Inside or on the border of a counter-clockwise triangle.
bool covers(const Point2& a, const Point2& b, const Point2& c, const Point2& p) {
  return turn_of(a, b, p) >= 0.0 && turn_of(b, c, p) >= 0.0 && turn_of(c, a, p) >= 0.0;
}

Vec3 newell_normal(std::span<const uint32_t> corners, const std::vector<std::array<float, 3>>& positions) {
  const auto point = [&](size_t i) {
    const auto& p = positions[corners[i % corners.size()]];
    return Vec3(p[0], p[1], p[2]);
  };
  const Vec3 origin = point(0);
  Vec3 sum = Vec3::Zero();
  for (size_t i = 1; i + 1 < corners.size(); ++i) sum += (point(i) - origin).cross(point(i + 1) - origin);
  return sum;
}

/// Along the largest component of the normal, so that the polygon runs counter-clockwise.
std::vector<Point2> projected(std::span<const uint32_t> corners,
                              const std::vector<std::array<float, 3>>& positions, const Vec3& normal) {
  Eigen::Index away = 0;
  normal.cwiseAbs().maxCoeff(&away);
  size_t u = (static_cast<size_t>(away) + 1) % 3, v = (static_cast<size_t>(away) + 2) % 3;
  if (normal[away] < 0.0) std::swap(u, v);
  std::vector<Point2> points;
  points.reserve(corners.size());
  for (const uint32_t corner : corners) points.push_back({positions[corner][u], positions[corner][v]});
  return points;
}

/// Cuts ears off a polygon until a triangle is left.
class EarCutter {
 public:
  explicit EarCutter(std::vector<Point2> points) : points_(std::move(points)) {
    for (uint32_t i = 0; i < points_.size(); ++i) left_.push_back(i);
  }

  /// Triangles by places in the polygon; empty when no ear can be found.
  std::vector<std::array<uint32_t, 3>> run() {
    std::vector<std::array<uint32_t, 3>> ears;
    size_t at = 1, refused = 0;  // from the second corner, a convex polygon becomes a fan around the first
    while (left_.size() > 3) {
      at %= left_.size();
      if (is_ear(at)) {
        ears.push_back({before(at), left_[at], after(at)});
        left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(at));
        refused = 0;
      } else if (++refused > left_.size()) {
        return {};
      } else {
        ++at;
      }
    }
    if (turn_of(points_[left_[0]], points_[left_[1]], points_[left_[2]]) < 0.0) return {};
    ears.push_back({left_[0], left_[1], left_[2]});
    return ears;
  }

 private:
  uint32_t before(size_t at) const { return left_[(at + left_.size() - 1) % left_.size()]; }
  uint32_t after(size_t at) const { return left_[(at + 1) % left_.size()]; }

  bool is_reflex(size_t at) const {
    return turn_of(points_[before(at)], points_[left_[at]], points_[after(at)]) <= 0.0;
  }

  bool is_ear(size_t at) const {
    const Point2 &a = points_[before(at)], &b = points_[left_[at]], &c = points_[after(at)];
    if (!(turn_of(a, b, c) > 0.0)) return false;
    for (size_t i = 0; i < left_.size(); ++i) {
      const Point2& p = points_[left_[i]];
      // A bridge to a hole passes the same place twice.
      if (same(p, a) || same(p, b) || same(p, c) || !covers(a, b, c, p)) continue;
      if (is_reflex(i)) return false;
    }
    return true;
  }

  std::vector<Point2> points_;
  std::vector<uint32_t> left_;  ///< corners not cut off yet
};

/// A polygon whose parts cancel out: a fan when all corners lie in line, else it crosses itself.
std::vector<std::array<uint32_t, 3>> without_area(std::span<const uint32_t> corners,
                                                  const std::vector<std::array<float, 3>>& positions) {
  std::vector<std::array<uint32_t, 3>> triangles;
  for (uint32_t i = 1; i + 1 < corners.size(); ++i) {
    triangles.push_back({0, i, i + 1});
    const std::array<uint32_t, 3> facet{corners[0], corners[i], corners[i + 1]};
    if (newell_normal(facet, positions).squaredNorm() > 0.0) return {};
  }
  return triangles;
}

}  // namespace

bool append_polygon(std::span<const uint32_t> corners, const std::vector<std::array<float, 3>>& positions,
                    std::vector<std::array<uint32_t, 3>>& triangles) {
  if (corners.size() == 3) {
    triangles.push_back({corners[0], corners[1], corners[2]});
    return true;
  }
  const Vec3 normal = newell_normal(corners, positions);
  const bool flat = normal.squaredNorm() == 0.0;
  const auto places =
      flat ? without_area(corners, positions) : EarCutter(projected(corners, positions, normal)).run();
  for (const auto& t : places) triangles.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
  return !places.empty();
}

}  // namespace swarf::mesh
