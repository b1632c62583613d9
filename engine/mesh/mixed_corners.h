// What is interpolated between the corners of a triangle. Internal to this folder.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/frames.h"

namespace swarf::mesh {

inline Vec3 vec3_of(const std::array<float, 3>& v) {
  return {v[0], v[1], v[2]};
}

inline std::array<float, 3> floats_of(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// Of positions or normals of a mesh; the shares have the sum 1.
inline Vec3 mixed_corners(const std::vector<std::array<float, 3>>& values,
                          const std::array<uint32_t, 3>& corners, const Vec3& shares) {
  return shares[0] * vec3_of(values[corners[0]]) + shares[1] * vec3_of(values[corners[1]]) +
         shares[2] * vec3_of(values[corners[2]]);
}

}  // namespace swarf::mesh
