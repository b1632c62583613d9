// Volumes between two closed meshes, by columns through both.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "base/frames.h"
#include "mesh/tri_mesh.h"

namespace swarf::measure {

/// Columns along `frame`'s third row through the middles of n x n pixels of its first two.
struct ColumnGrid {
  Mat3 frame = Mat3::Identity();
  double low_u = 0.0, low_v = 0.0;  ///< mm, in the frame
  double step_u = 1.0, step_v = 1.0;
  int n = 256;
};

/// A frame whose third row lies near `direction` but along no plane or edge that a drawing has.
Mat3 column_frame(const Vec3& direction);

/// Where a run begins or ends.
struct ColumnEnd {
  bool design = false;  ///< on the design's mesh, else on the stock's
  uint32_t triangle = 0;
  Vec3 point = Vec3::Zero();
};

/// Material of one of the two only, along one column.
struct ColumnRun {
  bool gouge = false;  ///< of the design only, else of the stock only
  double length_mm = 0.0;
  std::array<ColumnEnd, 2> ends;
};

/// Visits every run of every column, column by column. The column meets exactly one of two facets at their
/// common edge, so every column enters a closed mesh as often as it leaves it.
void each_run(const TriMesh& stock, const TriMesh& design, const ColumnGrid& grid,
              const std::function<void(const ColumnRun&)>& visit);

struct MaterialVolumes {
  double excess_mm3 = 0.0, gouge_mm3 = 0.0;
};
/// Of both whole: the mean over three directions at right angles.
MaterialVolumes volumes_between(const TriMesh& stock, const TriMesh& design);

}  // namespace swarf::measure
