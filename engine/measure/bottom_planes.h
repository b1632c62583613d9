// The planes of flat ends of many sweeps against one cell, or one column, of the design at once. Internal to
// this folder.
//
// Most of what the proof asks of a sweep, its cutter's lowest plane answers: over a cell a bound of the
// height below which it cuts nothing, over a column one of the height below which it is not met. The bound
// over a cell is that of height_bounds.h, operation by operation and so bit by bit; that over a column only
// says which sweeps need not be looked at.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "measure/height_bounds.h"
#include "measure/sweep_cutters.h"
#include "stock/sweep/sweep.h"

namespace swarf::measure {

/// Lowest planes of sweeps, by component: a stack.
class BottomPlanes {
 public:
  static constexpr size_t kRows = 14;
  /// Tool axis and tip at the start, at the end; then the plane's z and that of the upper end, mm: where the
  /// cutter is no plain flat one, below everything.
  using Rows = std::array<const double*, kRows>;
  /// So many numbers behind the last plane may be read: the kernels take several planes at a time.
  static constexpr size_t kMostLanes = 8;

  void clear() { resize(0); }
  /// Those of the sweeps with these numbers.
  void add(std::span<const uint32_t> numbers, std::span<const stock::Sweep> sweeps,
           const SweepCutters& cutters);
  /// Puts those with these places on top, in that order.
  void repeat(std::span<const uint32_t> places);
  void resize(size_t count) {
    count_ = count;
    for (std::vector<double>& row : rows_)
      if (row.size() < count + kMostLanes) row.resize(2 * count + kMostLanes);
  }
  Rows from(size_t begin) const {
    Rows rows;
    for (size_t r = 0; r < kRows; ++r) rows[r] = rows_[r].data() + begin;
    return rows;
  }

 private:
  std::array<std::vector<double>, kRows> rows_;  ///< with a few numbers more than there are planes
  size_t count_ = 0;
};

/// A cell as plain numbers, which the compiler keeps in registers.
struct PlainCell {
  double centre[3];                        ///< of its corners, W, mm
  double from_centre[3][3], normal[3][3];  ///< of its corners
  double bend[3][3];                       ///< of its sides, mm
  double flatness, stray, turn;            ///< mm, mm, -
  double seen[3];                          ///< mm
  bool is_flat;
};
/// For depths without `own`.
PlainCell plain_cell(const DesignCell& cell, const ColumnDepths& depths);

/// Less than any height; finite, so that it can be taken times numbers.
inline constexpr double kUntold = -1e300;

/// least_height() of each sweep where that is above `enough` by its planes alone; else no more than `enough`,
/// or kUntold.
using CellHeights = void (*)(const BottomPlanes::Rows& rows, size_t count, const PlainCell& cell,
                             double* heights);

/// Of a place, height over it below which the sweep does not meet the column, but for kPlaneSlack; kUntold
/// where the column lies too flat against its plane.
using ColumnHeights = void (*)(const BottomPlanes::Rows& rows, size_t count, const double (&point)[3],
                               const double (&normal)[3], double* heights);

/// Of the quotient that a column's height is, where the column is not too flat; mm.
inline constexpr double kPlaneSlack = 1e-8;

struct BottomPlaneVariant {
  const char* instruction_set;
  CellHeights over_cell;
  ColumnHeights over_column;
};
/// The variants this processor can run, fastest first; all give the same bits.
std::span<const BottomPlaneVariant> bottom_plane_variants();

/// Height over the place below which each sweep does not meet the column, as ColumnHeights.
void column_heights(const CellCorner& at, const BottomPlanes::Rows& rows, size_t count,
                    std::vector<double>& heights);

/// least_height() of each sweep as CellHeights; kUntold for all where the cell asks for more than planes.
void cell_heights(const DesignCell& cell, const ColumnDepths& depths, const BottomPlanes::Rows& rows,
                  size_t count, std::vector<double>& heights);

}  // namespace swarf::measure
