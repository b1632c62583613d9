// How far a triangle lies from another surface: over all of it, not at samples.
#pragma once

#include <limits>

#include "measure/surface_cells.h"

namespace swarf::measure {

/// Signed distance over a whole triangle lies within these, mm.
struct DistanceRange {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
};

/// Bounds of the signed distance from `target` over all of `triangle`, from the column above and below it.
///
///   Let C be the column {p + h n : p in the triangle, |h| <= height}, n its normal. The facets of the target
///   that run through C leave slabs z1 < h < z2 of it clear. A clear slab is wholly outside the target, or
///   wholly inside: one point tells. Every p of the triangle lies within depth = max(0, z1, -z2) of it. So if
///   it is outside, distance >= -depth, and if inside, distance <= depth. Where two surfaces face each other
///   there is one of each kind, and the bounds are as good as the facets' heights, however large the
///   triangle.
///
/// The triangle is made smaller by kRim all round, so that walls which end at its sides stay outside, and the
/// bounds wider by as much as that can matter. Of an `open` target, whose sign a border changes, one sheet
/// must cover the whole triangle: the projected areas of its facets in C must sum to the triangle's.
/// Nothing is bounded (infinite) where that fails, or more than a hundred facets come near.
DistanceRange clear_column(const Corners& triangle, const mesh::SignedDistance& target, double height_mm,
                           bool open);

/// The least distance between a triangle and the facets of a mesh that it does not cross, mm; at most
/// `within_mm`.
double least_distance(const Corners& triangle, const mesh::SignedDistance& target, double within_mm);

}  // namespace swarf::measure
