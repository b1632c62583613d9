// Small scenes for the tests of the rasteriser.
#pragma once

#include "mesh/tri_mesh.h"
#include "render/camera.h"
#include "render/draw_list.h"

namespace swarf::render {

/// A box without normals: flat shading.
inline TriMesh box_mesh(const Box& box) {
  TriMesh mesh;
  for (const Vec3& c : corners(box)) {
    mesh.positions.push_back(
        {static_cast<float>(c.x()), static_cast<float>(c.y()), static_cast<float>(c.z())});
  }
  constexpr uint32_t kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : kFaces) {
    mesh.triangles.push_back({f[0], f[1], f[2]});
    mesh.triangles.push_back({f[0], f[2], f[3]});
  }
  return mesh;
}

inline DrawItem item(const TriMesh& mesh, const Rgb& colour) {
  DrawItem result;
  result.mesh = &mesh;
  result.material = {colour, 0.0F, 0.9F};
  return result;
}

struct Pixel {
  int r, g, b;
};

inline Pixel pixel(const Image& image, int x, int y) {
  const uint8_t* p = &image.rgba[4 * (static_cast<size_t>(y) * image.width + x)];
  return {p[0], p[1], p[2]};
}

}  // namespace swarf::render
