// What stands over the columns of a cell when all sweeps have passed: an upper bound by the sets that hold no
// material. Internal to the proof of a root cell (root_proof.h).
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "measure/certificate.h"
#include "measure/design_cell.h"
#include "measure/height_bounds.h"
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
  uint32_t near = stock::kUncut;  ///< index into the root's sweeps
};

/// A cell of the branch and bound, with the sweeps that may matter to it.
struct Cell {
  DesignCell shape;
  std::array<Corner, 3> corners;
  CellEdges edges;
  size_t begin, end;        ///< of kept_: the sweeps that may matter
  double dropped = kNever;  ///< least height of those that do not
  double air = kNever;      ///< above it the stock is air, as the grid tells for this cell or one around it
  /// Heights from which on there is no raw stock over the cell, where that is no box (raw_cell.h).
  std::optional<CornerHeights> raw_outside = {};
};

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

class RestBound {
 public:
  /// All must outlive it; `near` may change between two calls.
  RestBound(const CertificateInput& input, const RootCell& root, const std::vector<NearSweep>& near)
      : input_(input), root_(root), near_(near) {}

  /// Heights below which the cell's material is its own, by what ends it at each corner.
  std::vector<CornerHeights> own_above(const Cell& cell) const;

  /// Greatest height left over the cell, no closer than `enough`. `tops`: up to where the columns must be
  /// covered; `kept`, `floors`: the root's sweeps that may matter, and each one's least height over the cell.
  double left(const Cell& cell, const std::vector<CornerHeights>& own, const CornerHeights& tops,
              double enough, std::span<const uint32_t> kept, std::span<const double> floors);

 private:
  HighestLeft left_by_sets() const;
  bool add_owner(const Cell& cell, uint32_t n, const CornerHeights& tops);
  uint32_t owner_at(const Cell& cell, const HighestLeft& left, std::span<const uint32_t> kept,
                    std::span<const double> floors) const;

  const CertificateInput& input_;
  const RootCell& root_;
  const std::vector<NearSweep>& near_;
  std::vector<CornerHeights> sets_;
  std::vector<CornerHeights> covered_;  ///< of sets_, by sweeps over a curved cell
  CornerHeights sags_{};                ///< of all of covered_
  std::vector<uint32_t> owners_;        ///< of sets_, index into near_
};

/// Up to where the columns must be covered: a linear function above the lesser of both.
CornerHeights tops_of(const std::vector<CornerHeights>& own, double top);

}  // namespace swarf::measure
