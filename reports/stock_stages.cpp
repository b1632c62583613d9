#include "reports/stock_stages.h"

#include <algorithm>

#include "mesh/mesh_ops.h"
#include "reports/part_view.h"

namespace swarf::reports {
namespace {

StockStage stage_of(const stock::Stock& stock, uint64_t cycle) {
  constexpr double kErrorVoxels = 0.25;
  StockStage stage;
  stage.cycle = cycle;
  stage.mesh = mesh::decimate(stock.mesh(), kErrorVoxels * stock.voxel_mm(), &stage.error_mm);
  mesh::split_creases(stage.mesh, kCreaseRad);
  return stage;
}

}  // namespace

std::vector<StockStage> stock_stages(const FinishedRun& run, size_t count) {
  if (run.window || count == 0) return {};
  const sim::JobSweeps all = sim::stock_sweeps(run.job, run.cycles);
  if (all.sweeps.empty()) return {};
  const double voxel =
      std::max(run.job.scene.movie.voxel_mm, run.job.scene.stock.box_W.size().maxCoeff() / kStageVoxels);
  stock::Stock stock = sim::starting_stock(run.job, run.carried, voxel);
  const std::vector<stock::CutterSolid> solids = sim::tool_solids(run.job.scene);
  motion::CycleReader reader(run.cycles);
  std::vector<StockStage> stages{stage_of(stock, run.first_shown())};
  size_t done = 0;
  for (size_t k = 1; k < count; ++k) {
    const size_t end = std::max<size_t>(1, k * all.sweeps.size() / count);
    if (end == done) continue;
    sim::for_each_tool(
        std::span(all.sweeps).subspan(done, end - done),
        [&](uint32_t block) { return all.sources[block].tool; },
        [&](size_t tool, std::span<const stock::Sweep> part) { stock.cut(part, solids[tool]); });
    done = end;
    const uint64_t cycle = cycle_of(all.sources[all.sweeps[end - 1].block], reader);
    if (cycle > stages.back().cycle) stages.push_back(stage_of(stock, cycle));
  }
  return stages;
}

}  // namespace swarf::reports
