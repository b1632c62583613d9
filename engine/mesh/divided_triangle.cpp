#include "mesh/divided_triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mesh/mixed_corners.h"

namespace swarf::mesh {
namespace {

/// A vertex on the outline and the sides that it lies on, by bits: a corner on two.
struct OutlinePlace {
  uint32_t vertex;
  unsigned sides;
};

/// Of a diagonal; the lesser is better: unlike values first, then long ways.
std::pair<double, double> diagonal_cost(const TriMesh& mesh, double saturates, uint32_t a, uint32_t b) {
  constexpr double kSameUm = 0.05;
  const auto shown = [&](uint32_t v) {
    return std::clamp(double{mesh.deviation_um[v]}, -saturates, saturates);
  };
  const double apart = std::abs(shown(a) - shown(b));
  const double steps = std::isnan(apart) ? 0.0 : std::floor(apart / kSameUm);
  return {steps, (vec3_of(mesh.positions[a]) - vec3_of(mesh.positions[b])).norm()};
}

}  // namespace

std::vector<std::array<uint32_t, 3>> divided_triangle(const TriMesh& mesh,
                                                      const std::array<uint32_t, 3>& corners,
                                                      const std::array<std::vector<uint32_t>, 3>& on,
                                                      double saturates) {
  std::vector<OutlinePlace> outline;
  for (size_t k = 0; k < 3; ++k) {
    outline.push_back({corners[k], 1U << k | 1U << (k + 2) % 3});
    for (const uint32_t v : on[k]) outline.push_back({v, 1U << k});
  }
  std::vector<std::array<uint32_t, 3>> parts;
  while (outline.size() > 3) {
    const size_t n = outline.size();
    size_t ear = n;
    std::pair least(std::numeric_limits<double>::infinity(), 0.0);
    for (size_t i = 0; i < n; ++i) {
      const OutlinePlace &before = outline[(i + n - 1) % n], &after = outline[(i + 1) % n];
      if ((before.sides & after.sides) != 0) continue;  // along a side
      const auto found = diagonal_cost(mesh, saturates, before.vertex, after.vertex);
      if (!(found < least)) continue;
      least = found;
      ear = i;
    }
    if (ear == n) break;
    parts.push_back({outline[(ear + n - 1) % n].vertex, outline[ear].vertex, outline[(ear + 1) % n].vertex});
    outline.erase(outline.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  if (outline.size() == 3) parts.push_back({outline[0].vertex, outline[1].vertex, outline[2].vertex});
  return parts;
}

}  // namespace swarf::mesh
