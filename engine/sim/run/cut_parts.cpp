#include "sim/run/cut_parts.h"

#include <algorithm>

namespace swarf::sim {
namespace {

constexpr double kDeepestExact = 2.0;  // voxels: deeper, the level set itself tells
constexpr size_t kSweepsPerBatch = 2048;
constexpr size_t kChecks = 8;  // of the invariants on the way, evenly spread over the sweeps

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

size_t CutParts::batch_end(size_t at) const {
  return std::min((at / kSweepsPerBatch + 1) * kSweepsPerBatch, sweeps.size());
}

size_t CutParts::check_end(size_t at) const {
  return ((at * kChecks / sweeps.size() + 1) * sweeps.size() + kChecks - 1) / kChecks;
}

bool CutParts::is_check_due(size_t before, size_t at) const {
  return before * kChecks / sweeps.size() != at * kChecks / sweeps.size() && at < sweeps.size();
}

}  // namespace swarf::sim
