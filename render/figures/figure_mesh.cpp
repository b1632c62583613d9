#include "render/figures/figure_mesh.h"

#include <array>
#include <cmath>

#include "base/check.h"
#include "base/units.h"
#include "mesh/mesh_ops.h"

namespace swarf::render {
namespace {

/// Profile segments that turn by more than this meet in a visible edge.
constexpr double kCreaseRad = rad_from_deg(30.0);

std::array<float, 3> to_float(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// +1 if the triangles (iu, iv), (iu+1, iv), (iu+1, iv+1) wind with the normals, -1 if against.
double grid_orientation(int nu, int nv, std::span<const Vec3> p, std::span<const Vec3> n) {
  double sum = 0.0;
  for (int iv = 0; iv + 1 < nv; ++iv) {
    for (int iu = 0; iu + 1 < nu; ++iu) {
      const size_t i = static_cast<size_t>(iv) * nu + iu;
      sum += (p[i + nu + 1] - p[i]).cross(p[i + nu] - p[i + 1]).dot(n[i]);
    }
  }
  return sum < 0.0 ? -1.0 : 1.0;
}

}  // namespace

TriMesh surface_grid_mesh(int nu, int nv, std::span<const Vec3> positions, std::span<const Vec3> normals) {
  const size_t count = static_cast<size_t>(nu) * static_cast<size_t>(nv);
  SWARF_CHECK(nu >= 2 && nv >= 2 && positions.size() == count && normals.size() == count, "grid sizes");
  TriMesh mesh;
  mesh.positions.reserve(count);
  mesh.normals.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    mesh.positions.push_back(to_float(positions[i]));
    mesh.normals.push_back(to_float(normals[i]));
  }
  const bool flip = grid_orientation(nu, nv, positions, normals) < 0.0;
  const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
    mesh.triangles.push_back(flip ? std::array{a, c, b} : std::array{a, b, c});
  };
  mesh.triangles.reserve(2 * static_cast<size_t>(nu - 1) * (nv - 1));
  for (int iv = 0; iv + 1 < nv; ++iv) {
    for (int iu = 0; iu + 1 < nu; ++iu) {
      const uint32_t a = static_cast<uint32_t>(iv) * nu + iu, b = a + 1, d = a + nu, c = d + 1;
      const bool split_ac = normals[a].dot(normals[c]) >= normals[b].dot(normals[d]);
      if (split_ac) {
        add(a, b, c);
        add(a, c, d);
      } else {
        add(a, b, d);
        add(b, c, d);
      }
    }
  }
  return mesh;
}

TriMesh revolved_profile(std::span<const Vec2> profile, int segments) {
  SWARF_CHECK(profile.size() >= 2 && segments >= 3,
              "a body of revolution needs a profile and three segments");
  TriMesh mesh;
  std::vector<uint32_t> ring_start;
  for (const Vec2& point : profile) {
    ring_start.push_back(static_cast<uint32_t>(mesh.positions.size()));
    const int copies = point.x() > 0.0 ? segments : 1;
    for (int k = 0; k < copies; ++k) {
      const double angle = 2.0 * kPi * k / segments;
      mesh.positions.push_back(
          to_float({point.x() * std::cos(angle), point.x() * std::sin(angle), point.y()}));
    }
  }
  for (size_t i = 0; i + 1 < profile.size(); ++i) {
    const bool low_is_axis = profile[i].x() <= 0.0, high_is_axis = profile[i + 1].x() <= 0.0;
    for (uint32_t k = 0; k < static_cast<uint32_t>(segments); ++k) {
      const uint32_t next = (k + 1) % segments;
      const uint32_t a = ring_start[i] + (low_is_axis ? 0 : k), b = ring_start[i] + (low_is_axis ? 0 : next);
      const uint32_t d = ring_start[i + 1] + (high_is_axis ? 0 : k);
      const uint32_t c = ring_start[i + 1] + (high_is_axis ? 0 : next);
      if (!low_is_axis) mesh.triangles.push_back({a, b, c});
      if (!high_is_axis) mesh.triangles.push_back({a, c, d});
    }
  }
  mesh::compute_vertex_normals(mesh, kCreaseRad);
  return mesh;
}

TriMesh cylinder_mesh(double diameter, double length, double bevel, int segments) {
  const double r = 0.5 * diameter;
  SWARF_CHECK(bevel > 0.0 && bevel < r && 2.0 * bevel < length, "bevel of a cylinder");
  const std::array<Vec2, 6> profile{
      Vec2(0, 0),     Vec2(r - bevel, 0), Vec2(r, bevel), Vec2(r, length - bevel), Vec2(r - bevel, length),
      Vec2(0, length)};
  return revolved_profile(profile, segments);
}

}  // namespace swarf::render
