#include "sim/run/job_sweeps.h"

#include <algorithm>
#include <cmath>

#include "cutter/profile.h"
#include "sim/run/cut_sweeps.h"
#include "sim/run/cycle_sweeps.h"
#include "sim/run/driven_sweeps.h"

namespace swarf::sim {
namespace {

using toolpath::BlockMove;

/// Sources of a surface job: blocks are cycles.
std::vector<SweepSource> sources_of_cycles(const motion::Cycles& cycles) {
  std::vector<SweepSource> sources(cycles.size());
  motion::CycleReader reader(cycles);
  for (size_t k = 0; k < sources.size(); ++k) {
    const motion::ToolSample& sample = reader.at(k).sample;
    sources[k] = {sample.element, sample.tool, sample.u, k};
  }
  return sources;
}

/// All cycles of a surface job, merged.
JobSweeps merged_cycles(const Job& job, const motion::Cycles& cycles, double tolerance_mm) {
  std::vector<ToolPose> poses;
  poses.reserve(cycles.size());
  motion::CycleReader reader(cycles);
  for (size_t k = 0; k < cycles.size(); ++k) poses.push_back(reader.at(k).sample.pose);
  stock::MergedSweeps merged = merged_sweeps(poses, job.scene, tolerance_mm);
  return {std::move(merged.sweeps), sources_of_cycles(cycles), merged.error_bound_mm};
}

/// Finds the sweeps of a job of blocks, each with a block of its own.
class BlockSweeper {
 public:
  BlockSweeper(const Job& job, const motion::Cycles& cycles, double tolerance_mm)
      : elements_(cycles.elements()), motions_(cycles.motions()), tolerance_mm_(tolerance_mm) {
    for (const cutter::Cutter& tool : job.scene.tools) levers_mm_.push_back(lever_of(tool));
  }

  CutSweeps each_block() {
    for (size_t i = 0; i < motions_.size(); ++i) add_block(i);
    return {motions_, std::move(parts_), bound_mm_};
  }

  CutSweeps straight_blocks_merged() {
    for (size_t i = 0; i < motions_.size();) {
      const size_t end = straight_end(i);
      if (end > i + 1) {
        add_straight(i, end);
      } else {
        add_block(i);
      }
      i = std::max(end, i + 1);
    }
    return {motions_, std::move(parts_), bound_mm_};
  }

 private:
  static bool is_straight(const motion::BlockMotion& motion) {
    const BlockMove& block = motion.block;
    return !block.arc && !block.curve && block.from.axis_W == block.to.axis_W &&
           (block.law != toolpath::BlockLaw::kJoint || turns_nothing(motion));
  }
  static bool turns_nothing(const motion::BlockMotion& motion) {
    for (size_t i = 0; i < motion.machine->axes.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      if (motion.machine->axes[i].kind == kinematics::AxisKind::kRotary &&
          motion.q_from[row] != motion.q_to[row])
        return false;
    }
    return true;
  }
  /// First block from `first` on that does not join a row of straight blocks of one axis, feed,
  /// spindle and tool.
  size_t straight_end(size_t first) const {
    size_t end = first;
    const BlockMove block = motions_.block(first);
    const auto joins = [&](const BlockMove& next) {
      return next.feed_mm_s == block.feed_mm_s && next.from.axis_W == block.from.axis_W &&
             next.tool == block.tool && is_rapid(next) == is_rapid(block) &&
             next.spindle_rpm == block.spindle_rpm;
    };
    for (; end < motions_.size(); ++end) {
      const motion::BlockMotion motion = motions_[end];
      if (!is_straight(motion) || !joins(motion.block)) break;
    }
    return end;
  }

  void add_block(size_t i) {
    const motion::BlockMotion motion = motions_[i];
    const double lever = lever_of_tool(motion.block.tool);
    const int pieces =
        motion::pieces_within(motion, lever, tolerance_mm_, [&] { return elements_.where(i); });
    for (int k = 0; k < pieces; ++k)
      parts_.push_back(
          {static_cast<uint32_t>(i), static_cast<uint32_t>(pieces), static_cast<uint32_t>(k), false});
    bound_mm_ = std::max(bound_mm_, motion::split_error(motion::motion_bounds(motion), pieces, lever));
  }

  /// Pose 0 of the row is where its first block starts, the others are where blocks end.
  void add_straight(size_t first, size_t end) {
    const auto pose = [&](size_t k) {
      return k == 0 ? motions_.block(first).from : motions_.block_end(first + k - 1);
    };
    const stock::MergeBound bound =
        stock::merge_chain(end - first + 1, pose, lever_of_tool(motions_.tool(first)), tolerance_mm_,
                           [&](size_t from, size_t to) {
                             parts_.push_back({static_cast<uint32_t>(first + to - 1), 0, 0, from > 0});
                           });
    bound_mm_ = std::max(bound_mm_, bound.chain_mm + bound.tick_mm);
  }

  double lever_of_tool(int tool) const { return levers_mm_[static_cast<size_t>(tool)]; }

  const toolpath::Elements& elements_;
  const motion::BlockMotions& motions_;
  std::vector<double> levers_mm_;  ///< by tool
  double tolerance_mm_;
  std::vector<SweepOfBlocks> parts_;
  double bound_mm_ = 0.0;
};

}  // namespace

double lever_of(const cutter::Cutter& cutter) {
  return std::hypot(cutter::greatest_radius(cutter::outline(cutter)), cutter.flute_length_mm);
}

bool is_done(const SweepSource& source, const motion::Cycle& cycle) {
  if (source.cycle) return *source.cycle <= cycle.number;
  const motion::ToolSample& sample = cycle.sample;
  return sample.element > source.element || (sample.element == source.element && sample.u >= source.share);
}

size_t cycle_of(const SweepSource& source, motion::CycleReader& reader) {
  return source.cycle ? *source.cycle : reader.reaching(source.element, source.share);
}

std::vector<stock::Sweep> cycle_sweeps(const motion::Cycles& cycles) {
  CycleSweeps all(cycles.machines().front());
  motion::CycleReader reader(cycles);
  for (size_t k = 0; k < cycles.size(); ++k) all.add({&reader.at(k), 1});
  return all.take().sweeps;
}

stock::MergedSweeps merged_sweeps(std::span<const ToolPose> poses, const Scene& scene, double tolerance_mm) {
  double lever = 0.0;
  for (const cutter::Cutter& tool : scene.tools) lever = std::max(lever, lever_of(tool));
  const std::vector<uint8_t> breaks(poses.size(), 0);
  return stock::merge_sweeps(poses, breaks, lever, tolerance_mm);
}

std::vector<stock::CutterSolid> tool_solids(const Scene& scene) {
  return {scene.tools.begin(), scene.tools.end()};
}

std::vector<int> tool_of_blocks(const JobSweeps& sweeps) {
  std::vector<int> tools;
  tools.reserve(sweeps.sources.size());
  for (const SweepSource& source : sweeps.sources) tools.push_back(source.tool);
  return tools;
}

CutSweeps cut_sweeps(const Job& job, const motion::Cycles& cycles, std::optional<double> tolerance_mm) {
  const double tolerance = tolerance_mm.value_or(job.scene.stock.sweep_tolerance_mm);
  switch (job.scene.stock.cut_by) {
    case CutBy::kBlocks:
      return BlockSweeper(job, cycles, tolerance).straight_blocks_merged();
    case CutBy::kCycles:
      return CutSweeps(driven_sweeps(job, cycles, tolerance, true));
    case CutBy::kPasses:
      break;
  }
  return CutSweeps(merged_cycles(job, cycles, tolerance));
}

JobSweeps stock_sweeps(const Job& job, const motion::Cycles& cycles, std::optional<double> tolerance_mm) {
  return cut_sweeps(job, cycles, tolerance_mm).all();
}

JobSweeps ray_sweeps(const Job& job, const motion::Cycles& cycles, std::optional<double> tolerance_mm) {
  const double tolerance = tolerance_mm.value_or(job.scene.design.sweep_tolerance_mm);
  switch (job.scene.stock.cut_by) {
    case CutBy::kBlocks:
      return BlockSweeper(job, cycles, tolerance).each_block().all();
    case CutBy::kCycles:
      return driven_sweeps(job, cycles, tolerance, false);
    case CutBy::kPasses:
      break;
  }
  // Driven positions are held against fractions of a micrometre: nodes between the cycles would double their
  // chords.
  if (job.driven != nullptr) return driven_sweeps(job, cycles, tolerance, false);
  return {cycle_sweeps(cycles), sources_of_cycles(cycles), 0.0};
}

std::vector<int> pass_of_blocks(const JobSweeps& sweeps, const toolpath::ToolPath& path) {
  std::vector<int> passes;
  passes.reserve(sweeps.sources.size());
  for (const SweepSource& source : sweeps.sources) {
    const auto element = static_cast<size_t>(source.element);
    const auto* pass = path.elements.pass(element);
    const auto* driven = path.elements.driven(element);
    passes.push_back(pass != nullptr               ? pass->pass
                     : driven != nullptr           ? driven->pass
                     : path.elements.hold_blocks() ? path.elements.block(element).pass
                                                   : -1);
  }
  return passes;
}

}  // namespace swarf::sim
