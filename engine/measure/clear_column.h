// How far a flat piece lies from another surface: over all of it, not at samples.
#pragma once

#include <limits>
#include <span>

#include "measure/flat_piece.h"

namespace swarf::measure {

/// Signed distance over a whole piece lies within these, mm.
struct DistanceRange {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
};

/// A mesh with, for each facet, how far what it stands for may stray from it.
struct TargetMesh {
  const mesh::SignedDistance* mesh = nullptr;
  std::span<const double> errors;  ///< per facet, mm; empty: the facets are exact
  double most_error = 0.0;         ///< the greatest of them but for those of rounded edges
  /// Per facet the greatest of its own error and those above kQuiet of facets that are nearer than kReach
  /// times their error; empty: the errors themselves.
  std::span<const double> near_errors;
  static constexpr double kQuiet = 5e-4;  ///< mm
  static constexpr double kReach = 5.0;

  double error(uint32_t facet) const { return errors.empty() ? 0.0 : errors[facet]; }
  double near_error(uint32_t facet) const { return near_errors.empty() ? error(facet) : near_errors[facet]; }
  Corners corners(uint32_t facet) const {
    return {mesh->corner(facet, 0), mesh->corner(facet, 1), mesh->corner(facet, 2)};
  }
  double distance(uint32_t facet, const Vec3& p) const {
    const Corners c = corners(facet);
    return (mesh::closest_point_on_triangle(p, c[0], c[1], c[2]) - p).norm();
  }
  /// No place of the piece is farther than this from what the facet stands for: distance to a convex set is
  /// convex, so over the piece it is greatest at a corner.
  double distance_over(uint32_t facet, const FlatPiece& piece) const;
};

/// Bounds of the signed distance from `target` over all of `piece`, from the column above and below it.
///
///   Let C be the column {p + h n : p in the piece, |h| <= height}, n its normal. The facets of the target
///   that run through C leave slabs z1 < h < z2 of it clear. A clear slab is wholly outside the target, or
///   wholly inside: one point tells. Every p of the piece lies within depth = max(0, z1, -z2) of it. So if
///   it is outside, distance >= -depth, and if inside, distance <= depth. Where two surfaces face each other
///   there is one of each kind, and the bounds are as good as the facets' heights, however large the
///   piece. A piece that no facet crosses is on one side of the target.
///
/// The piece is made smaller by kRim all round, so that walls which end at its sides stay outside, and the
/// bounds wider by as much as that can matter, and by the greatest near_error() of the facets around it. A
/// facet that can pass a place q of the column lies within its own error of q. So it is one of those around
/// the column, or within kReach times its error of them, unless q is far away: there most_error counts. Of an
/// `open` target, whose sign a border changes, one sheet must cover the whole piece: the projected areas of
/// its facets in C must sum to the piece's.
/// Nothing is bounded (infinite) where that fails, or more than a hundred facets come near.
DistanceRange clear_column(const FlatPiece& piece, const TargetMesh& target, double height_mm, bool open);

/// The least distance between a piece and the facets of a mesh that it does not cross, mm; at most
/// `within_mm`.
double least_distance(const FlatPiece& piece, const mesh::SignedDistance& target, double within_mm);

}  // namespace swarf::measure
