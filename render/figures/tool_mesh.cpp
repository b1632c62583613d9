#include "render/figures/tool_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/check.h"
#include "base/units.h"
#include "mesh/mesh_ops.h"
#include "render/figures/figure_mesh.h"

namespace swarf::render {
namespace {

constexpr int kFlutes = 4;
constexpr double kHelixRad = rad_from_deg(30.0);
constexpr double kToolCreaseRad = rad_from_deg(55.0);
/// Share of the flute length over which the gullets run out into the shank.
constexpr double kRunOut = 0.22;

struct SectionPoint {
  double turn;    ///< share of the flute's sector, from the cutting edge backwards
  double radius;  ///< share of the cutter's radius
};

/// One flute's sector of the cross-section: margin, relief, gullet, rake face.
constexpr std::array<SectionPoint, 12> kSection{{{0.00, 1.000},
                                                 {0.06, 0.996},
                                                 {0.12, 0.985},
                                                 {0.26, 0.945},
                                                 {0.38, 0.900},
                                                 {0.50, 0.800},
                                                 {0.60, 0.700},
                                                 {0.70, 0.620},
                                                 {0.79, 0.585},
                                                 {0.87, 0.615},
                                                 {0.93, 0.700},
                                                 {0.975, 0.860}}};
constexpr auto kAround = static_cast<uint32_t>(kFlutes * kSection.size());

/// Depth of the gullets at height z: 1 along the flutes, falling smoothly to 0 at their end.
double gullet_depth(double z, double flute_length) {
  const double t = std::clamp((flute_length - z) / (kRunOut * flute_length), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

void add_ring(TriMesh& mesh, double radius, double depth, double turn_rad, double z) {
  for (uint32_t k = 0; k < kAround; ++k) {
    const SectionPoint& s = kSection[k % kSection.size()];
    // Seen from the shank, a right-hand cutter turns clockwise, towards smaller angles: the edge leads at the
    // smaller end of its sector and margin, relief and gullet follow at larger angles.
    const double sector = std::floor(static_cast<double>(k) / kSection.size());
    const double angle = turn_rad + (sector + s.turn) * 2.0 * kPi / kFlutes;
    const double r = radius * (1.0 - depth * (1.0 - s.radius));
    mesh.positions.push_back({static_cast<float>(r * std::cos(angle)),
                              static_cast<float>(r * std::sin(angle)), static_cast<float>(z)});
  }
}

void join_rings(TriMesh& mesh, uint32_t low, uint32_t high) {
  for (uint32_t k = 0; k < kAround; ++k) {
    const uint32_t next = (k + 1) % kAround;
    mesh.triangles.push_back({low + k, low + next, high + next});
    mesh.triangles.push_back({low + k, high + next, high + k});
  }
}

/// Closes a ring by a fan about a point of the axis; `up` for the top end.
void add_cap(TriMesh& mesh, uint32_t ring, double z, bool up) {
  const auto centre = static_cast<uint32_t>(mesh.positions.size());
  mesh.positions.push_back({0.0F, 0.0F, static_cast<float>(z)});
  for (uint32_t k = 0; k < kAround; ++k) {
    const uint32_t next = (k + 1) % kAround;
    mesh.triangles.push_back(up ? std::array{centre, ring + k, ring + next}
                                : std::array{centre, ring + next, ring + k});
  }
}

}  // namespace

TriMesh tool_mesh(double diameter, double flute_length, double shank_diameter, double length) {
  SWARF_CHECK(diameter > 0.0 && shank_diameter > 0.0 && 0.0 < flute_length && flute_length < length,
              "proportions of the cutter");
  const double radius = 0.5 * diameter, shank = 0.5 * shank_diameter;
  const double twist_per_mm = std::tan(kHelixRad) / radius;
  const double step = std::min(0.05 * diameter, flute_length / 8.0);
  const int levels = static_cast<int>(std::ceil(flute_length / step));
  TriMesh mesh;
  std::vector<uint32_t> rings;
  const auto ring = [&](double r, double depth, double turn, double z) {
    rings.push_back(static_cast<uint32_t>(mesh.positions.size()));
    add_ring(mesh, r, depth, turn, z);
  };
  for (int i = 0; i <= levels; ++i) {
    const double z = flute_length * i / levels;
    ring(radius, gullet_depth(z, flute_length), twist_per_mm * z, z);
  }
  const double turn = twist_per_mm * flute_length;
  // The step to a different shank is a short cone; the shank's end is bevelled.
  const double cone_end = std::min(flute_length + std::abs(shank - radius), 0.5 * (flute_length + length));
  const double bevel = std::min(0.06 * shank_diameter, 0.25 * (length - cone_end));
  if (shank != radius) ring(shank, 0.0, turn, cone_end);
  ring(shank, 0.0, turn, length - bevel);
  ring(shank - bevel, 0.0, turn, length);
  for (size_t i = 0; i + 1 < rings.size(); ++i) join_rings(mesh, rings[i], rings[i + 1]);
  // The end face is dished as on a real cutter, so that only the edges touch the plane of the tip.
  add_cap(mesh, rings.front(), 0.03 * diameter, false);
  add_cap(mesh, rings.back(), length, true);
  mesh::compute_vertex_normals(mesh, kToolCreaseRad);
  return mesh;
}

TriMesh holder_mesh(double diameter, double length) {
  SWARF_CHECK(diameter > 0.0 && length > 0.0, "size of the holder");
  const double r = 0.5 * diameter, l = length;
  const double b = std::min(0.03 * diameter, 0.02 * length);
  const std::array<Vec2, 22> profile{Vec2(0, 0),
                                     Vec2(0.52 * r - b, 0),
                                     Vec2(0.52 * r, b),
                                     Vec2(0.70 * r, 0.07 * l),
                                     Vec2(0.70 * r, 0.24 * l - b),
                                     Vec2(0.70 * r - b, 0.24 * l),
                                     Vec2(0.60 * r, 0.24 * l),
                                     Vec2(0.60 * r, 0.60 * l),
                                     Vec2(0.64 * r, 0.66 * l),
                                     Vec2(0.72 * r, 0.70 * l),
                                     Vec2(r - b, 0.70 * l),
                                     Vec2(r, 0.70 * l + b),
                                     Vec2(r, 0.77 * l - b),
                                     Vec2(r - b, 0.77 * l),
                                     Vec2(0.86 * r, 0.80 * l),
                                     Vec2(0.86 * r, 0.85 * l),
                                     Vec2(r - b, 0.88 * l),
                                     Vec2(r, 0.88 * l + b),
                                     Vec2(r, l - b),
                                     Vec2(r - b, l),
                                     Vec2(0.5 * r, l),
                                     Vec2(0, l)};
  return revolved_profile(profile, 96);
}

}  // namespace swarf::render
