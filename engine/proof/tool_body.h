// The cutter's convex pieces as hulls of circles, and smaller ones within a stated distance of them. Internal
// to this folder.
//
// Depth of a gouge. Let K' be a set such that every point of the cutter K is within g of K'. If the sweep of
// K' stays clear of the design D, no point of K lies deeper in D than g: about a point p deeper than g the
// ball of radius g lies in D, and some point of K' lies in that ball. So a sweep gouges by at most g if one
// such K' is clear of D. Two kinds serve:
//   shrunk    every point of K goes towards the axis by b and towards the middle of its height by at most a,
//             a^2 + b^2 <= g^2
//   erosion   for a K without sharp edges below: the points with a ball of radius g in K
//   pointed   for a K with a sharp tip: its faces moved inwards, which leaves the tip too far off; and a
//             piece of the axis, from g over the tip up to the point of what is left
#pragma once

#include <vector>

#include "collision/convex_shape.h"
#include "cutter/convex_piece.h"

namespace swarf::proof {

/// Rounds become polygons around them that stand out by no more than this share of the erosion.
inline constexpr double kOutwardShare = 0.02;

/// The piece in the tool's frame, its rounds as polygons that stand out by at most `outward_mm`.
collision::RevolvedSolid piece_body(const cutter::ConvexPiece& piece, double outward_mm);

/// Convex bodies that together make one K' of a piece: all of them must be clear.
using ReducedBody = std::vector<collision::RevolvedSolid>;

/// Smaller bodies of the piece as above, for a depth of g mm; the first serves best.
std::vector<ReducedBody> reduced_bodies(const cutter::ConvexPiece& piece, double g_mm);

}  // namespace swarf::proof
