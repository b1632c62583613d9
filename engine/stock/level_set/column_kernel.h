// Columns of leaf positions under a run of sweeps: which part of each the run may reach, sixteen at once.
//
// In single precision. Whoever fills a ColumnQuery widens it by more than the rounding, so that a column is
// never cut too short; compiled like leaf_kernel.cpp.
#pragma once

#include <cstdint>
#include <span>

#include "stock/level_set/lane_kernel.h"

namespace swarf::stock {

/// The places that a run may reach, relative to its origin, mm. Seen from above they lie in a rectangle; in
/// space within `radius` of a segment, and above one of the bottom planes.
struct ColumnQuery {
  float centre[2], along[2], half_along, half_across;
  float foot[3], lean[2], rise, length, radius;  ///< foot + s (lean, rise), s in [0, length]
  float per_lean;  ///< 1 / |lean|; 0: so upright that a line is met anywhere within `radius` of the foot
  int planes;      ///< 0: none of them helps
  struct Plane {
    float z, x, y;  ///< z + x X + y Y at the vertical line (X, Y)
  } plane[2 * kLanes];
};

/// Sixteen columns of leaf positions, one after the other along y.
struct ColumnRow {
  float x, y, step;        ///< relative to the run's origin, mm; `y` of the first, `step` to the next
  float bottom, per_leaf;  ///< the lowest position's centre, mm, and positions per mm
  const uint32_t* tops;    ///< of each: positions below its highest material, and that one (LeafMap)
};

/// Of each column the positions whose centres the run may reach.
struct ColumnSpans {
  int first[kLanes], last[kLanes];  ///< inclusive, within the column
  uint32_t some;                    ///< bit n: column n has any
};

using ColumnKernel = void (*)(const ColumnQuery& query, const ColumnRow& row, ColumnSpans& out);

struct ColumnKernelVariant {
  const char* instruction_set;
  ColumnKernel kernel;
};
/// The variants this processor can run, fastest first.
std::span<const ColumnKernelVariant> column_kernel_variants();

}  // namespace swarf::stock
