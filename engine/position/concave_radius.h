// The narrowest hollow of surface patches, to be compared with a cutter before anything moves.
#pragma once

#include <limits>

#include "position/patch_cells.h"

namespace swarf::position {

/// A cutter that is rounder than the narrowest hollow rides over it: it gouges nothing and leaves material. A
/// ball of at most `at_least` touches everywhere within the patches, one of more than `radius` does not at
/// `place_W`. Radii of normal curvature on the side that the surface calls outside, mm.
struct ConcaveRadius {
  double radius = std::numeric_limits<double>::infinity();    ///< at the place; infinity: none was found
  double at_least = std::numeric_limits<double>::infinity();  ///< proven: nowhere is it less
  Vec3 place_W = Vec3::Zero();
  int patch = -1;
  Vec2 uv = Vec2::Zero();
};

/// The two radii come within this share of each other, unless the limit of cells is reached first (where a
/// surface has no normal, as at a pole, its curvature has no bound and at_least is 0).
inline constexpr double kConcaveShare = 0.1;
/// Hollows flatter than this radius count as flat, mm.
inline constexpr double kFlatRadius_mm = 1e5;

/// Inside the patches; a concave edge between two of them is narrower than any cutter and is not looked at.
ConcaveRadius smallest_concave_radius(const std::vector<Patch>& patches, size_t most_cells = 200'000);

}  // namespace swarf::position
