#include "measure/clear_column.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace swarf::measure {
namespace {

constexpr double kRim = 1e-9;           // mm; floats of 100 mm differ by 8e-6, doubles by 1e-14
constexpr double kMostWidening = 1e-5;  // mm: needles for which the rim matters more are not covered
/// The number of sheets is whole; this is for the rounding of the areas.
constexpr double kWhole = 1e-3;
/// Facets in the column; with more the triangle is better halved.
constexpr size_t kMostFacets = 96;
/// Clear slabs thinner than this tell nothing, mm; and so many are asked whether they are inside or outside.
constexpr double kThinnest = 1e-6;
constexpr size_t kMostSlabs = 4;

/// A convex polygon: each plane that clips a facet adds a corner at most.
struct Polygon {
  std::array<Vec3, 3 + FlatPiece::kMostCorners + 1> points;
  size_t count = 0;
};

/// Keeps what lies left of the line from a to b (x, y only).
void clip(Polygon& polygon, const Vec3& a, const Vec3& b) {
  const auto height = [&](const Vec3& p) {
    return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
  };
  Polygon kept;
  for (size_t i = 0; i < polygon.count; ++i) {
    const Vec3 &p = polygon.points[i], &q = polygon.points[(i + 1) % polygon.count];
    const double hp = height(p), hq = height(q);
    if (hp >= 0.0) kept.points[kept.count++] = p;
    if ((hp > 0.0 && hq < 0.0) || (hp < 0.0 && hq > 0.0))
      kept.points[kept.count++] = p + hp / (hp - hq) * (q - p);
  }
  polygon = kept;
}

double signed_area(const Polygon& polygon) {
  double twice = 0.0;
  for (size_t i = 0; i < polygon.count; ++i) {
    const Vec3 &p = polygon.points[i], &q = polygon.points[(i + 1) % polygon.count];
    twice += p.x() * q.y() - p.y() * q.x();
  }
  return 0.5 * twice;
}

/// Heights from low to high over a triangle.
struct Slab {
  double low = 0.0, high = 0.0;
  /// How far every point of the piece is from it.
  double depth() const { return std::max({0.0, low, -high}); }
};

/// The column of a piece, in a frame whose third axis is the piece's normal.
class Column {
 public:
  bool set(const FlatPiece& piece, double height_mm) {
    centre_ = piece.centre();
    Vec3 twice_area = Vec3::Zero(), along = Vec3::Zero();
    for (size_t i = 0; i < piece.count; ++i) {
      const Vec3 &p = piece.points[i], &q = piece.points[(i + 1) % piece.count];
      twice_area += (p - centre_).cross(q - centre_);
      if ((q - p).squaredNorm() > along.squaredNorm()) along = q - p;
    }
    if (!(twice_area.norm() > 0.0)) return false;
    frame_.row(2) = twice_area.normalized();
    frame_.row(0) = (along - along.dot(Vec3(frame_.row(2))) * Vec3(frame_.row(2))).normalized();
    frame_.row(1) = Vec3(frame_.row(2)).cross(Vec3(frame_.row(0)));
    count_of_sides_ = piece.count;
    for (size_t i = 0; i < piece.count; ++i) corners_[i] = frame_ * (piece.points[i] - centre_);
    const double shrink = kRim / nearest_side();
    widening_mm = shrink * piece.radius();
    if (!(widening_mm <= kMostWidening)) return false;
    for (size_t i = 0; i < piece.count; ++i) {
      corners_[i] *= 1.0 - shrink;
      corners_[i].z() = 0.0;
    }
    area_ = 0.5 * twice_area.norm() * (1.0 - shrink) * (1.0 - shrink);
    height_ = height_mm;
    return true;
  }

  void add(const Corners& facet) {
    Polygon polygon;
    for (const Vec3& corner : facet) polygon.points[polygon.count++] = frame_ * (corner - centre_);
    for (size_t i = 0; i < count_of_sides_ && polygon.count > 0; ++i)
      clip(polygon, corners_[i], corners_[(i + 1) % count_of_sides_]);
    if (polygon.count == 0) return;
    double least = polygon.points[0].z(), most = least;
    for (size_t i = 1; i < polygon.count; ++i) {
      least = std::min(least, polygon.points[i].z());
      most = std::max(most, polygon.points[i].z());
    }
    if (least > height_ || most < -height_) return;
    covered_ += signed_area(polygon);
    heights_[count_++] = {least, most};
  }

  /// The clear slabs of the column, those nearest to the piece first.
  std::vector<Slab> clear_slabs() {
    std::sort(heights_.begin(), heights_.begin() + static_cast<ptrdiff_t>(count_),
              [](const Slab& a, const Slab& b) { return a.low < b.low; });
    std::vector<Slab> slabs;
    double top = -height_;
    for (size_t i = 0; i <= count_; ++i) {
      const double next = i < count_ ? heights_[i].low : height_;
      if (next - top > kThinnest) slabs.push_back({top, next});
      if (i < count_) top = std::max(top, heights_[i].high);
    }
    std::sort(slabs.begin(), slabs.end(), [](const Slab& a, const Slab& b) { return a.depth() < b.depth(); });
    return slabs;
  }

  bool covered_once() const { return std::abs(covered_ / area_ - 1.0) <= kWhole; }
  Vec3 over_centre(double height_mm) const { return centre_ + height_mm * Vec3(frame_.row(2)); }

  double widening_mm = 0.0;

 private:
  /// From the centre to the nearest side, in the piece's plane; sides without length are none.
  double nearest_side() const {
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < count_of_sides_; ++i) {
      const Vec3 &p = corners_[i], &q = corners_[(i + 1) % count_of_sides_];
      const double length = (q - p).norm();
      if (length > 0.0) nearest = std::min(nearest, (p.x() * q.y() - p.y() * q.x()) / length);
    }
    return nearest;
  }

  Vec3 centre_ = Vec3::Zero();
  Mat3 frame_ = Mat3::Identity();
  std::array<Vec3, FlatPiece::kMostCorners> corners_;
  size_t count_of_sides_ = 0;
  double area_ = 0.0, height_ = 0.0, covered_ = 0.0;
  std::array<Slab, kMostFacets> heights_;  ///< of the facets in the column
  size_t count_ = 0;
};

/// The ball in which the facets of a column and the errors that matter lie, mm.
double ball_of(const FlatPiece& piece, const TargetMesh& target, double height_mm) {
  return std::hypot(piece.radius(), height_mm) +
         TargetMesh::kReach * std::min(TargetMesh::kQuiet, target.most_error);
}

/// All facets of the column, and the greatest error of those that come near; false when there are too many.
bool fill(Column& column, const FlatPiece& piece, const TargetMesh& target, double height_mm,
          double& error_mm) {
  std::array<uint32_t, kMostFacets> facets{};
  size_t count = 0;
  target.mesh->tree().each_near(piece.centre(), ball_of(piece, target, height_mm), [&](uint32_t facet) {
    if (count < kMostFacets) facets[count] = facet;
    ++count;
  });
  if (count > kMostFacets) return false;
  std::sort(facets.begin(), facets.begin() + static_cast<ptrdiff_t>(count));  // sums in one order
  for (size_t i = 0; i < count; ++i) {
    column.add(target.corners(facets[i]));
    error_mm = std::max(error_mm, target.near_error(facets[i]));
  }
  return true;
}

/// Whether all errors that can matter to places so deep in the column are known from its facets: with kReach,
/// 5/4 of the way to the place and 1/4 of the target's distance lie in the ball. The column is higher than
/// that distance by the piece's radius at least.
bool knows_errors(const FlatPiece& piece, const TargetMesh& target, double height_mm, double depth_mm) {
  const double share = 1.0 / (TargetMesh::kReach - 1.0);
  const double way = std::hypot(piece.radius(), depth_mm);
  const double distance = std::max(0.0, height_mm - piece.radius());
  return (1.0 + share) * way + share * distance <= ball_of(piece, target, height_mm);
}

/// Every point of the piece lies within `depth` of a clear part that is wholly outside or inside.
void bound_by(double depth, bool outside, DistanceRange& range) {
  if (outside) {
    range.low = std::max(range.low, -depth);
  } else {
    range.high = std::min(range.high, depth);
  }
}

/// Nearest points of two segments (Ericson, Real-Time Collision Detection, 5.1.9).
double edge_distance(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  const Vec3 d1 = q - p, d2 = s - r, w = p - r;
  const double a = d1.squaredNorm(), e = d2.squaredNorm(), f = d2.dot(w), c = d1.dot(w), b = d1.dot(d2);
  const double denominator = a * e - b * b;
  double t = denominator > 0.0 ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.0;
  double u = e > 0.0 ? (b * t + f) / e : 0.0;
  if (u < 0.0 || u > 1.0) {
    u = std::clamp(u, 0.0, 1.0);
    t = a > 0.0 ? std::clamp((b * u - c) / a, 0.0, 1.0) : 0.0;
  }
  return (p + t * d1 - r - u * d2).norm();
}

double corner_distance(const Corners& corners, const Corners& facet) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& p : corners)
    least = std::min(least, (mesh::closest_point_on_triangle(p, facet[0], facet[1], facet[2]) - p).norm());
  return least;
}

double triangle_distance(const Corners& a, const Corners& b) {
  double least = std::min(corner_distance(a, b), corner_distance(b, a));
  for (size_t i = 0; i < 3; ++i) {
    for (size_t k = 0; k < 3; ++k)
      least = std::min(least, edge_distance(a[i], a[(i + 1) % 3], b[k], b[(k + 1) % 3]));
  }
  return least;
}

}  // namespace

double TargetMesh::distance_over(uint32_t facet, const FlatPiece& piece) const {
  double most = 0.0;
  for (const Vec3& p : piece.corners()) most = std::max(most, distance(facet, p));
  return most + error(facet);
}

DistanceRange clear_column(const FlatPiece& piece, const TargetMesh& target, double height_mm, bool open) {
  DistanceRange range;
  Column column;
  double error_mm = 0.0;
  if (!column.set(piece, height_mm) || !fill(column, piece, target, height_mm, error_mm)) return range;
  if (open && !column.covered_once()) return range;
  size_t asked = 0;
  for (const Slab& slab : column.clear_slabs()) {
    if (++asked > kMostSlabs || (std::isfinite(range.low) && std::isfinite(range.high))) break;
    const Vec3 inside = column.over_centre(0.5 * (slab.low + slab.high));
    const bool known = knows_errors(piece, target, height_mm, slab.depth());
    const double error = known ? error_mm : std::max(error_mm, target.most_error);
    bound_by(slab.depth() + column.widening_mm + error, target.mesh->at(inside).distance_mm > 0.0, range);
  }
  return range;
}

double least_distance(const FlatPiece& piece, const mesh::SignedDistance& target, double within_mm) {
  double least = within_mm;
  target.tree().each_near(piece.centre(), piece.radius() + within_mm, [&](uint32_t f) {
    const Corners facet{target.corner(f, 0), target.corner(f, 1), target.corner(f, 2)};
    for (size_t i = 1; i + 1 < piece.count; ++i)
      least =
          std::min(least, triangle_distance({piece.points[0], piece.points[i], piece.points[i + 1]}, facet));
  });
  return least;
}

}  // namespace swarf::measure
