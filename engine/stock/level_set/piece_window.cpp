#include "stock/level_set/piece_window.h"

#include <cmath>

#include "stock/level_set/leaf_kernel.h"

namespace swarf::stock {

double leaf_radius(double voxel_mm) {
  return 0.5 * (kLeafSide - 1) * std::sqrt(3.0) * voxel_mm;
}

Window time_in_reach(const cutter::ConvexPiece& piece, const Vec3& P, const Vec3& D, double reach) {
  Window window;
  const double low = piece.low - reach, high = piece.high + reach, radius = piece.radius + reach;
  if (D.z() != 0.0) {
    window.clip((low - P.z()) / D.z(), (high - P.z()) / D.z());
  } else if (P.z() < low || P.z() > high) {
    return Window::nothing();
  }
  const double a = D.head<2>().squaredNorm();
  if (a == 0.0) return P.head<2>().norm() > radius ? Window::nothing() : window;
  const double b = P.head<2>().dot(D.head<2>());
  const double miss = P.x() * D.y() - P.y() * D.x();
  const double half2 = a * radius * radius - miss * miss;
  if (half2 < 0.0) return Window::nothing();
  window.clip((-b - std::sqrt(half2)) / a, (-b + std::sqrt(half2)) / a);
  return window;
}

double cylinder_kernel_error_mm(const cutter::ConvexPiece& piece, double voxel_mm, double band_mm) {
  constexpr double kHalfSpacing = 6e-8, kRoundings = 16.0 + 32.0;
  const double reach = band_mm + leaf_radius(voxel_mm) + kReachSlack;
  const double across = kFarFactor * (piece.radius + reach), along = kFarFactor * (piece.high + reach);
  return kRoundings * kHalfSpacing * (std::max(across, along) + leaf_radius(voxel_mm));
}

}  // namespace swarf::stock
