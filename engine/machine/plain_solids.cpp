#include "machine/plain_solids.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace swarf::machine {
namespace {

constexpr double kThickerMm = 0.05;  // of a cylinder's prism
constexpr int kSidesLeast = 24;

uint32_t add_point(TriMesh& mesh, const Vec3& p) {
  mesh.positions.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  return static_cast<uint32_t>(mesh.positions.size() - 1);
}

/// Around a circle: its sides touch it in their middles.
int sides_around(double radius) {
  const double half = std::acos(radius / (radius + kThickerMm));
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

void add_cylinder(TriMesh& mesh, const Vec3& foot, double radius_mm, double height_mm) {
  const int sides = sides_around(radius_mm);
  const double corner = radius_mm / std::cos(std::numbers::pi / sides);
  const uint32_t low = add_point(mesh, foot), high = add_point(mesh, foot + Vec3(0.0, 0.0, height_mm));
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    const Vec3 p = foot + Vec3(corner * std::cos(angle), corner * std::sin(angle), 0.0);
    add_point(mesh, p);
    add_point(mesh, p + Vec3(0.0, 0.0, height_mm));
  }
  for (int i = 0; i < sides; ++i) {
    const uint32_t a = first + 2U * static_cast<uint32_t>(i),
                   b = first + 2U * static_cast<uint32_t>((i + 1) % sides);
    mesh.triangles.push_back({low, b, a});
    mesh.triangles.push_back({high, a + 1, b + 1});
    mesh.triangles.push_back({a, b, b + 1});
    mesh.triangles.push_back({a, b + 1, a + 1});
  }
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

}  // namespace swarf::machine
