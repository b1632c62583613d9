// The plain triangle mesh that crosses module borders; heavy mesh libraries stay behind it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/frames.h"

namespace swarf {

/// Triangles wind counter-clockwise seen from outside. Per-vertex arrays are empty or as long as `positions`.
struct TriMesh {
  std::vector<std::array<float, 3>> positions;  ///< mm
  std::vector<std::array<uint32_t, 3>> triangles;
  std::vector<std::array<float, 3>> normals;    ///< unit; empty: renderers shade flat
  std::vector<std::array<uint8_t, 4>> colours;  ///< sRGB + alpha; empty: the draw item's colour
  std::vector<float> deviation_um;              ///< signed distance to the design, excess > 0; empty: unknown
};

}  // namespace swarf
