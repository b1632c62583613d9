#include "sim/run/starting_clamping.h"

#include <algorithm>

#include "sim/job/clamping_check.h"

namespace swarf::sim {

void check_starting_clamping(const Job& job, const CarriedCuts& carried, Diagnostics& diagnostics) {
  if (job.earlier.empty()) return;
  constexpr double kCells = 200.0;  // along the longest side
  const StockSettings& stock = job.scene.stock;
  const double voxel = std::max(stock.voxel_mm, stock.box_W.size().maxCoeff() / kCells);
  const TriMesh mesh = starting_stock(job, carried, voxel).mesh();
  if (mesh.triangles.empty()) {
    diagnostics.error("stock-cut-away", {job.scene.file}, "the earlier set-ups have left no material",
                      "look at the pictures of the set-up before this one");
    return;
  }
  Assumptions told;
  check_clamping(job, {mesh, 0.5 * voxel}, diagnostics, told);
  for (const Assumption& one : told)
    diagnostics.note("holding", {job.scene.file}, one.value + ": " + one.reason + "; " + one.change);
}

}  // namespace swarf::sim
