// What the position calculator is held against: cutters by their closed forms, and the highest rest on
// triangles by search over their points, without anything of engine/position.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "base/frames.h"
#include "base/rng.h"
#include "base/units.h"
#include "cutter/cutter.h"
#include "cutter/profile.h"
#include "mesh/tri_mesh.h"
#include "position/rest.h"

namespace swarf::position {

struct NamedCutter {
  std::string name;
  cutter::Cutter cutter;
};

/// Flat, ball, bull nose, taper with flat and with ball end, APT with alpha and beta, drill.
inline std::vector<NamedCutter> cutters_under_test() {
  std::vector<NamedCutter> all;
  const auto add = [&all](const char* name, cutter::Shape shape, double diameter, double corner) {
    NamedCutter& c = all.emplace_back();
    c.name = name;
    c.cutter.shape = shape;
    c.cutter.diameter_mm = diameter;
    c.cutter.corner_radius_mm = corner;
  };
  add("flat", cutter::Shape::kFlat, 10.0, 0.0);
  add("ball", cutter::Shape::kBall, 10.0, 5.0);
  add("bull_nose", cutter::Shape::kBullNose, 10.0, 2.0);
  add("taper_flat", cutter::Shape::kTaper, 4.0, 0.0);
  add("taper_ball", cutter::Shape::kTaper, 4.0, 2.0);
  add("apt", cutter::Shape::kApt, 12.0, 2.0);
  add("drill", cutter::Shape::kDrill, 10.0, 0.0);
  all[3].cutter.taper_rad = rad_from_deg(10.0);
  all[4].cutter.taper_rad = rad_from_deg(7.0);
  all[5].cutter.alpha_rad = rad_from_deg(8.0);
  all[5].cutter.beta_rad = rad_from_deg(15.0);
  all[6].cutter.point_angle_rad = rad_from_deg(118.0);
  for (NamedCutter& c : all) c.cutter.flute_length_mm = 12.0;
  return all;
}

/// Height of the underside by APT's seven parameters: bottom line, corner circle, flank.
struct ClosedForm {
  explicit ClosedForm(const cutter::Cutter& c) {
    const cutter::AptForm form = *cutter::apt_form(c);
    bottom = form.bottom_end();
    flank = form.flank_start();
    corner = form.corner_centre();
    corner_radius = form.r;
    bottom_slope = std::tan(form.alpha);
    flank_slope = form.beta > 0.0 ? 1.0 / std::tan(form.beta) : 0.0;
    radius = form.flank_end().x();
  }
  double height(double rho) const {
    if (rho <= bottom.x()) return rho * bottom_slope;
    if (rho <= flank.x() && corner_radius > 0.0) {
      const double out = rho - corner.x();
      return corner.y() - std::sqrt(std::max(0.0, corner_radius * corner_radius - out * out));
    }
    return flank.y() + (rho - flank.x()) * flank_slope;
  }
  /// dw/drho, of the part within rho.
  double slope(double rho) const {
    if (rho <= bottom.x()) return bottom_slope;
    if (rho > flank.x() || corner_radius == 0.0) return flank_slope;
    const double out = rho - corner.x();
    return out / std::sqrt(std::max(1e-300, corner_radius * corner_radius - out * out));
  }

  Vec2 bottom, flank, corner;  ///< where its parts meet, and the corner circle's centre; (rho, z), mm
  double corner_radius = 0.0, bottom_slope = 0.0, flank_slope = 0.0, radius = 0.0;
};

/// Golden section on a concave function.
inline double greatest(const std::function<double(double)>& f) {
  constexpr double kGolden = 0.6180339887498949;
  double a = 0.0, b = 1.0, best = std::max(f(a), f(b));
  double x = b - kGolden * (b - a), y = a + kGolden * (b - a), fx = f(x), fy = f(y);
  for (int i = 0; i < 80; ++i) {
    best = std::max({best, fx, fy});
    if (fx < fy) {
      a = x;
      x = y;
      fx = fy;
      fy = f(y = a + kGolden * (b - a));
    } else {
      b = y;
      y = x;
      fy = fx;
      fx = f(x = b - kGolden * (b - a));
    }
  }
  return best;
}

/// Beyond the radius the underside goes on this steeply: a slope less than this never gains by it.
constexpr double kWallSlope = 1e6;

/// Height that the point gives the tip; the axis as it is, without the line's other two directions.
inline double brute_point(const ClosedForm& tool, const GuideLine& line, const Vec3& p_W) {
  const Vec3 d = p_W - line.point_W;
  const double z = d.dot(line.axis_W), rho = d.cross(line.axis_W).norm();
  return z - tool.height(std::min(rho, tool.radius)) - kWallSlope * std::max(0.0, rho - tool.radius);
}

/// Highest rest on the triangle by two golden sections, one in the other; -infinity beside the tool: whatever
/// lies under it gives at least its lowest corner's height less the height of the underside's end.
inline double brute_triangle(const ClosedForm& tool, const GuideLine& line, const Vec3& a, const Vec3& b,
                             const Vec3& c) {
  const double best = greatest([&](double u) {
    const Vec3 from = a + u * (b - a), to = a + u * (c - a);
    return greatest([&](double v) { return brute_point(tool, line, from + v * (to - from)); });
  });
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& p : {a, b, c}) least = std::min(least, (p - line.point_W).dot(line.axis_W));
  const bool under = best >= least - tool.height(tool.radius) - 1e-6;
  return under ? best : -std::numeric_limits<double>::infinity();
}

inline Vec3 corner_of(const TriMesh& mesh, size_t triangle, size_t i) {
  const auto& p = mesh.positions[mesh.triangles[triangle][i]];
  return {p[0], p[1], p[2]};
}

/// Over every triangle whose highest corner is above what corners alone give; -infinity when none is under
/// the tool.
inline double brute_mesh(const ClosedForm& tool, const GuideLine& line, const TriMesh& mesh) {
  double best = -std::numeric_limits<double>::infinity();
  const auto corner = [&](size_t i, size_t k) { return corner_of(mesh, i, k); };
  for (size_t i = 0; i < 3 * mesh.triangles.size(); ++i) {
    const Vec3 p = corner(i / 3, i % 3);
    if ((p - line.point_W).cross(line.axis_W).norm() < tool.radius)
      best = std::max(best, brute_point(tool, line, p));
  }
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    double top = -std::numeric_limits<double>::infinity();
    for (size_t k = 0; k < 3; ++k) top = std::max(top, (corner(i, k) - line.point_W).dot(line.axis_W));
    if (top >= best)
      best = std::max(best, brute_triangle(tool, line, corner(i, 0), corner(i, 1), corner(i, 2)));
  }
  return best;
}

inline void add_triangle(TriMesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (const Vec3& p : {a, b, c}) {
    const Eigen::Vector3f f = p.cast<float>();
    mesh.positions.push_back({f.x(), f.y(), f.z()});
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
}

/// z = f(x, y) over n x n squares of the square about the origin, two triangles each.
inline TriMesh height_field(int n, double side, const std::function<double(double, double)>& f) {
  TriMesh mesh;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const double x = side * (static_cast<double>(i) / n - 0.5),
                   y = side * (static_cast<double>(j) / n - 0.5);
      mesh.positions.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(f(x, y))});
    }
  const auto at = [n](int i, int j) { return static_cast<uint32_t>(i * (n + 1) + j); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

/// Ready to paste.
inline std::string paste(const GuideLine& line) {
  char text[400];
  std::snprintf(text, sizeof text, "guide_line({%.17g, %.17g, %.17g}, {%.17g, %.17g, %.17g})",
                line.point_W.x(), line.point_W.y(), line.point_W.z(), line.axis_W.x(), line.axis_W.y(),
                line.axis_W.z());
  return text;
}
inline std::string paste(const TriMesh& mesh, size_t triangle) {
  std::string text = "add_triangle(mesh";
  for (size_t i = 0; i < 3; ++i) {
    const Vec3 p = corner_of(mesh, triangle, i);
    char corner[120];
    std::snprintf(corner, sizeof corner, ", {%.9g, %.9g, %.9g}", p.x(), p.y(), p.z());
    text += corner;
  }
  return text + ");\n";
}

}  // namespace swarf::position
