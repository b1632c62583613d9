// Polygons of a mesh file as triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace swarf::mesh {

/// Polygons with more corners are not split: the search for ears is quadratic at best.
inline constexpr size_t kMostCorners = 1024;

/// Appends the triangles of a polygon (3 to kMostCorners corners, indices into `positions`), turned as it is.
/// A convex polygon becomes a fan around its first corner; any other is cut ear by ear in the plane of its
/// mean (Newell) normal, so that the triangles cover it once. False, with nothing appended, when it crosses
/// itself there. A polygon whose corners lie in line becomes a fan of triangles without area.
bool append_polygon(std::span<const uint32_t> corners, const std::vector<std::array<float, 3>>& positions,
                    std::vector<std::array<uint32_t, 3>>& triangles);

}  // namespace swarf::mesh
