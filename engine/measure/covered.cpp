// covered_from() and outside_from(): sets that hold the columns of a cell (height_bounds.h).
#include <algorithm>
#include <cmath>

#include "measure/column_lanes.h"
#include "measure/height_bounds.h"
#include "stock/sweep/convex_motion.h"

namespace swarf::measure {
namespace {

const ColumnLanesVariant& fastest() {
  static const ColumnLanesVariant variant = column_lanes_variants().front();
  return variant;
}

/// The greatest |n_k - mean of the corners' normals|.
double lean_of(const DesignCell& cell) {
  const Vec3 mean = (cell.corners[0].normal + cell.corners[1].normal + cell.corners[2].normal) / 3.0;
  double lean = 0.0;
  for (const CellCorner& corner : cell.corners) lean = std::max(lean, (corner.normal - mean).norm());
  return lean;
}

double spread_of(const CornerHeights& heights) {
  return *std::max_element(heights.begin(), heights.end()) -
         *std::min_element(heights.begin(), heights.end());
}

ColumnNumbers numbers_of(const CornerHeights& of) {
  return {{of[0], of[1], of[2], of[0]}};
}

/// How far the heights of the control columns lie apart at most, and those of the sides off the mean of their
/// corners'.
struct Cover : Covered {
  double spread = 0.0, sides = 0.0;
  bool is_whole() const { return heights[0] < kNever; }
};

using CornerInstants = std::array<double, 3>;

/// What a piece of a sweep covers of a cell: its columns in the tool's frame, and those of the sides of a
/// curved cell.
class PieceCover {
 public:
  PieceCover(const DesignCell& cell, const NearSweep& near, const cutter::ConvexPiece& piece,
             const CornerHeights& tops)
      : cell_(cell), near_(near), piece_(piece), tops_(tops) {
    fastest().columns_of(near.map, cell.corners, corners_);
    if (!cell.is_curved()) return;
    fastest().columns_of(near.map, {cell.side(0), cell.side(1), cell.side(2)}, sides_);
    const Vec3 normal = cell.mean_normal();
    for (size_t k = 0; k < 3; ++k) bulges_[k] = std::max(0.0, -0.25 * cell.bends[k].dot(normal));
  }

  /// When the piece is nearest to each corner's column at a height.
  CornerInstants instants_at(const CornerHeights& heights) const {
    CornerInstants instants{};
    for (size_t k = 0; k < 3; ++k) {
      const Vec3 at = cell_.corners[k].point + heights[k] * cell_.corners[k].normal;
      const Vec3 P = near_.map.start(at);
      instants[k] = stock::nearest_instant(piece_, P, near_.map.end(at) - P).t;
    }
    return instants;
  }

  /// Looked for from `from` up, `aside` mm within the piece's surface.
  Cover covered(const CornerInstants& instants, const CornerHeights& from, double aside) const {
    Cover cover;
    const CornerHeights heights = looked_for(corners_, instants, from, tops_, aside);
    if (std::find(heights.begin(), heights.end(), kNever) != heights.end()) return {};
    cover.heights = heights;
    if (cell_.is_curved() && !cover_sides(instants, aside, cover)) return {};
    cover.spread = spread_of(heights) + cover.sides;
    return cover;
  }

 private:
  CornerHeights looked_for(const ColumnLanes& lanes, const CornerInstants& instants,
                           const CornerHeights& from, const CornerHeights& tops, double aside) const {
    ColumnNumbers heights;
    fastest().covered(piece_, lanes, numbers_of(instants), numbers_of(from), numbers_of(tops),
                      {aside, cell_.stray_mm, cell_.turn}, heights);
    return {heights[0], heights[1], heights[2]};
  }

  /// The control columns of the sides, each in the mean of its corners' instants: where one is covered later
  /// than the mean of its corners by c, the cell is by 2 l_j l_k c. Where the design bulges, earlier: by no
  /// more than it does.
  bool cover_sides(const CornerInstants& instants, double aside, Cover& cover) const {
    std::array<double, 3> means{}, from{}, tops{}, later{};
    CornerInstants halfway{};
    for (size_t k = 0; k < 3; ++k) {
      const size_t j = (k + 1) % 3;
      means[k] = 0.5 * (cover.heights[k] + cover.heights[j]);
      from[k] = means[k] - bulges_[k];
      tops[k] = 0.5 * (tops_[k] + tops_[j]);
      halfway[k] = 0.5 * (instants[k] + instants[j]);
    }
    const CornerHeights heights = looked_for(sides_, halfway, from, tops, aside);
    for (size_t k = 0; k < 3; ++k) {
      if (heights[k] == kNever) return false;
      later[k] = std::max(0.0, heights[k] - means[k]);
      cover.sags[k] = std::max(0.0, means[k] - heights[k]);
      cover.sides = std::max(cover.sides, std::abs(heights[k] - means[k]));
    }
    const double raised = 2.0 * most_over_pairs(later[0], later[1], later[2]);
    for (double& height : cover.heights) height += raised;
    return true;
  }

  const DesignCell& cell_;
  const NearSweep& near_;
  const cutter::ConvexPiece& piece_;
  const CornerHeights& tops_;
  ColumnLanes corners_, sides_;
  CornerHeights bulges_{};  ///< of the sides, mm
};

/// A cutter that turns while it moves covers no convex set. The place at l is looked at in the instant
/// t(l) = sum l_k t_k: there it stands aside of the mean of the corners, each in its own instant, by
///   sum l_j (t(l) - t_j) D_j = sum over pairs l_j l_k (t_k - t_j)(D_j - D_k),    D the corner's motion.
/// The control columns of the sides, were they the means of their corners', would stand half as far aside;
/// by what they bend and by what they are covered later (`sides`) another motion of theirs comes on top.
double twist_of(const DesignCell& cell, const NearSweep& near, const CornerInstants& instants,
                const CornerHeights& from, const CornerHeights& tops, double spread, double sides) {
  if (!near.turns) return 0.0;
  const Mat3 turn = near.map.R1t - near.map.R0t;
  double farthest = 0.0;
  for (size_t k = 0; k < 3; ++k) farthest = std::max({farthest, std::abs(from[k]), tops[k]});
  std::array<double, 3> strays{};
  for (size_t k = 0; k < 3; ++k) {
    const size_t j = (k + 1) % 3;
    const CellCorner &a = cell.corners[k], &b = cell.corners[j];
    const double apart = (turn * (a.point - b.point)).norm() + spread * turn.norm() +
                         farthest * (turn * (a.normal - b.normal)).norm();
    strays[k] = std::abs(instants[k] - instants[j]) * apart;
  }
  double bend = 0.0;
  for (const Vec3& side : cell.bends) bend = std::max(bend, 0.25 * side.norm());
  return most_over_pairs(strays[0], strays[1], strays[2]) +
         spread_of(instants) * turn.norm() * (bend + sides);
}

/// Columns that begin outside and do not lead back stay there, those along the face too. Without flatness the
/// columns between the corners' are means of these (place_in).
bool stays_outside(const DesignCell& cell, const Vec3& normal, double offset) {
  constexpr double kAlong = 1e-9;  // kTouch in a metre
  return cell.flatness_mm == 0.0 &&
         std::all_of(cell.corners.begin(), cell.corners.end(), [&](const CellCorner& corner) {
           return normal.dot(corner.point) >= offset - kTouch && normal.dot(corner.normal) >= -kAlong;
         });
}

}  // namespace

Covered covered_from(const DesignCell& cell, const NearSweep& near, const cutter::ConvexPiece& piece,
                     const CornerHeights& from, const CornerHeights& tops) {
  constexpr double kSafety = 1.5, kNothing = 1e-10, kSlack = 1e-7;  // mm
  const PieceCover columns(cell, near, piece, tops);
  CornerInstants instants = columns.instants_at(from);
  Cover cover = columns.covered(instants, from, 0.0);
  if (!cover.is_whole()) return {};
  if (near.turns) {
    // Higher up another instant is the nearest.
    instants = columns.instants_at(cover.heights);
    cover = columns.covered(instants, from, 0.0);
    if (!cover.is_whole()) return {};
  }
  // The place at l and s >= sum l_k h_k is reached from the corners' own heights s + h_k - sum l_j h_j, which
  // lie aside of it by |sum l_k (h_k - sum l_j h_j)(n_k - mean n)| <= spread lean: that much margin more.
  const double lean = lean_of(cell);
  const auto strays = [&](double spread, double sides) {
    return spread * lean + twist_of(cell, near, instants, from, tops, spread, sides);
  };
  const double aside = strays(kSafety * cover.spread, kSafety * cover.sides + kSlack);
  if (aside <= kNothing) return cover;
  const Cover within = columns.covered(instants, cover.heights, aside);
  if (!within.is_whole() || strays(within.spread, within.sides) > aside) return {};
  return within;
}

CornerHeights outside_from(const DesignCell& cell, const Vec3& normal, double offset) {
  if (stays_outside(cell, normal, offset)) return {0.0, 0.0, 0.0};
  CornerHeights heights{kNever, kNever, kNever};
  double least_rise = kNever;
  for (size_t k = 0; k < 3; ++k) {
    const CellCorner& corner = cell.corners[k];
    const double rise = normal.dot(corner.normal) - cell.turn;
    const double lacking = offset + cell.flatness_mm - kTouch - normal.dot(corner.point);
    if (!(rise > 0.0)) return {kNever, kNever, kNever};
    // Below the design the margin grows the other way: the bound is taken at the design then.
    heights[k] = std::max(0.0, lacking / rise);
    least_rise = std::min(least_rise, rise);
  }
  const double aside = spread_of(heights) * lean_of(cell);  // as in covered_from
  for (double& height : heights) height += aside / least_rise;
  return heights;
}

}  // namespace swarf::measure
