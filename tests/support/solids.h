// Closed meshes with known answers: towers over a grid, spheres, tori.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <utility>
#include <vector>

#include "mesh/tri_mesh.h"

namespace swarf::test {

/// Adds triangles with vertices of their own: the loaders and the checks weld them.
inline void add_triangle(TriMesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (const Vec3& p : {a, b, c}) {
    mesh.positions.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
}

inline void add_quad(TriMesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  add_triangle(mesh, a, b, c);
  add_triangle(mesh, a, c, d);
}

/// A solid over a grid of x and y lines: cell (i, j) is filled from `bottom` to top(i, j). Its faces are
/// divided at every line and height, so that it is closed by vertices too.
inline TriMesh towers(const std::vector<double>& x, const std::vector<double>& y, double bottom,
                      const std::function<double(int, int)>& top) {
  const int nx = static_cast<int>(x.size()) - 1, ny = static_cast<int>(y.size()) - 1;
  std::vector<double> z{bottom};
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < ny; ++j) z.push_back(top(i, j));
  }
  std::sort(z.begin(), z.end());
  z.erase(std::unique(z.begin(), z.end()), z.end());
  const int nz = static_cast<int>(z.size()) - 1;
  const auto solid = [&](int i, int j, int k) {
    return i >= 0 && j >= 0 && k >= 0 && i < nx && j < ny && k < nz && z[k] < top(i, j);
  };
  TriMesh mesh;
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < ny; ++j) {
      for (int k = 0; k < nz; ++k) {
        if (!solid(i, j, k)) continue;
        const auto p = [&](int a, int b, int c) { return Vec3(x[i + a], y[j + b], z[k + c]); };
        if (!solid(i + 1, j, k)) add_quad(mesh, p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), p(1, 0, 1));
        if (!solid(i - 1, j, k)) add_quad(mesh, p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0));
        if (!solid(i, j + 1, k)) add_quad(mesh, p(0, 1, 0), p(0, 1, 1), p(1, 1, 1), p(1, 1, 0));
        if (!solid(i, j - 1, k)) add_quad(mesh, p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1));
        if (!solid(i, j, k + 1)) add_quad(mesh, p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1));
        if (!solid(i, j, k - 1)) add_quad(mesh, p(0, 0, 0), p(0, 1, 0), p(1, 1, 0), p(1, 0, 0));
      }
    }
  }
  return mesh;
}

inline TriMesh block(const Vec3& low, const Vec3& high) {
  return towers({low.x(), high.x()}, {low.y(), high.y()}, low.z(), [&](int, int) { return high.z(); });
}

inline TriMesh sphere(double radius, const Vec3& centre, int around, int down) {
  const auto p = [&](int i, int j) {
    const double a = 2.0 * M_PI * (i % around) / around, b = M_PI * j / down;
    if (j == 0 || j == down) return Vec3(centre + Vec3(0, 0, j == 0 ? radius : -radius));
    return Vec3(centre + radius * Vec3(std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), std::cos(b)));
  };
  TriMesh mesh;
  for (int i = 0; i < around; ++i) {
    add_triangle(mesh, p(i, 0), p(i, 1), p(i + 1, 1));
    add_triangle(mesh, p(i, down), p(i + 1, down - 1), p(i, down - 1));
    for (int j = 1; j + 1 < down; ++j) add_quad(mesh, p(i, j), p(i, j + 1), p(i + 1, j + 1), p(i + 1, j));
  }
  return mesh;
}

inline TriMesh torus(double ring, double tube, const Vec3& centre, int around, int across) {
  const auto p = [&](int i, int j) {
    const double a = 2.0 * M_PI * (i % around) / around, b = 2.0 * M_PI * (j % across) / across;
    const double r = ring + tube * std::cos(b);
    return Vec3(centre + Vec3(r * std::cos(a), r * std::sin(a), tube * std::sin(b)));
  };
  TriMesh mesh;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) add_quad(mesh, p(i, j), p(i + 1, j), p(i + 1, j + 1), p(i, j + 1));
  }
  return mesh;
}

inline void append(TriMesh& mesh, const TriMesh& more) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), more.positions.begin(), more.positions.end());
  for (const auto& t : more.triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

inline void scale(TriMesh& mesh, double factor) {
  for (auto& p : mesh.positions) {
    for (float& value : p) value = static_cast<float>(factor * value);
  }
}

/// The mirror image in x, turned outward again.
inline void mirror(TriMesh& mesh) {
  for (auto& p : mesh.positions) p[0] = -p[0];
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
}

/// The mesh inside out.
inline TriMesh turned(TriMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// One mesh of several bodies.
inline TriMesh together(std::initializer_list<TriMesh> bodies) {
  TriMesh all;
  for (const TriMesh& body : bodies) append(all, body);
  return all;
}

}  // namespace swarf::test
