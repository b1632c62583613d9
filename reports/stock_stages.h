// The stock at a few times of the program, for viewers that cannot cut.
#pragma once

#include <cstdint>
#include <vector>

#include "reports/machine_view.h"

namespace swarf::reports {

struct StockStage {
  uint64_t cycle = 0;     ///< from here on it stands so
  TriMesh mesh;           ///< work frame, mm, with normals
  double error_mm = 0.0;  ///< of its decimation, beside the voxels of kStageVoxels
};

/// Before the first cut, then after equal shares of the program's way at feed, in the middle of blocks too;
/// the finished part is not among them. They are cut in voxels of at least a kStageVoxels-th of the stock's
/// longest side: for the eye alone. Empty where nothing cuts, or a window of the motion is shown.
std::vector<StockStage> stock_stages(const FinishedRun& run, size_t count);

inline constexpr double kStageVoxels = 120.0;

}  // namespace swarf::reports
