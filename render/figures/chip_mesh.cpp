#include "render/figures/chip_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/units.h"

namespace swarf::render {
namespace {

constexpr uint32_t kSections = 7;  // of the strip, both ends among them
constexpr double kTurn = 1.7 * kPi;
// Of the helix' radius.
constexpr double kThickness = 0.22, kWidth = 0.8, kRise = 0.5;

}  // namespace

TriMesh chip_mesh(double size_mm) {
  TriMesh mesh;
  double reach = 0.0;
  std::vector<Vec3> corners;
  for (uint32_t i = 0; i < kSections; ++i) {
    const double share = static_cast<double>(i) / (kSections - 1), angle = share * kTurn;
    const double low = kRise * (share - 0.5) - 0.5 * kWidth;
    // Around the section, seen along the strip: inner low, outer low, outer high, inner high.
    for (const auto& [rho, z] : {std::pair(1.0 - kThickness, low), std::pair(1.0, low),
                                 std::pair(1.0, low + kWidth), std::pair(1.0 - kThickness, low + kWidth)}) {
      corners.emplace_back(rho * std::cos(angle), rho * std::sin(angle), z);
      reach = std::max(reach, corners.back().norm());
    }
  }
  for (const Vec3& corner : corners) {
    const Vec3 p = 0.5 * size_mm / reach * corner;
    mesh.positions.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
  for (uint32_t i = 0; i + 1 < kSections; ++i) {
    for (uint32_t k = 0; k < 4; ++k) {
      const uint32_t a = 4 * i + k, b = 4 * i + (k + 1) % 4;
      mesh.triangles.push_back({a, a + 4, b});
      mesh.triangles.push_back({b, a + 4, b + 4});
    }
  }
  const uint32_t end = 4 * (kSections - 1);
  for (const auto& triangle :
       {std::array<uint32_t, 3>{0, 1, 2}, {0, 2, 3}, {end, end + 2, end + 1}, {end, end + 3, end + 2}})
    mesh.triangles.push_back(triangle);
  return mesh;
}

}  // namespace swarf::render
