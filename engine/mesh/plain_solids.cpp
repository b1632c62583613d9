#include "mesh/plain_solids.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "mesh/polygon.h"

namespace swarf::mesh {
namespace {

constexpr int kSidesLeast = 24;

uint32_t add_point(TriMesh& mesh, const Vec3& p) {
  mesh.positions.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  return static_cast<uint32_t>(mesh.positions.size() - 1);
}

/// Around a circle: its sides touch it in their middles.
int sides_around(double radius) {
  const double half = std::acos(radius / (radius + kRoundMm));
  return std::max(kSidesLeast, static_cast<int>(std::ceil(std::numbers::pi / half)));
}

}  // namespace

void add_box(TriMesh& mesh, const Box& box) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (int i = 0; i < 8; ++i) {
    add_point(mesh, {i & 1 ? box.upper.x() : box.lower.x(), i & 2 ? box.upper.y() : box.lower.y(),
                     i & 4 ? box.upper.z() : box.lower.z()});
  }
  constexpr std::array<std::array<uint32_t, 4>, 6> kFaces{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& f : kFaces) {
    mesh.triangles.push_back({first + f[0], first + f[1], first + f[2]});
    mesh.triangles.push_back({first + f[0], first + f[2], first + f[3]});
  }
}

void add_tube(TriMesh& mesh, const Vec3& base, const Vec3& axis, double radius_mm, double inner_radius_mm,
              double length_mm) {
  const int sides = sides_around(radius_mm);
  const double corner = radius_mm / std::cos(std::numbers::pi / sides);
  const Vec3 across = axis.unitOrthogonal(), sideways = axis.cross(across);
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  // Per side: outer corner at the base and at the end, inner corner at both (of a bar the middles).
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    const Vec3 out = std::cos(angle) * across + std::sin(angle) * sideways;
    for (const double radius : {corner, inner_radius_mm})
      for (const double along : {0.0, length_mm}) add_point(mesh, base + radius * out + along * axis);
  }
  const auto at = [&](int side, uint32_t place) {
    return first + 4U * static_cast<uint32_t>(side % sides) + place;
  };
  const auto quad = [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (int i = 0; i < sides; ++i) {
    quad(at(i, 0), at(i + 1, 0), at(i + 1, 1), at(i, 1));
    if (inner_radius_mm > 0.0) {
      quad(at(i, 2), at(i, 3), at(i + 1, 3), at(i + 1, 2));
      quad(at(i, 0), at(i, 2), at(i + 1, 2), at(i + 1, 0));
      quad(at(i, 1), at(i + 1, 1), at(i + 1, 3), at(i, 3));
    } else {
      mesh.triangles.push_back({at(i, 0), at(0, 2), at(i + 1, 0)});
      mesh.triangles.push_back({at(i, 1), at(i + 1, 1), at(0, 3)});
    }
  }
}

bool add_prism(TriMesh& mesh, const std::vector<Vec2>& corners, double low, double high) {
  const auto count = static_cast<uint32_t>(corners.size());
  TriMesh prism;
  for (const double z : {low, high})
    for (const Vec2& corner : corners) add_point(prism, {corner.x(), corner.y(), z});
  std::vector<uint32_t> top(count), bottom(count);
  std::iota(top.begin(), top.end(), count);
  for (uint32_t i = 0; i < count; ++i) bottom[i] = count - 1 - i;
  if (!append_polygon(top, prism.positions, prism.triangles) ||
      !append_polygon(bottom, prism.positions, prism.triangles))
    return false;
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t next = (i + 1) % count;
    prism.triangles.push_back({i, next, count + next});
    prism.triangles.push_back({i, count + next, count + i});
  }
  append(mesh, prism);
  return true;
}

void append(TriMesh& mesh, const TriMesh& more) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), more.positions.begin(), more.positions.end());
  for (const auto& t : more.triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

TriMesh moved(TriMesh mesh, const Pose& pose) {
  for (auto& p : mesh.positions) {
    const Vec3 to = pose * Vec3(p[0], p[1], p[2]);
    p = {static_cast<float>(to.x()), static_cast<float>(to.y()), static_cast<float>(to.z())};
  }
  for (auto& n : mesh.normals) {
    const Vec3 to = pose.linear() * Vec3(n[0], n[1], n[2]);
    n = {static_cast<float>(to.x()), static_cast<float>(to.y()), static_cast<float>(to.z())};
  }
  return mesh;
}

}  // namespace swarf::mesh
