#include "sim/job_sweeps.h"

#include <algorithm>
#include <cmath>

#include "cutter/profile.h"
#include "motion/block_motion.h"
#include "sim/driven_sweeps.h"

namespace swarf::sim {
namespace {

using toolpath::BlockMove;

/// Sources of a surface job: blocks are samples.
std::vector<SweepSource> sources_of_samples(const motion::Trajectory& trajectory) {
  std::vector<SweepSource> sources(trajectory.samples.size());
  for (size_t i = 0; i < sources.size(); ++i)
    sources[i] = {trajectory.samples[i].element, static_cast<uint32_t>(i), trajectory.samples[i].tool};
  return sources;
}

/// Finds the cycle in which the tool comes to a place of a block. Places must be asked for in order.
class SampleFinder {
 public:
  explicit SampleFinder(const motion::Trajectory& trajectory) : samples_(trajectory.samples) {}
  uint32_t at(int element, double s) {
    const auto short_of = [&](const motion::ToolSample& sample) {
      return sample.element < element || (sample.element == element && sample.u < s);
    };
    while (next_ + 1 < samples_.size() && short_of(samples_[next_])) ++next_;
    return static_cast<uint32_t>(next_);
  }

 private:
  const std::vector<motion::ToolSample>& samples_;
  size_t next_ = 0;
};

/// Collects the sweeps of a CL job, each with a block of its own.
class BlockSweeper {
 public:
  BlockSweeper(const Job& job, const toolpath::ToolPath& path, const motion::Trajectory& trajectory,
               double tolerance_mm)
      : path_(path),
        machines_(machines_by_tool(job)),
        motions_(motion::block_motions(path, machines_)),
        finder_(trajectory),
        tolerance_mm_(tolerance_mm) {
    for (const cutter::Cutter& tool : job.scene.tools) levers_mm_.push_back(lever_of(tool));
  }

  JobSweeps each_block() {
    for (size_t i = 0; i < motions_.size(); ++i) add_block(i);
    return std::move(out_);
  }

  JobSweeps straight_blocks_merged() {
    for (size_t i = 0; i < motions_.size();) {
      const size_t end = straight_end(i);
      if (end > i + 1) {
        add_straight(i, end);
      } else {
        add_block(i);
      }
      i = std::max(end, i + 1);
    }
    return std::move(out_);
  }

 private:
  bool is_straight(size_t i) const {
    const BlockMove& block = *motions_[i].block;
    return !block.arc && block.from.axis_W == block.to.axis_W &&
           (block.law != toolpath::BlockLaw::kJoint || turns_nothing(motions_[i]));
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
    const BlockMove& block = *motions_[first].block;
    const auto joins = [&](const BlockMove& next) {
      return next.feed_mm_s == block.feed_mm_s && next.from.axis_W == block.from.axis_W &&
             next.tool == block.tool && is_rapid(next) == is_rapid(block) &&
             next.spindle_rpm == block.spindle_rpm;
    };
    while (end < motions_.size() && is_straight(end) && joins(*motions_[end].block)) ++end;
    return end;
  }

  void add(const ToolPose& start, const ToolPose& end, size_t element, double s) {
    out_.sweeps.push_back({start, end, static_cast<uint32_t>(out_.sources.size())});
    const int index = static_cast<int>(element);
    out_.sources.push_back({index, finder_.at(index, s), motions_[element].block->tool});
  }

  void add_block(size_t i) {
    const std::vector<ToolPose> poses =
        motion::subdivide(motions_[i], lever(i), tolerance_mm_, path_.elements[i].where);
    const size_t pieces = poses.size() - 1;
    for (size_t k = 0; k < pieces; ++k)
      add(poses[k], poses[k + 1], i, static_cast<double>(k + 1) / static_cast<double>(pieces));
    const double error =
        motion::split_error(motion::motion_bounds(motions_[i]), static_cast<int>(pieces), lever(i));
    out_.error_bound_mm = std::max(out_.error_bound_mm, error);
  }

  void add_straight(size_t first, size_t end) {
    std::vector<ToolPose> poses{motions_[first].block->from};
    for (size_t i = first; i < end; ++i) poses.push_back(motions_[i].block->to);
    const std::vector<uint8_t> breaks(poses.size(), 0);
    const stock::MergedSweeps merged = stock::merge_sweeps(poses, breaks, lever(first), tolerance_mm_);
    for (const stock::Sweep& sweep : merged.sweeps) add(sweep.start, sweep.end, first + sweep.block - 1, 1.0);
    out_.error_bound_mm = std::max(out_.error_bound_mm, merged.error_bound_mm);
  }

  double lever(size_t i) const { return levers_mm_[static_cast<size_t>(motions_[i].block->tool)]; }

  const toolpath::ToolPath& path_;
  std::vector<kinematics::MachineModel> machines_;  ///< by tool
  std::vector<motion::BlockMotion> motions_;
  SampleFinder finder_;
  std::vector<double> levers_mm_;  ///< by tool
  double tolerance_mm_;
  JobSweeps out_;
};

}  // namespace

double lever_of(const cutter::Cutter& cutter) {
  return std::hypot(cutter::greatest_radius(cutter::outline(cutter)), cutter.flute_length_mm);
}

std::vector<stock::Sweep> cycle_sweeps(const motion::Trajectory& trajectory,
                                       const kinematics::MachineModel& machine) {
  const size_t count = trajectory.samples.size();
  std::vector<stock::Sweep> sweeps(count);
  if (count == 0) return sweeps;
  // The nodes lie half way between the samples, where the joint-linear motion of the axes strays most from
  // the path.
  ToolPose node = trajectory.samples.front().pose;
  for (size_t i = 0; i < count; ++i) {
    const ToolPose next =
        i + 1 < count ? kinematics::forward(machine, 0.5 * (trajectory.axes[i] + trajectory.axes[i + 1]))
                      : trajectory.samples[i].pose;
    sweeps[i] = {node, next, static_cast<uint32_t>(i)};
    node = next;
  }
  return sweeps;
}

stock::MergedSweeps merged_sweeps(const motion::Trajectory& trajectory, const Scene& scene) {
  std::vector<ToolPose> poses;
  std::vector<uint8_t> breaks;
  poses.reserve(trajectory.samples.size());
  breaks.reserve(trajectory.samples.size());
  for (const motion::ToolSample& sample : trajectory.samples) {
    const bool changed = !poses.empty() && trajectory.samples[poses.size() - 1].tool != sample.tool;
    poses.push_back(sample.pose);
    breaks.push_back(changed ? 1 : 0);
  }
  double lever = 0.0;
  for (const cutter::Cutter& tool : scene.tools) lever = std::max(lever, lever_of(tool));
  return stock::merge_sweeps(poses, breaks, lever, scene.stock.sweep_tolerance_mm);
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

JobSweeps stock_sweeps(const Job& job, const toolpath::ToolPath& path, const motion::Trajectory& trajectory) {
  const double tolerance = job.scene.stock.sweep_tolerance_mm;
  if (job.scene.cuts_cycles()) return driven_sweeps(job, path, trajectory, tolerance, true);
  if (job.scene.has_blocks()) return BlockSweeper(job, path, trajectory, tolerance).straight_blocks_merged();
  stock::MergedSweeps merged = merged_sweeps(trajectory, job.scene);
  return {std::move(merged.sweeps), sources_of_samples(trajectory), merged.error_bound_mm};
}

JobSweeps ray_sweeps(const Job& job, const toolpath::ToolPath& path, const motion::Trajectory& trajectory) {
  const double tolerance = job.scene.design.sweep_tolerance_mm;
  if (job.scene.cuts_cycles()) return driven_sweeps(job, path, trajectory, tolerance, false);
  if (job.scene.has_blocks()) return BlockSweeper(job, path, trajectory, tolerance).each_block();
  return {cycle_sweeps(trajectory, job.machine.model), sources_of_samples(trajectory), 0.0};
}

std::vector<int> pass_of_blocks(const JobSweeps& sweeps, const toolpath::ToolPath& path) {
  std::vector<int> passes;
  passes.reserve(sweeps.sources.size());
  for (const SweepSource& source : sweeps.sources) {
    const auto& what = path.elements[static_cast<size_t>(source.element)].what;
    const auto* pass = std::get_if<toolpath::SurfacePass>(&what);
    const auto* block = std::get_if<BlockMove>(&what);
    passes.push_back(pass != nullptr ? pass->pass : block != nullptr ? block->pass : -1);
  }
  return passes;
}

}  // namespace swarf::sim
