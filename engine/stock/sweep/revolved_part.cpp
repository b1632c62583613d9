#include "stock/sweep/revolved_part.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/units.h"

namespace swarf::stock {
namespace {

constexpr double kSame = 1e-9;  // mm; shorter sides are rounding

/// Greatest rho of the piece at height z. F grows with rho, so halving finds it.
double radius_at(const cutter::ConvexPiece& piece, double z) {
  double inside = 0.0, outside = 2.0 * piece.radius + 1.0;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (inside + outside);
    (cutter::signed_distance(piece, middle, z) <= 0.0 ? inside : outside) = middle;
  }
  return inside;
}

/// Heights at which the profile of the piece may turn.
std::vector<double> levels_of(const cutter::ConvexPiece& piece) {
  std::vector<double> levels{piece.low, piece.high};
  for (const cutter::Round& round : piece.rounds) {
    const double first = std::atan2(round.from.y(), round.from.x());
    double last = std::atan2(round.to.y(), round.to.x());
    if (last < first) last += 2.0 * kPi;
    const double step = 2.0 * std::acos(std::max(0.0, 1.0 - RevolvedPart::kChordMm / round.radius));
    const int count = std::max(1, static_cast<int>(std::ceil((last - first) / step)));
    for (int i = 0; i <= count; ++i)
      levels.push_back(round.centre.y() + round.radius * std::sin(first + (last - first) * i / count));
  }
  for (size_t i = 0; i < piece.faces.size(); ++i) {
    for (size_t k = 0; k < i; ++k) {
      Mat2 normals;
      normals.row(0) = piece.faces[i].normal;
      normals.row(1) = piece.faces[k].normal;
      if (std::abs(normals.determinant()) < 1e-12) continue;
      const Vec2 corner = normals.inverse() * Vec2(piece.faces[i].offset, piece.faces[k].offset);
      levels.push_back(corner.y());
    }
  }
  std::sort(levels.begin(), levels.end());
  return levels;
}

std::vector<Vec2> corners_of(const cutter::ConvexPiece& piece) {
  std::vector<Vec2> corners{{0.0, piece.low}};
  for (const double z : levels_of(piece)) {
    if (z < piece.low || z > piece.high) continue;
    corners.emplace_back(radius_at(piece, z), z);
  }
  corners.emplace_back(0.0, piece.high);
  return corners;
}

/// One part_tangent of the distance along the motion.
struct PartTangent {
  double t = 0.0, value = 0.0, slope = 0.0;
  Vec3 normal;
};

PartTangent part_tangent(const RevolvedPart& part, const Vec3& P, const Vec3& D, double t) {
  const RevolvedPart::Place place = part.at(P + t * D);
  return {t, place.value, place.normal.dot(D), place.normal};
}

RevolvedPart::Nearest exactly_at(const PartTangent& at, const Vec3& P, const Vec3& D) {
  return {at.t, at.value, at.value, at.normal, P + at.t * D};
}

}  // namespace

RevolvedPart RevolvedPart::frustum(double low, double high, double low_radius, double high_radius) {
  return RevolvedPart(std::vector<Vec2>{{0.0, low}, {low_radius, low}, {high_radius, high}, {0.0, high}});
}

RevolvedPart::RevolvedPart(const cutter::ConvexPiece& piece) : RevolvedPart(corners_of(piece)) {}

RevolvedPart::RevolvedPart(const std::vector<Vec2>& corners) {
  for (const Vec2& corner : corners) {
    if (!corners_.empty() && (corner - corners_.back()).norm() < kSame) continue;
    corners_.push_back(corner);
    radius_ = std::max(radius_, corner.x());
  }
  for (size_t i = 1; i < corners_.size(); ++i) {
    const Vec2 way = corners_[i] - corners_[i - 1];
    const Vec2 along = way.normalized();
    sides_.push_back({corners_[i - 1], along, {along.y(), -along.x()}, way.norm()});
  }
}

RevolvedPart::Place RevolvedPart::at(const Vec3& X) const {
  const double rho = X.head<2>().norm();
  const Vec2 q(rho, X.z());
  double inside = -std::numeric_limits<double>::infinity();
  double outside2 = std::numeric_limits<double>::infinity();
  Vec2 normal, arm;
  for (const Side& side : sides_) {
    const Vec2 gap = q - side.from;
    const double above = side.outward.dot(gap);
    if (above > inside) {
      inside = above;
      normal = side.outward;
    }
    const Vec2 off = gap - std::clamp(side.along.dot(gap), 0.0, side.length) * side.along;
    if (off.squaredNorm() < outside2) {
      outside2 = off.squaredNorm();
      arm = off;
    }
  }
  double value = inside;
  if (inside > 0.0 && outside2 > 0.0) {
    value = std::sqrt(outside2);
    normal = arm / value;
  }
  const double sideways = rho > 0.0 ? normal.x() / rho : 0.0;
  return {value, Vec3(sideways * X.x(), sideways * X.y(), normal.y())};
}

RevolvedPart::Nearest RevolvedPart::nearest(const Vec3& P, const Vec3& D, double gap, double enough) const {
  constexpr int kMostSteps = 60;
  PartTangent low = part_tangent(*this, P, D, 0.0);
  if (low.slope >= 0.0) return exactly_at(low, P, D);
  PartTangent high = part_tangent(*this, P, D, 1.0);
  if (high.slope <= 0.0) return exactly_at(high, P, D);
  double crossing = 0.0, floor = low.value;
  for (int step = 0; step < kMostSteps; ++step) {
    const double width = high.t - low.t, change = high.slope - low.slope;
    const double over = std::clamp((low.value - high.value + high.slope * width) / change, 0.0, width);
    crossing = low.t + over;
    floor = low.value + low.slope * over;
    if (floor > enough || std::min(low.value, high.value) - floor <= gap) break;
    const double secant = low.t - low.slope / change * width;
    const double t = step % 3 == 0 ? crossing : step % 3 == 1 ? secant : low.t + 0.5 * width;
    if (!(t > low.t && t < high.t)) continue;
    const PartTangent next = part_tangent(*this, P, D, t);
    if (next.slope == 0.0) return exactly_at(next, P, D);
    (next.slope < 0.0 ? low : high) = next;
  }
  const PartTangent& least = low.value <= high.value ? low : high;
  const Vec3 normal = (high.slope * low.normal - low.slope * high.normal) / (high.slope - low.slope);
  return {least.t, least.value, std::min(floor, least.value), normal, P + crossing * D};
}

}  // namespace swarf::stock
