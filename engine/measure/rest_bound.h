// What stands over the columns of a cell when all sweeps have passed: an upper bound by the sets that hold no
// material. Internal to the proof of a root cell (root_proof.h).
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "measure/bottom_planes.h"
#include "measure/certificate.h"
#include "measure/design_cell.h"
#include "measure/height_bounds.h"
#include "measure/root_sweeps.h"
#include "measure/sweep_index.h"
#include "stock/rays/surface_dexels.h"

namespace swarf::measure {

struct Corner {
  CellCorner at;
  double range = 0.0;             ///< where another face is as near, mm
  std::optional<Vec3> wall;       ///< a place of that face
  std::optional<uint32_t> facet;  ///< of a mesh, that lies there
  double top = 0.0;               ///< there, or where the column leaves the stock's box, mm
  double height = 0.0;            ///< that the sweeps leave standing, mm
  bool at_rim = false;            ///< on a side of the root cell
  std::optional<double> above{};  ///< top of the highest that they leave, above a gap too, where looked for
  uint32_t near = stock::kUncut;  ///< index into the root's sweeps

  double highest() const { return std::max(height, above.value_or(height)); }
};

/// A cell of the branch and bound, with the sweeps that may matter to it.
struct Cell {
  DesignCell shape;
  std::array<Corner, 3> corners;
  CellEdges edges;
  size_t begin, end;        ///< of kept_: the sweeps that may matter
  double dropped = kNever;  ///< least height of those that do not
  double air = kNever;    ///< above it the stock is air, as grid or sweeps tell of this cell or one around it
  bool near_rim = false;  ///< the cell that it is a part of has a corner on a side of the root cell
  std::array<bool, 3> outer{};  ///< side k, from corner k to the next, is a part of the root cell's
  /// Heights from which on there is no raw stock over the cell, where that is no box (raw_cell.h).
  std::optional<CornerHeights> raw_outside = {};
};

/// Cells that are about to close by division need no look.
bool resists_division(const Cell& cell, double voxel_mm);

/// mm; 0 inside.
double distance_to(const Box& box, const Vec3& p);

/// Whether a bound of what stands is asked for at all.
bool asks_above(const CertificateInput& input);

/// How high above a place material is its own: a mesh tells by its distance, patches by their rays. Where
/// nothing is asked of what stands there, only the height that is left is brought down to it (keep_own).
void take_range(const CertificateInput& input, Corner& corner);

/// What stands at a place, its range known, before any cut.
void take_raw(const stock::RawShape& raw, Corner& corner);

/// Height over the design up to which there was material to begin with over the whole cell; below 0 where
/// the design reaches out of the stock.
double stood_before(const Cell& cell, const stock::RawShape& raw);

/// Height above which no raw stock is the cell's own, from `top` down; notes how far down the columns are
/// free of it.
double look_at_raw(const stock::RawShape& raw, const std::vector<CornerHeights>& own, double top, Cell& cell);

/// How deep below a place a cut can count: to where another face is nearer, or out of the stock.
double counted_depth(const CertificateInput& input, const CellCorner& corner, double depth,
                     double share = 1e-9);

/// Of a cut, or of what stands, what is nearer to another face is that one's.
void keep_own(const CertificateInput& input, Corner& corner);

/// Lowest end of what the sweep cuts of the column, not above `highest`; infinite where it cuts none. `fans`:
/// columns fan out there from an edge or a corner. What is cut of another face of `field` alone is left out.
double lowest_cut(const CellCorner& at, const NearSweep& near, double highest, bool fans,
                  const stock::RayField& field);

/// Top of the highest own material over the place when all of `sweeps` have passed, mm; 0 where none is left.
/// Measured, not bounded: what a sweep leaves within its interval where its axis turns is passed over.
double rest_top(const CellCorner& at, double range, const stock::RawShape& raw,
                std::span<const NearSweep> sweeps);

/// Half way along the path between two sweeps: between their places it is the likeliest to be the lowest.
uint32_t between(const std::array<uint32_t, 2>& sweeps);

/// Heights over which columns that leave the box through its planes stand in no stock.
void add_box(const Box& box, const DesignCell& cell, std::vector<CornerHeights>& sets);

/// On each side, from corner k to the next: the last place that the corner's sweep covers up to where the
/// column ends; nothing where it does so over all of the side, or over next to nothing of it.
using Seams = std::array<std::optional<CellCorner>, 3>;

/// The root's sweeps that may matter to a cell, each one's least height over it and its planes.
struct KeptSweeps {
  std::span<const uint32_t> numbers;
  std::span<const double> floors;
  BottomPlanes::Rows planes;
};

class RestBound {
 public:
  /// All must outlive it; `near` may change between two calls.
  RestBound(const CertificateInput& input, const RootCell& root, const RootSweeps& near)
      : input_(input), root_(root), near_(near) {}

  /// Heights below which the cell's material is its own, by what ends it at each corner.
  std::vector<CornerHeights> own_above(const Cell& cell) const;

  /// Greatest height left over the cell, no closer than `enough`. `tops`: up to where the columns must be
  /// covered.
  double left(const Cell& cell, const std::vector<CornerHeights>& own, const CornerHeights& tops,
              double enough, const KeptSweeps& kept);

  /// Where sweeps clear the columns of a cell side by side no one of them covers a part across their seam,
  /// however small. Nothing where the columns of the cell are others when it is divided there.
  Seams seams_of(const Cell& cell) const;

  /// Whether the sweeps that cut the corners lowest end below `tops`: then left() knows none that covers the
  /// columns, whatever the size of the cell.
  bool ends_below(const Cell& cell, const CornerHeights& tops) const;

  /// `tops` of the cell that left() was asked of last, lowered to where the columns are free from: layer by
  /// layer, each of `sweeps` from the last one down, as flutes shorter than a pocket is deep leave it. No
  /// closer than `enough`; nothing where the uppermost layer holds material.
  std::optional<CornerHeights> lowered(const Cell& cell, const CornerHeights& tops, double enough,
                                       std::span<const NearSweep> sweeps) const;

 private:
  std::optional<CellCorner> seam_of(const Cell& cell, size_t side) const;
  HighestLeft left_by_sets() const;
  HighestLeft left_with_others(const Cell& cell, HighestLeft left, const CornerHeights& tops, double enough,
                               const KeptSweeps& kept);
  bool add_owner(const Cell& cell, uint32_t n, const CornerHeights& tops);
  uint32_t owner_at(const Cell& cell, const HighestLeft& left, const KeptSweeps& kept);

  const CertificateInput& input_;
  const RootCell& root_;
  const RootSweeps& near_;
  std::vector<CornerHeights> sets_;
  std::vector<CornerHeights> covered_;  ///< of sets_, by sweeps over a curved cell
  CornerHeights sags_{};                ///< of all of covered_
  std::vector<uint32_t> owners_;        ///< of sets_, index into near_
  std::vector<double> planes_;          ///< heights of owner_at()
};

/// Up to where the columns must be covered: a linear function above the lesser of both.
CornerHeights tops_of(const std::vector<CornerHeights>& own, double top);

}  // namespace swarf::measure
