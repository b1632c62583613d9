// What one piece of the cutter takes out of one ray, as far as it matters there. Internal to this folder.
#pragma once

#include "stock/rays/ray_height.h"
#include "stock/rays/tile_bounds.h"
#include "stock/sweep/sweep_map.h"

namespace swarf::stock {

/// A ray and the sweep that may cut it.
struct RayPassage {
  const Vec3 &point, &normal;
  const SweepMap& map;

  Vec3 at(double s) const { return point + s * normal; }
};

/// The interval that the piece's sweep covers, for a ray without material above `limit`: a miss when it
/// begins above that, and `high` is +infinity when it ends above.
RayInterval cut_of_piece(const RayPassage& ray, const cutter::ConvexPiece& piece, double limit);

/// The same when the interval's lower end is known.
RayInterval cut_from(double low, const RayPassage& ray, const cutter::ConvexPiece& piece, double limit);

/// The ray's points in the extent lie beyond the cutter's top or beside its flank all the time.
bool beyond_cutter(const RayPassage& ray, const CutterSolid& cutter, const Extent& extent);

}  // namespace swarf::stock
