#include "flank/feed.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/minima.h"
#include "base/parallel.h"

namespace swarf::flank {
namespace {

constexpr size_t kFamilyNodes = 2049;
/// Of the way of the tip by differences of the splined family.
constexpr double kRateStep = 1e-5;

/// Radius of curvature of the curve v = const; infinity where it is straight.
double radius_at(const surface::Surface& surface, double u, double v) {
  const surface::Derivatives d = surface.derivatives(u, v);
  const double speed = d.Su.norm(), bend = d.Su.cross(d.Suu).norm();
  if (bend <= 1e-12 * speed * speed * speed) return std::numeric_limits<double>::infinity();
  return speed * speed * speed / bend;
}

}  // namespace

double sagitta_feed(double radius_mm, double period_s, double error_mm) {
  if (std::isinf(radius_mm)) return std::numeric_limits<double>::infinity();
  const double e = std::min(error_mm, radius_mm);
  return 2.0 / period_s * std::sqrt(2.0 * radius_mm * e - e * e);
}

AxisFamily::AxisFamily(const FlankTask& task) : u_low_(task.u_low), u_high_(task.u_high) {
  const double step = (u_high_ - u_low_) / (kFamilyNodes - 1);
  std::array<std::vector<double>, 6> values;
  for (std::vector<double>& column : values) column.resize(kFamilyNodes);
  parallel_chunks(kFamilyNodes, 16, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const ToolPose pose = pose_at(task, u_low_ + static_cast<double>(i) * step);
      for (size_t k = 0; k < 3; ++k) {
        values[k][i] = pose.tip_W[static_cast<Eigen::Index>(k)];
        values[k + 3][i] = pose.axis_W[static_cast<Eigen::Index>(k)];
      }
    }
  });
  for (size_t k = 0; k < 6; ++k) values_[k] = CubicSpline(u_low_, step, values[k]);
}

ToolPose AxisFamily::pose(double u) const {
  Vec3 tip, axis;
  for (size_t k = 0; k < 3; ++k) {
    tip[static_cast<Eigen::Index>(k)] = values_[k].at(u).w;
    axis[static_cast<Eigen::Index>(k)] = values_[k + 3].at(u).w;
  }
  return {tip, axis.normalized()};
}

double AxisFamily::tip_rate(double u) const {
  const double low = std::max(u_low_, u - kRateStep), high = std::min(u_high_, u + kRateStep);
  return (pose(high).tip_W - pose(low).tip_W).norm() / (high - low);
}

ToolPose between(const ToolPose& a, const ToolPose& b, double share) {
  return {(1.0 - share) * a.tip_W + share * b.tip_W,
          ((1.0 - share) * a.axis_W + share * b.axis_W).normalized()};
}

AxisError chord_error(const FlankTask& task, const AxisFamily& family, double u, double chord_mm,
                      const ChordMiddle& middle) {
  const double half = 0.5 * chord_mm / family.tip_rate(u);
  const ToolPose from = family.pose(std::max(task.u_low, u - half)),
                 to = family.pose(std::min(task.u_high, u + half));
  return axis_error(task, middle ? middle(from, to) : between(from, to), u);
}

double bisected_feed(const FlankTask& task, const AxisFamily& family, double u, double period_s,
                     double limit_mm, double most_mm_s, const ChordMiddle& middle) {
  const auto within = [&](double feed) {
    return chord_error(task, family, u, feed * period_s, middle).most_mm() <= limit_mm;
  };
  if (within(most_mm_s)) return most_mm_s;
  constexpr double kSlowest = 1e-3;  // of the greatest speed: below it the placement alone exceeds the limit
  if (!within(kSlowest * most_mm_s)) return 0.0;
  double low = kSlowest * most_mm_s, high = most_mm_s;
  while (high - low > 1e-6 * most_mm_s) {
    const double feed = 0.5 * (low + high);
    (within(feed) ? low : high) = feed;
  }
  return low;
}

double curvature_feed(const FlankTask& task, const AxisFamily& family, double u, double period_s,
                      double limit_mm, double most_mm_s) {
  double feed = most_mm_s;
  for (const double v : {0.0, 1.0}) {
    const double of_curve = sagitta_feed(radius_at(*task.surface, u, v), period_s, limit_mm);
    const double tip_per_curve = family.tip_rate(u) / task.surface->derivatives(u, v).Su.norm();
    feed = std::min(feed, of_curve * tip_per_curve);
  }
  return feed;
}

GuideFigures guide_figures(const surface::Surface& surface, double v) {
  constexpr int kPieces = 512;
  // Five-point Gauss on equal pieces.
  constexpr std::array<double, 5> kAt{0.046910077030668, 0.230765344947158, 0.5, 0.769234655052842,
                                      0.953089922969332};
  constexpr std::array<double, 5> kWeight{0.118463442528095, 0.239314335249683, 0.284444444444444,
                                          0.239314335249683, 0.118463442528095};
  GuideFigures figures;
  for (int i = 0; i < kPieces; ++i)
    for (size_t k = 0; k < 5; ++k)
      figures.length_mm += kWeight[k] / kPieces * surface.derivatives((i + kAt[k]) / kPieces, v).Su.norm();
  const Minimum least = least_sampled([&](double u) { return radius_at(surface, u, v); }, 0.0, 1.0, kPieces);
  figures.radius_min_mm = least.value;
  figures.radius_min_u = least.at;
  return figures;
}

}  // namespace swarf::flank
