// Where a convex piece covers three columns of a cell, side by side (height_bounds.h). Internal to this
// folder.
#pragma once

#include <array>
#include <span>

#include "cutter/convex_piece.h"
#include "measure/design_cell.h"
#include "stock/sweep/sweep_map.h"

namespace swarf::measure {

/// Of each of three columns one number, and one that counts for nothing.
struct alignas(32) ColumnNumbers {
  double lane[4];

  double operator[](size_t k) const { return lane[k]; }
  double& operator[](size_t k) { return lane[k]; }
};

/// Three columns in the tool's frame at both ends of a motion, mm: feet and directions, by component.
struct ColumnLanes {
  std::array<ColumnNumbers, 3> foot_at_start, foot_at_end, way_at_start, way_at_end;
};

/// How far within the surface of the piece a column must lie: aside + stray + |s| turn; mm, mm, -.
struct ColumnMargin {
  double aside, stray, turn;
};

using ColumnsKernel = void (*)(const stock::SweepMap& map, const std::array<CellCorner, 3>& columns,
                               ColumnLanes& lanes);

/// Each column in an instant of its own: least height from `from` up at which the piece covers it, up to
/// `tops` where that is higher; infinite where it does not. By Newton's method on a convex function from the
/// left, which cannot overshoot.
using CoverKernel = void (*)(const cutter::ConvexPiece& piece, const ColumnLanes& lanes,
                             const ColumnNumbers& instants, const ColumnNumbers& from,
                             const ColumnNumbers& tops, const ColumnMargin& margin, ColumnNumbers& heights);

struct ColumnLanesVariant {
  const char* instruction_set;
  ColumnsKernel columns_of;
  CoverKernel covered;
};
/// The variants this processor can run, fastest first; all give the same bits.
std::span<const ColumnLanesVariant> column_lanes_variants();

}  // namespace swarf::measure
