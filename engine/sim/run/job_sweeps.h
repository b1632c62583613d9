// What cuts the stock and the measuring rays, for both kinds of job, and what a Sweep::block then means.
//
//   surface job   level set: cycles merged within the tolerance     rays: one sweep per cycle
//   block job     level set and rays: the blocks' own motions, divided within a tolerance of each,
//                 or the cycles as the axes drive them (StockSettings::cut_by)
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "motion/cycles/cycles.h"
#include "sim/job/scene.h"
#include "stock/sweep/sweep.h"
#include "toolpath/tool_path.h"

namespace swarf::sim {

/// Where a sweep comes from.
struct SweepSource {
  int element = 0;     ///< index into ToolPath::elements
  int tool = 0;        ///< index into Scene::tools
  double share = 1.0;  ///< of the element, where the sweep ends
  /// Cycle in which the tool comes to the sweep's end; none: the one that reaches element and share.
  std::optional<uint64_t> cycle;
};

/// The tool has come to the sweep's end in this cycle.
bool is_done(const SweepSource& source, const motion::Cycle& cycle);

/// Cycle in which the tool comes to the sweep's end.
size_t cycle_of(const SweepSource& source, motion::CycleReader& reader);

struct JobSweeps {
  std::vector<stock::Sweep> sweeps;
  /// By Sweep::block.
  std::vector<SweepSource> sources;
  /// Greatest distance between the sweeps and the motion they stand for, mm.
  double error_bound_mm = 0.0;
};

/// One sweep per cycle, id = index of its sample, from the middle of the cycle before to the middle of the
/// one after. The axes move linearly inside a cycle, and half way is where the tool then strays most from the
/// path: with these poses as nodes the chord of a cycle is cut as deep as the machine cuts it, and the
/// samples stay on the path.
std::vector<stock::Sweep> cycle_sweeps(const motion::Cycles& cycles);

/// Poses that follow each other, merged within the tolerance for every tool of the scene; Sweep::block is the
/// index of the pose at its end.
stock::MergedSweeps merged_sweeps(std::span<const ToolPose> poses, const Scene& scene, double tolerance_mm);

/// The flutes of each tool of the scene.
std::vector<stock::CutterSolid> tool_solids(const Scene& scene);

/// Calls visit(tool, sweeps) for each row of consecutive sweeps of one tool. `tool_of`: from Sweep::block.
template <typename ToolOf, typename Visit>
void for_each_tool(std::span<const stock::Sweep> sweeps, const ToolOf& tool_of, const Visit& visit) {
  for (size_t begin = 0, end = 0; begin < sweeps.size(); begin = end) {
    const auto tool = tool_of(sweeps[begin].block);
    while (end < sweeps.size() && tool_of(sweeps[end].block) == tool) ++end;
    visit(static_cast<size_t>(tool), sweeps.subspan(begin, end - begin));
  }
}

/// Distance from the tip to the farthest point of the flutes, mm.
double lever_of(const cutter::Cutter& cutter);

/// Those of cut_sweeps(), all held at once.
JobSweeps stock_sweeps(const Job& job, const motion::Cycles& cycles, std::optional<double> tolerance_mm = {});

/// For the measuring rays; each sweep has a block of its own. Blocks: within design.sweep_tolerance or the
/// given one, mm.
JobSweeps ray_sweeps(const Job& job, const motion::Cycles& cycles, std::optional<double> tolerance_mm = {});

/// Tool of each block in `sources`.
std::vector<int> tool_of_blocks(const JobSweeps& sweeps);

/// Pass of each block in `sources`; -1 between passes.
std::vector<int> pass_of_blocks(const JobSweeps& sweeps, const toolpath::ToolPath& path);

}  // namespace swarf::sim
