#include "sim/run/cut_parts.h"

namespace swarf::sim {
namespace {

constexpr double kDeepestExact = 2.0;  // voxels: deeper, the level set itself tells

}  // namespace

CutParts::CutParts(const Job& job, const motion::Cycles& cycles, const CarriedCuts& carried_cuts)
    : sweeps(cut_sweeps(job, cycles)),
      solids(tool_solids(job.scene)),
      carried(carried_cuts),
      identity(cut_identity(job, sweeps, carried)),
      places(sweeps, cycles),
      earlier(sweeps, solids, carried, job.scene.stock.body_W(), kDeepestExact * job.scene.stock.voxel_mm),
      clearance(job.scene.tools, sweeps, places, earlier, job.scene.stock.voxel_mm),
      bad_cuts(job, cycles, sweeps, places, earlier) {}

void CutParts::cut(stock::Stock& stock, size_t begin, size_t end) const {
  sweeps.for_each_tool(
      begin, end, [&](size_t tool, std::span<const stock::Sweep> part) { stock.cut(part, solids[tool]); });
}

}  // namespace swarf::sim
