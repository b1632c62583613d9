// How far along its normal a place of the design answers for material, over a whole cell: up to where another
// place of the design is nearer. Internal to this folder.
#pragma once

#include <optional>

#include "measure/height_bounds.h"
#include "mesh/tri_mesh.h"
#include "stock/stock.h"

namespace swarf::measure {

/// Where a line leaves the box, in mm from `point`; -infinity when the point lies outside.
double leaves_box(const Box& box, const Vec3& point, const Vec3& direction);

/// A little farther along a column than it is its own: past the float coordinates of meshes.
Vec3 beyond(const Vec3& point, const Vec3& way, double own_mm);

/// No turn and no bend between the corners.
inline bool is_flat(const DesignCell& cell) {
  return cell.flatness_mm == 0.0 && cell.turn == 0.0;
}

/// How high over a curved cell its columns are their own at most, for a point q of the design: no higher than
/// the radius of the ball that touches the place p and passes through q, |q - p|^2 / (2 n.(q - p)). Nothing
/// where q may be seen too flatly to be of a wall.
std::optional<CornerHeights> own_to_point(const DesignCell& cell, const Vec3& q);

/// How far along a flat cell's columns (`side` 1: up, -1: down) they are their own at most, for a facet of
/// the design that lies `ranges` away: with a place q_k of the facet for each corner, q(l) = sum l_k q_k lies
/// on it too, and |w|^2 / h is convex in (w, h), so over the cell the ball's radius is no more than the mean
/// of the corners'.
std::optional<CornerHeights> own_to_facet(const DesignCell& cell, const TriMesh& mesh, uint32_t facet,
                                          const CornerHeights& ranges, double side);

/// The height above which the grid knows nothing but air in the cell's columns, looked for from `top_mm`
/// down; `stock_bound_mm`: how far the sweeps that cut it stray from the motion.
double air_above(const DesignCell& cell, const stock::Stock& stock, double stock_bound_mm, double top_mm);

}  // namespace swarf::measure
