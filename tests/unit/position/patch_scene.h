// Patches, cutters and an independent search by sampling for the tests of the position calculator.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "base/units.h"
#include "position/patch_target.h"
#include "surface/analytic.h"
#include "surface/polynomial.h"

namespace swarf::position {

inline ToolProfile end_mill(cutter::Shape shape, double diameter, double corner = 0.0) {
  cutter::Cutter tool;
  tool.shape = shape;
  tool.diameter_mm = diameter;
  tool.corner_radius_mm = corner;
  return ToolProfile(tool);
}
inline ToolProfile ball_end(double radius) {
  return end_mill(cutter::Shape::kBall, 2.0 * radius, radius);
}
inline ToolProfile flat_end(double radius) {
  return end_mill(cutter::Shape::kFlat, 2.0 * radius);
}
inline ToolProfile nose_end(double flat, double corner) {
  return end_mill(cutter::Shape::kBullNose, 2.0 * (flat + corner), corner);
}
/// A drill of a point of this slope: a cone from the tip.
inline ToolProfile pointed(double radius, double slope) {
  cutter::Cutter tool;
  tool.shape = cutter::Shape::kProfile;
  tool.diameter_mm = 2.0 * radius;
  tool.profile = {{{0.0, 0.0}, 0.0}, {{radius, radius * slope}, 0.0}, {{radius, radius * slope + 20.0}, 0.0}};
  return ToolProfile(tool);
}

inline Patch polynomial(int degree_u, int degree_v, std::vector<Vec3> coefficients) {
  return {std::make_shared<surface::PolynomialSurface>(degree_u, degree_v, std::move(coefficients), 1)};
}
inline Patch bezier(int degree_u, int degree_v, const std::vector<Vec3>& poles) {
  return {std::make_shared<surface::PolynomialSurface>(
      surface::PolynomialSurface::from_bezier(degree_u, degree_v, poles, 1))};
}
inline Patch plane_patch(const Vec3& origin, const Vec3& u, const Vec3& v) {
  return {std::make_shared<surface::PlaneSurface>(origin, u, v)};
}
/// theory 1.6
inline Patch dome_patch() {
  std::vector<Vec3> c(9, Vec3::Zero());
  c[0] = {-50, -40, 0};
  c[1] = {0, 80, 60};
  c[2] = {0, 0, -60};
  c[3] = {100, 0, 80};
  c[6] = {0, 0, -80};
  return polynomial(2, 2, c);
}
/// z = (a x^2 + c y^2) / 2 + b x y over |x|, |y| <= size.
inline Patch quadric_patch(double a, double b, double c, double size) {
  std::vector<Vec3> p(9, Vec3::Zero());
  // x = size (2u - 1), y = size (2v - 1)
  const double s2 = size * size;
  p[0] = {-size, -size, s2 * (0.5 * a + b + 0.5 * c)};
  p[3] = {2 * size, 0, s2 * (-2 * a - 2 * b)};
  p[1] = {0, 2 * size, s2 * (-2 * c - 2 * b)};
  p[6] = {0, 0, 2 * a * s2};
  p[2] = {0, 0, 2 * c * s2};
  p[4] = {0, 0, 4 * b * s2};
  return polynomial(2, 2, p);
}

/// 50 x 50 mm of z = 4 sin(.15 x) cos(.13 y) + .004 x y as 4 x 4 bicubic patches with common normals.
inline std::vector<Patch> wavy_patches() {
  constexpr double kSide = 12.5;
  const auto z = [](double x, double y) {
    return 4.0 * std::sin(0.15 * x) * std::cos(0.13 * y) + 0.004 * x * y;
  };
  const auto zx = [](double x, double y) {
    return 0.6 * std::cos(0.15 * x) * std::cos(0.13 * y) + 0.004 * y;
  };
  const auto zy = [](double x, double y) {
    return -0.52 * std::sin(0.15 * x) * std::sin(0.13 * y) + 0.004 * x;
  };
  const auto zxy = [](double x, double y) {
    return -0.078 * std::cos(0.15 * x) * std::sin(0.13 * y) + 0.004;
  };
  std::vector<Patch> patches;
  for (int i = 0; i < 16; ++i) {
    const double x0 = kSide * (i % 4 - 2), y0 = kSide * (i / 4 - 2);
    std::vector<Vec3> poles;
    for (int k = 0; k < 16; ++k) {
      // Poles from value and slopes at the nearest corner.
      const double x = x0 + kSide * (k / 8), y = y0 + kSide * (k % 4 / 2);
      const double px = x0 + kSide * (k / 4) / 3.0, py = y0 + kSide * (k % 4) / 3.0;
      const double dx = px - x, dy = py - y;
      poles.push_back({px, py, z(x, y) + zx(x, y) * dx + zy(x, y) * dy + zxy(x, y) * dx * dy});
    }
    patches.push_back(bezier(3, 3, poles));
  }
  return patches;
}

inline Rest rest_on(const PatchTarget& target, const ToolProfile& profile, const GuideLine& line,
                    PatchWork* work = nullptr) {
  Rest best;
  PatchHint near;
  PatchWork own;
  target.raise(profile, line, best, near, work != nullptr ? *work : own);
  return best;
}

/// What the place (u,v) asks for, straight from the definition.
inline double asked(const surface::Surface& surface, const ToolProfile& profile, const GuideLine& line,
                    double u, double v) {
  const Vec3 p = line.local(surface.point(std::clamp(u, 0.0, 1.0), std::clamp(v, 0.0, 1.0)));
  const double rho = std::hypot(p.x(), p.y());
  return rho <= profile.radius() ? p.z() - profile.height(rho) : -std::numeric_limits<double>::infinity();
}

/// The greatest of a grid and of grids about its best places, each narrower than the last: a lower bound of
/// the height that shares no code with the search, and comes to a nanometre of it on smooth tools.
inline double sampled_height(const std::vector<Patch>& patches, const ToolProfile& profile,
                             const GuideLine& line, int grid = 200) {
  double best = -std::numeric_limits<double>::infinity();
  for (const Patch& patch : patches) {
    struct Sample {
      double height, u, v;
    };
    std::vector<Sample> samples;
    for (int i = 0; i <= grid; ++i) {
      for (int j = 0; j <= grid; ++j) {
        const double u = static_cast<double>(i) / grid, v = static_cast<double>(j) / grid;
        samples.push_back({asked(*patch.surface, profile, line, u, v), u, v});
      }
    }
    const auto keep = samples.begin() + 12;
    std::partial_sort(samples.begin(), keep, samples.end(),
                      [](const Sample& a, const Sample& b) { return a.height > b.height; });
    for (auto sample = samples.begin(); sample != keep; ++sample) {
      double width = 1.0 / grid;
      for (int round = 0; round < 60; ++round, width *= 0.7) {
        const Sample centre = *sample;
        for (int i = -4; i <= 4; ++i) {
          for (int j = -4; j <= 4; ++j) {
            const double u = std::clamp(centre.u + 0.5 * i * width, 0.0, 1.0);
            const double v = std::clamp(centre.v + 0.5 * j * width, 0.0, 1.0);
            const double height = asked(*patch.surface, profile, line, u, v);
            if (height > sample->height) *sample = {height, u, v};
          }
        }
      }
      best = std::max(best, sample->height);
    }
  }
  return best;
}

}  // namespace swarf::position
