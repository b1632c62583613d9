#include "reports/stock_stages.h"

#include <algorithm>
#include <cmath>

#include "mesh/mesh_ops.h"
#include "reports/part_view.h"
#include "sim/run/cut_along.h"

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

/// Way at feed up to each sweep's end, mm, for sharing out alone.
std::vector<double> ways_at_feed(const sim::JobSweeps& all, const toolpath::Elements& elements) {
  const auto at_feed = [&](size_t element) {
    return elements.hold_blocks() ? !elements.is_rapid(element)
                                  : elements.pass(element) != nullptr || elements.driven(element) != nullptr;
  };
  std::vector<double> ways;
  double way = 0.0;
  for (const stock::Sweep& sweep : all.sweeps) {
    if (at_feed(static_cast<size_t>(all.sources[sweep.block].element)))
      way += (sweep.end.tip_W - sweep.start.tip_W).norm();
    ways.push_back(way);
  }
  return ways;
}

/// The cycle, about, in which so much of the way at feed is done.
uint64_t cycle_at(double way, const std::vector<double>& ways, const sim::JobSweeps& all,
                  motion::CycleReader& reader) {
  const auto n = static_cast<size_t>(std::lower_bound(ways.begin(), ways.end(), way) - ways.begin());
  const auto end_of = [&](size_t sweep) { return cycle_of(all.sources[all.sweeps[sweep].block], reader); };
  const size_t begin = n > 0 ? end_of(n - 1) : 0, end = end_of(n);
  const double before = n > 0 ? ways[n - 1] : 0.0, share = (way - before) / (ways[n] - before);
  return begin + static_cast<uint64_t>(std::llround(share * static_cast<double>(end - begin)));
}

}  // namespace

std::vector<StockStage> stock_stages(const FinishedRun& run, size_t count) {
  if (run.window || count == 0) return {};
  const double voxel =
      std::max(run.job.scene.movie.voxel_mm, run.job.scene.stock.box_W.size().maxCoeff() / kStageVoxels);
  sim::CutAlong along(run.job, run.carried, run.cycles, voxel);
  if (along.sweeps().sweeps.empty()) return {};
  const std::vector<double> ways = ways_at_feed(along.sweeps(), run.cycles.elements());
  motion::CycleReader reader(run.cycles);
  std::vector<StockStage> stages{stage_of(along.stock(), run.first_shown())};
  for (size_t k = 1; k < count && ways.back() > 0.0; ++k) {
    const double way = ways.back() * static_cast<double>(k) / static_cast<double>(count);
    const uint64_t cycle = cycle_at(way, ways, along.sweeps(), reader);
    if (cycle <= stages.back().cycle) continue;
    along.advance(reader.at(cycle));
    stages.push_back(stage_of(along.stock(), cycle));
  }
  return stages;
}

}  // namespace swarf::reports
