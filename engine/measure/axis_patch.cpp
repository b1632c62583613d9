#include "measure/axis_patch.h"

#include <algorithm>
#include <array>

#include "base/roots.h"

namespace swarf::measure {
namespace {

/// Parameter of the nearest point of the segment b0 + l b, clamped.
double foot(const Vec3& x, const Vec3& b0, const Vec3& b) {
  const double square = b.squaredNorm();
  return square > 0.0 ? std::clamp((x - b0).dot(b) / square, 0.0, 1.0) : 0.0;
}

}  // namespace

double segment_distance(const Vec3& x, const Vec3& b0, const Vec3& b1) {
  const Vec3 b = b1 - b0;
  return (x - b0 - foot(x, b0, b) * b).norm();
}

double segment_distance(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1) {
  // The least distance is at an end of one of the two, or where the common normal of the lines meets both.
  double least = std::min({segment_distance(a0, b0, b1), segment_distance(a1, b0, b1),
                           segment_distance(b0, a0, a1), segment_distance(b1, a0, a1)});
  const Vec3 a = a1 - a0, b = b1 - b0, n = a.cross(b);
  const double square = n.squaredNorm();
  if (square == 0.0) return least;
  const Vec3 between = b0 - a0;
  const double s = between.cross(b).dot(n) / square, l = between.cross(a).dot(n) / square;
  if (s >= 0.0 && s <= 1.0 && l >= 0.0 && l <= 1.0) {
    least = std::min(least, (between + l * b - s * a).norm());
  }
  return least;
}

AxisPatch::AxisPatch(const Vec3& P0, const Vec3& P1, const Vec3& Q0, const Vec3& Q1)
    : P0_(P0), P1_(P1), Q0_(Q0), Q1_(Q1), dP_(P1 - P0), Q_(Q0 - P0), dQ_(Q1 - P1 - (Q0 - P0)) {
  centre_ = 0.25 * (P0 + P1 + Q0 + Q1);
  radius_ =
      std::max({(P0 - centre_).norm(), (P1 - centre_).norm(), (Q0 - centre_).norm(), (Q1 - centre_).norm()});
}

double AxisPatch::distance(const Vec3& x) const {
  const Vec3 from = x - P0_;
  // (x-P) x (Q-P) = k0 + k1 t + k2 t^2
  const Vec3 k0 = from.cross(Q_), k1 = from.cross(dQ_) - dP_.cross(Q_), k2 = -dP_.cross(dQ_);
  const std::array<double, 5> N{k0.squaredNorm(), 2.0 * k0.dot(k1), k1.squaredNorm() + 2.0 * k0.dot(k2),
                                2.0 * k1.dot(k2), k2.squaredNorm()};
  const std::array<double, 3> D{Q_.squaredNorm(), 2.0 * Q_.dot(dQ_), dQ_.squaredNorm()};
  std::array<double, 6> slope{};
  for (size_t i = 0; i < N.size(); ++i) {
    for (size_t j = 0; j < D.size(); ++j) {
      if (i + j == 0) continue;
      slope[i + j - 1] += (static_cast<double>(i) - static_cast<double>(j)) * N[i] * D[j];
    }
  }
  double least = std::min({segment_distance(x, P0_, Q0_), segment_distance(x, P1_, Q1_),
                           segment_distance(x, P0_, P1_), segment_distance(x, Q0_, Q1_)});
  const UnitRoots inside = unit_roots(slope);
  for (const double t : inside.all()) {
    const Vec3 P = P0_ + t * dP_;
    least = std::min(least, segment_distance(x, P, P + Q_ + t * dQ_));
  }
  return least;
}

}  // namespace swarf::measure
