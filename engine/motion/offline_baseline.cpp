#include "motion/offline_baseline.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "base/minima.h"
#include "base/plane_vectors.h"
#include "base/quadrature.h"
#include "base/roots.h"
#include "base/units.h"

namespace swarf::motion {
namespace {

constexpr int kPaperSegments = 52;
constexpr double kPaperTolerance = 1.0 * kMicrometre;

Vec2 point(double u) {
  return {((10.0 * u + 10.0) * u) * u + 10.0, (10.0 * u + 10.0) * u};
}

Vec2 tangent(double u) {
  return {(30.0 * u + 20.0) * u, 20.0 * u + 10.0};
}

Vec2 normal(double u) {
  const Vec2 t = tangent(u).normalized();
  return {t.y(), -t.x()};
}

double angle_between_deg(const Vec2& a, const Vec2& b) {
  return deg_from_rad(std::abs(std::atan2(cross(a, b), a.dot(b))));
}

/// Root of an increasing or decreasing f between a and b.
double root(const std::function<double(double)>& f, double a, double b) {
  return bracketed_root(f, a, b, f(a), f(b));
}

/// Greatest distance of the curve from the chord u0-u1: where the tangent is parallel to the chord. The curve
/// is convex on [0,1], so there is one such u and cross(chord, tangent) changes its sign there.
double circle_chord_error(double u0, double u1) {
  const Vec2 chord = (point(u1) - point(u0)).normalized();
  const double u = root([&](double x) { return cross(chord, tangent(x)); }, u0, u1);
  return std::abs(cross(chord, point(u) - point(u0)));
}

enum class Interpolation { kLinearInU, kLinearAlongChord, kConstant };

/// Angle between the interpolated and the true normal at u inside the segment u0-u1.
double orientation_error_deg(Interpolation how, double u0, double u1, double u) {
  const Vec2 chord = point(u1) - point(u0);
  double fraction = 0.0;
  if (how == Interpolation::kLinearInU) fraction = (u - u0) / (u1 - u0);
  if (how == Interpolation::kLinearAlongChord)
    fraction = (point(u) - point(u0)).dot(chord) / chord.squaredNorm();
  return angle_between_deg(normal(u0) + fraction * (normal(u1) - normal(u0)), normal(u));
}

/// Ends of the longest segments that keep the tolerance, from u = 0; stops at 1 or after `most` segments.
std::vector<double> greedy(double tolerance, int most) {
  std::vector<double> ends{0.0};
  while (ends.back() < 1.0 && static_cast<int>(ends.size()) <= most) {
    const double start = ends.back();
    if (circle_chord_error(start, 1.0) <= tolerance) {
      ends.push_back(1.0);
    } else {
      constexpr double kNoError = 1e-6;  // so short a chord misses the curve by far less than a picometre
      ends.push_back(
          root([&](double u) { return circle_chord_error(start, u) - tolerance; }, start + kNoError, 1.0));
    }
  }
  return ends;
}

std::vector<double> equal_du(int segments) {
  std::vector<double> ends(static_cast<size_t>(segments) + 1);
  for (int i = 0; i <= segments; ++i) ends[static_cast<size_t>(i)] = static_cast<double>(i) / segments;
  return ends;
}

/// The tolerance with which the greedy rule just reaches u = 1 in so many segments is their common error.
std::vector<double> equal_chord_error(int segments) {
  const auto shortfall = [&](double tolerance) {
    const std::vector<double> ends = greedy(tolerance, segments);
    return static_cast<int>(ends.size()) <= segments ? 1.0 : ends.back() - 1.0 + 1e-15;
  };
  double low = 0.5 * kPaperTolerance;
  double high = 2.0 * kPaperTolerance;
  for (int i = 0; i < 60; ++i) {  // 2^-60 of a micrometre is below the last bit
    const double middle = 0.5 * (low + high);
    (shortfall(middle) < 0.0 ? low : high) = middle;
  }
  std::vector<double> ends = greedy(high, segments);
  ends.back() = 1.0;
  return ends;
}

/// In pieces over which Gauss' rule meets the last bit of the total (twice as many change none).
double arc_length(double u) {
  constexpr int kPieces = 16;
  double sum = 0.0;
  for (int i = 0; i < kPieces; ++i) {
    sum +=
        smooth_integral([](double x) { return tangent(x).norm(); }, u * i / kPieces, u * (i + 1) / kPieces);
  }
  return sum;
}

std::vector<double> equal_arc(int segments) {
  const double total = arc_length(1.0);
  std::vector<double> ends{0.0};
  for (int i = 1; i < segments; ++i) {
    ends.push_back(root([&](double u) { return arc_length(u) - total * i / segments; }, 0.0, 1.0));
  }
  ends.push_back(1.0);
  return ends;
}

Fig6Row measure(std::string name, const std::vector<double>& ends) {
  constexpr int kSamples = 32;
  constexpr int kPlotPoints = 8;  // per segment: enough for its arch to look round
  Fig6Row row;
  row.segmentation = std::move(name);
  row.segments = static_cast<int>(ends.size()) - 1;
  for (size_t i = 0; i + 1 < ends.size(); ++i) {
    const double u0 = ends[i];
    const double u1 = ends[i + 1];
    const auto greatest = [&](Interpolation how) {
      return greatest_sampled([&](double u) { return orientation_error_deg(how, u0, u1, u); }, u0, u1,
                              kSamples)
          .value;
    };
    row.chord_error_um = std::max(row.chord_error_um, um_from_mm(circle_chord_error(u0, u1)));
    row.linear_u_deg = std::max(row.linear_u_deg, greatest(Interpolation::kLinearInU));
    row.linear_chord_deg = std::max(row.linear_chord_deg, greatest(Interpolation::kLinearAlongChord));
    row.constant_deg = std::max(row.constant_deg, greatest(Interpolation::kConstant));
    for (int k = 0; k < kPlotPoints; ++k) {
      const double u = u0 + (u1 - u0) * k / kPlotPoints;
      row.curve.emplace_back(u, orientation_error_deg(Interpolation::kLinearAlongChord, u0, u1, u));
    }
  }
  row.curve.emplace_back(1.0, 0.0);
  return row;
}

}  // namespace

std::vector<Fig6Row> reproduce_fig6() {
  return {measure("equal du", equal_du(kPaperSegments)),
          measure("equal chord error", equal_chord_error(kPaperSegments)),
          measure("equal arc length", equal_arc(kPaperSegments)),
          measure("greedy, 1 um", greedy(kPaperTolerance, 1000))};
}

double fig6_position_error_mm() {
  const Vec3 arm(8.0, 96.0, 120.0);
  return (Eigen::AngleAxisd(rad_from_deg(0.017), Vec3::UnitX()) * arm - arm).norm();
}

}  // namespace swarf::motion
