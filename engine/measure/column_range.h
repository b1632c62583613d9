// How far along its normal a place of the design answers for material, over a whole cell: up to where another
// place of the design is nearer. Internal to this folder.
#pragma once

#include <optional>
#include <vector>

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

/// From where on along a column a place of the design is nearer than the share L of the way, the place being
/// `away` from the column's foot and `along` along it: s^2 - 2 s along + away^2 = L^2 s^2, so
///   s = away^2 / (along + sqrt(along^2 - (1 - L^2) away^2)),
/// for L = 1 the radius of the ball that touches the foot and passes through the place. Convex in the two and
/// rising with `away`: along * g(away / along), g(t) = (1 - sqrt(1 - c t^2)) / c, c = 1 - L^2. Infinite where
/// the place never is; mm.
double own_way(double away, double along, double share);

/// How high over a curved cell its columns are their own at most, for a point of the design (own_way).
/// Nothing where it may be seen too flatly to be of a wall. `share`: of RayField::own_depth, 1 above the
/// design.
std::optional<CornerHeights> own_to_point(const DesignCell& cell, const Vec3& q, double share = 1.0);

/// How far along a flat cell's columns (`side` 1: up, -1: down) they are their own at most, for a facet of
/// the design that lies `ranges` away and strays from the design by no more than `stray_mm`: with a place q_k
/// of the facet for each corner, q(l) = sum l_k q_k lies on it too, and own_way() is convex, so over the cell
/// it is no more than the mean of the corners'. Any q_k will do; they are brought to where the ball touches.
std::optional<CornerHeights> own_to_facet(const DesignCell& cell, const TriMesh& mesh, uint32_t facet,
                                          const CornerHeights& ranges, double side, double share = 1.0,
                                          double stray_mm = 0.0);

/// How deep under the design the cell's columns are their own at most, each a linear function over the cell
/// that is nowhere below RayField::own_depth. The depths of the corners are no such bound: under a thin wall
/// whose top has all its corners on edges they are 0, and half the wall's thickness in between. So facets and
/// places beside the corners' columns bound it. None for parametric designs, which bound no body. `through`:
/// where the corners' columns leave the stock.
std::vector<CornerHeights> own_below(const DesignCell& cell, const stock::RayField& field,
                                     const CornerHeights& through);

/// The height above which the grid knows nothing but air in the cell's columns, looked for from `top_mm`
/// down; `stock_bound_mm`: how far the sweeps that cut it stray from the motion.
double air_above(const DesignCell& cell, const stock::Stock& stock, double stock_bound_mm, double top_mm);

}  // namespace swarf::measure
