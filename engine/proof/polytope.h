// Convex polytopes of a few corners, cut by planes. Internal to this folder.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/frames.h"

namespace swarf::proof {

/// A convex body with plane faces. Every corner lies on some face; a body without corners is empty.
struct Polytope {
  std::vector<Vec3> corners;                 ///< W, mm
  std::vector<std::vector<uint16_t>> faces;  ///< corners in order around each face

  bool is_empty() const { return corners.size() < 4; }
  Vec3 centre() const;  ///< mean of the corners
  /// From a point to the farthest corner, mm.
  double radius(const Vec3& from) const;
  Box box() const;
};

/// The body between two polygons of equally many corners, whose sides join corner k with corner k.
Polytope frustum_between(std::span<const Vec3> lower, std::span<const Vec3> upper);
Polytope box_polytope(const Box& box);

/// The parts with normal . x <= offset and >= offset.
std::pair<Polytope, Polytope> cut_by_plane(const Polytope& body, const Vec3& normal, double offset);

}  // namespace swarf::proof
