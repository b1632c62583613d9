// What sweeps leave standing over a cell of the design: proven bounds from both sides (theory 8). Internal to
// this folder.
//
// From below. F, the implicit function of a convex piece, is convex: a tangent at the instant that brings the
// cell nearest lies below F everywhere, and so does the plane of a face. Along a column the tangent is linear
// in s, so the height below which the sweep cannot have cut is the root of a linear function at each corner.
//
// From above. The set that a convex piece covers while it moves without turning is convex; so is the piece
// while it stands; so is the outside of each face of the stock's box. If such a set holds the columns of the
// three corners from h_k up to a common height, it holds the hull of them, and over the cell the material
// ends at or below sum_k l_k h_k. Of several sets the lowest counts at each place, so the cell's bound is
//   max over l of min over the sets of sum_k l_k h_k,
// a linear program in two variables: across a ridge it gives the ridge's height, whatever the cell's size.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "measure/design_cell.h"
#include "stock/sweep/sweep.h"
#include "stock/sweep/sweep_map.h"

namespace swarf::measure {

inline constexpr double kNever = std::numeric_limits<double>::infinity();

/// A sweep that comes near a cell.
struct NearSweep {
  stock::SweepMap map;
  const stock::CutterSolid* cutter = nullptr;
  uint32_t sweep = 0;
  bool turns = false;
};

/// A cut or a rest thinner than this across the columns is not told from a touch: a flank that runs along a
/// face of the design, a bottom that runs along its edge; mm.
inline constexpr double kTouch = 1e-6;

/// Of a bound's own arithmetic: doubles of coordinates of some metres, a few operations each; mm.
inline constexpr double kRoundingOfHeights = 1e-10;

/// Heights, or depths, at the corners of a cell that stand for a linear function over it; mm.
using CornerHeights = std::array<double, 3>;

/// How deep under the design a cut of the cell's columns counts.
struct ColumnDepths {
  /// Down to this linear function a cut is looked for, one that begins deeper is none of the cell's: nowhere
  /// below what is the cell's own, or kSkin; the same at all corners where the columns fan out. mm, >= 0.
  CornerHeights seen{};
  /// Of a flat cell: bounds of what is its own (own_below) over all of it. May be empty.
  std::vector<CornerHeights> own;
};

/// Height in mm below which the sweep cuts nothing of the cell's columns, each down to its own depth under
/// the design; -infinity when that cannot be told. A bound above `enough` is not made any closer.
double least_height(const DesignCell& cell, const NearSweep& near, const ColumnDepths& depths, double enough);

/// Where over the cell the sweep cuts deepest, as a place (barycentric) to be measured: the piece's lowest
/// point at the instant that brings the cell's middle nearest. Only a good guess; nothing when it lies beside
/// the cell.
std::optional<Vec3> deepest_place(const DesignCell& cell, const NearSweep& near);

/// True when the sweep certainly cuts the column of the place at `height_mm` or above only, or not at all.
bool stays_above(const CellCorner& corner, const NearSweep& near, double height_mm);

/// What one piece of the sweep is known to cover: heights from which on the columns of the corners are free;
/// kNever: it does not. `from`: heights from which to look, below the answer;
/// `tops`: the columns are covered from the answer up to here; with kNoTop at the answer, no matter what
/// stands above.
inline constexpr CornerHeights kNoTop{-kNever, -kNever, -kNever};
/// Over the cell: sum_k l_k heights_k - 2 sum over pairs l_j l_k sags_jk, the sags of the sides from corner
/// k.
struct Covered {
  CornerHeights heights{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                        std::numeric_limits<double>::infinity()};
  CornerHeights sags{};
};
Covered covered_from(const DesignCell& cell, const NearSweep& near, const cutter::ConvexPiece& piece,
                     const CornerHeights& from, const CornerHeights& tops);

/// The outside of one face of the box: normal . x >= offset.
CornerHeights outside_from(const DesignCell& cell, const Vec3& normal, double offset);

struct HighestLeft {
  double height = kNever;                  ///< mm
  Vec3 place = Vec3::Constant(1.0 / 3.0);  ///< barycentric: where
};

/// max over l of min over the sets, which all sag by that much between the corners (as Covered tells); kNever
/// without a set that covers every corner.
HighestLeft highest_left(const std::vector<CornerHeights>& sets, CornerHeights sags = {});

}  // namespace swarf::measure
