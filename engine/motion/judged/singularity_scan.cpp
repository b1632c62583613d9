#include "motion/judged/singularity_scan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/angles.h"
#include "base/parallel.h"
#include "kinematics/singularity_model.h"
#include "motion/blocks/linearise.h"

namespace swarf::motion {
namespace {

using kinematics::BlockEnds;
using kinematics::InverseKinematics;
using kinematics::MachineModel;
using kinematics::Poles;
using toolpath::BlockLaw;
using toolpath::BlockMove;

constexpr size_t kChunk = 256;
/// Axis values belong to a pose when forward() gives it back within this, mm and 1.
constexpr double kSamePose = 1e-6;

BlockEnds ends_of(const BlockMotion& motion) {
  return {motion.block.from, motion.block.to, motion.q_from, motion.q_to};
}

/// Under laws that do not need them block_motions leaves the values as they were where there are none.
bool reached(const MachineModel& machine, const BlockEnds& ends) {
  const auto stands = [&](const kinematics::AxisValues& q, const ToolPose& pose) {
    const ToolPose back = kinematics::forward(machine, q);
    return (back.tip_W - pose.tip_W).norm() <= kSamePose && (back.axis_W - pose.axis_W).norm() <= kSamePose;
  };
  return stands(ends.q_from, ends.from) && stands(ends.q_to, ends.to);
}

double block_seconds(const BlockMove& block) {
  if (block.duration_s > 0.0) return block.duration_s;
  return toolpath::tip_way(block) / block.feed_mm_s;
}

BlockPole pole_of(const BlockMotion& motion, int element, const Poles& poles) {
  const MachineModel& machine = *motion.machine;
  const BlockMove& block = motion.block;
  const BlockEnds ends = ends_of(motion);
  BlockPole pole;
  pole.element = element;
  // A curve's axis between two near ends: the great circle stands for it.
  const bool on_arc = block.law != BlockLaw::kJoint && block.law != BlockLaw::kTcpAxes;
  pole.pole_distance_rad = on_arc ? kinematics::pole_distance_on_arc(poles, ends.from.axis_W, ends.to.axis_W)
                                  : kinematics::pole_distance_of_axes(machine, poles, ends);
  const double turn = angle_between(ends.from.axis_W, ends.to.axis_W);
  const double seconds = block_seconds(block);
  const double speed = machine.axes[static_cast<size_t>(poles.outer)].speed_max;
  if (turn > 0.0 && seconds > 0.0) pole.cone_rad = kinematics::singular_cone(turn, seconds, speed);
  pole.bound_mm = kinematics::trajectory_error_bound(machine, ends);
  pole.outer_swing_rad = ends.q_to[poles.outer] - ends.q_from[poles.outer];
  pole.inner_swing_rad = ends.q_to[poles.inner] - ends.q_from[poles.inner];
  return pole;
}

/// Sorts the path's blocks into those that are looked at and those that are not.
std::vector<int> feed_blocks(const BlockMotions& motions, SingularityScan& scan) {
  std::vector<int> elements;
  for (size_t i = 0; i < motions.size(); ++i) {
    const BlockMotion motion = motions[i];
    const BlockMove& block = motion.block;
    if (block.feed_mm_s == 0.0 && block.duration_s == 0.0) {
      ++scan.rapids;
    } else if (block.arc) {
      ++scan.arcs;
    } else if (!reached(*motion.machine, ends_of(motion))) {
      ++scan.unreachable;
    } else {
      elements.push_back(static_cast<int>(i));
    }
  }
  return elements;
}

/// Blocks in the order of their bounds are measured until the bound falls below the least that is kept.
void find_worst(const BlockMotions& motions, const std::vector<BlockPole>& all, SingularityScan& scan) {
  std::vector<size_t> order(all.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return all[a].bound_mm > all[b].bound_mm; });
  const auto worse = [](const BlockSingularity& a, const BlockSingularity& b) {
    if (a.error.segment.value != b.error.segment.value) return a.error.segment.value > b.error.segment.value;
    return a.pole.element < b.pole.element;
  };
  for (const size_t i : order) {
    const bool full = scan.worst.size() == static_cast<size_t>(kWorstBlocks);
    if (full && all[i].bound_mm <= scan.worst.back().error.segment.value) break;
    BlockSingularity block;
    block.pole = all[i];
    const BlockMotion motion = motions[static_cast<size_t>(all[i].element)];
    block.ends = ends_of(motion);
    block.error = kinematics::trajectory_error(*motion.machine, block.ends);
    scan.worst.insert(std::lower_bound(scan.worst.begin(), scan.worst.end(), block, worse), block);
    if (full) scan.worst.pop_back();
  }
}

}  // namespace

std::optional<SingularityScan> scan_singularity(const toolpath::ToolPath& path,
                                                std::span<const MachineModel> by_tool, double tolerance_mm) {
  if (!toolpath::holds_blocks(path)) return std::nullopt;
  // Poles and axes are those of the machine, whatever its tool.
  const MachineModel& machine = by_tool.front();
  const Poles poles = kinematics::find_poles(machine);
  if (poles.at.empty()) return std::nullopt;
  SingularityScan scan;
  scan.tolerance_mm = tolerance_mm;
  scan.outer_axis = machine.axes[static_cast<size_t>(poles.outer)].name;
  scan.inner_axis = machine.axes[static_cast<size_t>(poles.inner)].name;
  const BlockMotions motions(path.elements, by_tool);
  const std::vector<int> elements = feed_blocks(motions, scan);
  scan.blocks = static_cast<int>(elements.size());
  if (elements.empty()) return std::nullopt;

  std::vector<BlockPole> all(elements.size());
  parallel_chunks(elements.size(), kChunk, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      all[i] = pole_of(motions[static_cast<size_t>(elements[i])], elements[i], poles);
    }
  });
  scan.nearest = all.front();
  for (const BlockPole& pole : all) {
    if (pole.pole_distance_rad < scan.nearest.pole_distance_rad) scan.nearest = pole;
    if (pole.in_cone()) ++scan.in_cone;
  }
  find_worst(motions, all, scan);
  scan.circle = circle_error(motions, elements);
  parallel_chunks(scan.worst.size(), 1, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      BlockSingularity& block = scan.worst[i];
      const MachineModel& own = *motions[static_cast<size_t>(block.pole.element)].machine;
      const InverseKinematics inverse(own);
      block.analytic = kinematics::SingularityModel(own, block.ends).greatest_deviation();
      block.equal = equal_pieces(own, inverse, block.ends, tolerance_mm);
      const auto cuts = greedy_cuts(own, inverse, block.ends, tolerance_mm);
      if (cuts) block.greedy = static_cast<int>(cuts->size()) - 1;
    }
  });
  return scan;
}

}  // namespace swarf::motion
