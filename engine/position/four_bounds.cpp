// Bounds of four nodes at once: loops without branches, of which the compiler makes vectors (CMakeLists.txt).
#include <algorithm>
#include <cmath>

#include "base/instruction_sets.h"
#include "position/sphere_tree.h"

namespace swarf::position {
namespace {

/// Nearer to the axis a centre has no direction; any serves.
constexpr double kOnAxis_mm = 1e-9;

/// Of the coordinates, per slope: above what rounding may do to a linear function of them.
constexpr double kLinearSlack = 1e-12;

const bool kRunsV3 = runs_x86_64_v3();

SWARF_KERNEL_INLINE void bound_nodes(const ToolProfile& profile, const GuideLine& line,
                                     const FourNodes& nodes, FourHeights& bounds) {
  const Vec3 p = line.point_W, x = line.x_W, y = line.y_W, axis = line.axis_W;
  const double tool = profile.radius();
  double cos_turn[4], sin_turn[4], rho[4], touch[4], slope[4], lift[4], height[4];
  for (int i = 0; i < 4; ++i) {
    const double dx = nodes.centre[0][i] - p.x(), dy = nodes.centre[1][i] - p.y();
    const double dz = nodes.centre[2][i] - p.z(), radius = nodes.radius[i];
    const double u = dx * x.x() + dy * x.y() + dz * x.z(), v = dx * y.x() + dy * y.y() + dz * y.z();
    const double distance = std::sqrt(u * u + v * v);
    const bool off = distance > kOnAxis_mm;
    const double scale = 1.0 / std::max(distance, kOnAxis_mm);
    cos_turn[i] = off ? u * scale : 1.0;
    sin_turn[i] = off ? v * scale : 0.0;
    height[i] = dx * axis.x() + dy * axis.y() + dz * axis.z();
    rho[i] = off ? distance : u;                   // along that direction
    touch[i] = distance * tool / (tool + radius);  // where a ball would touch the sphere
  }
  for (int i = 0; i < 4; ++i) {
    const Tangent& tangent = profile.tangent(touch[i]);
    slope[i] = tangent.slope;
    lift[i] = tangent.lift;
  }
  for (int i = 0; i < 4; ++i) {
    const double nx = nodes.normal[0][i], ny = nodes.normal[1][i], nz = nodes.normal[2][i];
    const double u = nx * x.x() + ny * x.y() + nz * x.z(), v = nx * y.x() + ny * y.y() + nz * y.z();
    const double up = nx * axis.x() + ny * axis.y() + nz * axis.z();
    const double out = u * cos_turn[i] + v * sin_turn[i], aside = v * cos_turn[i] - u * sin_turn[i];
    const double k = slope[i], radius = nodes.radius[i];
    // m = (-k, 0, 1) in the directions outwards, aside and up.
    const double along = up - k * out,
                 square = aside * aside * (1.0 + k * k) + (out + k * up) * (out + k * up);
    const double bound = height[i] - k * rho[i] + lift[i] + radius * std::sqrt(square) +
                         std::max(along * nodes.high[i], along * nodes.low[i]);
    bounds[i] = rho[i] > tool + radius ? kBeside : bound;
  }
}

SWARF_KERNEL_INLINE void bound_corners(const ToolProfile& profile, const GuideLine& line,
                                       const TreeTriangle* four, FourHeights& bounds) {
  const Vec3 p = line.point_W, x = line.x_W, y = line.y_W, axis = line.axis_W;
  double u[3][4], v[3][4], up[3][4], cos_turn[4], sin_turn[4], slope[4], lift[4], rho[4], reach[4];
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 4; ++i) {
      const auto& corner = four[i].corners[static_cast<size_t>(k)];
      const double dx = corner[0] - p.x(), dy = corner[1] - p.y(), dz = corner[2] - p.z();
      u[k][i] = dx * x.x() + dy * x.y() + dz * x.z();
      v[k][i] = dx * y.x() + dy * y.y() + dz * y.z();
      up[k][i] = dx * axis.x() + dy * axis.y() + dz * axis.z();
    }
  for (int i = 0; i < 4; ++i) {
    const double mu = (u[0][i] + u[1][i] + u[2][i]) / 3.0, mv = (v[0][i] + v[1][i] + v[2][i]) / 3.0;
    reach[i] = 0.0;
    for (int k = 0; k < 3; ++k) reach[i] += std::abs(u[k][i]) + std::abs(v[k][i]) + std::abs(up[k][i]);
    rho[i] = std::sqrt(mu * mu + mv * mv);
    const double scale = 1.0 / std::max(rho[i], kOnAxis_mm);  // no longer than of unit length: a bound
    cos_turn[i] = mu * scale;
    sin_turn[i] = mv * scale;
  }
  for (int i = 0; i < 4; ++i) {
    const Tangent& tangent = profile.tangent(rho[i]);
    slope[i] = tangent.slope;
    lift[i] = tangent.lift;
  }
  for (int i = 0; i < 4; ++i) {
    const double ku = slope[i] * cos_turn[i], kv = slope[i] * sin_turn[i];
    const double a = up[0][i] - (ku * u[0][i] + kv * v[0][i]), b = up[1][i] - (ku * u[1][i] + kv * v[1][i]);
    const double c = up[2][i] - (ku * u[2][i] + kv * v[2][i]);
    bounds[i] = std::max(std::max(a, b), c) + lift[i] + kLinearSlack * (1.0 + slope[i]) * (1.0 + reach[i]);
  }
}

SWARF_X86_64_V3 void bound_nodes_v3(const ToolProfile& profile, const GuideLine& line, const FourNodes& nodes,
                                    FourHeights& bounds) {
  bound_nodes(profile, line, nodes, bounds);
}
SWARF_X86_64_V3 void bound_corners_v3(const ToolProfile& profile, const GuideLine& line,
                                      const TreeTriangle* four, FourHeights& bounds) {
  bound_corners(profile, line, four, bounds);
}

}  // namespace

void height_bounds(const ToolProfile& profile, const GuideLine& line, const FourNodes& nodes,
                   FourHeights& bounds) {
  kRunsV3 ? bound_nodes_v3(profile, line, nodes, bounds) : bound_nodes(profile, line, nodes, bounds);
}

void corner_bounds(const ToolProfile& profile, const GuideLine& line, const TreeTriangle* four,
                   FourHeights& bounds) {
  kRunsV3 ? bound_corners_v3(profile, line, four, bounds) : bound_corners(profile, line, four, bounds);
}

}  // namespace swarf::position
