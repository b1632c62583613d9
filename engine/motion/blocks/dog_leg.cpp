#include "motion/blocks/dog_leg.h"

#include <algorithm>
#include <cmath>

#include "motion/blocks/block_motions.h"
#include "motion/blocks/block_run.h"

namespace swarf::motion {
namespace {

using kinematics::AxisValues;
using kinematics::MachineModel;
using toolpath::BlockLaw;
using toolpath::BlockMove;

double arrival(const BlockMotion& motion, size_t i) {
  const auto row = static_cast<Eigen::Index>(i);
  const kinematics::Axis& axis = motion.machine->axes[i];
  return std::abs(motion.q_to[row] - motion.q_from[row]) / speed_limit(axis, true);
}

/// Axis values at each arrival, the last one exactly the block's end.
std::vector<AxisValues> stations(const BlockMotion& motion) {
  std::vector<double> times;
  const size_t axes = motion.machine->axes.size();
  for (size_t i = 0; i < axes; ++i) times.push_back(arrival(motion, i));
  std::vector<double> stops = times;
  std::sort(stops.begin(), stops.end());
  // Axes that arrive within a millionth of the move arrive together.
  std::vector<AxisValues> values;
  for (size_t k = 0; k < stops.size(); ++k) {
    if (stops[k] == 0.0 || (k + 1 < stops.size() && stops[k + 1] - stops[k] <= 1e-6 * stops.back())) continue;
    AxisValues q = motion.q_to;
    for (size_t i = 0; i < axes; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      if (times[i] > stops[k])
        q[row] = motion.q_from[row] + stops[k] / times[i] * (motion.q_to[row] - motion.q_from[row]);
    }
    values.push_back(q);
  }
  return values;
}

void append_legs(const toolpath::Element& element, const BlockMotion& motion, toolpath::Elements& out) {
  const std::vector<AxisValues> values = stations(motion);
  AxisValues from = motion.q_from;
  ToolPose pose = motion.block.from;
  for (size_t k = 0; k < values.size(); ++k) {
    const bool last = k + 1 == values.size();
    BlockMove leg = motion.block;
    leg.curve.reset();  // of feeds alone
    leg.axes = toolpath::AxisSpan{from, values[k]};
    leg.from = pose;
    leg.to = last ? motion.block.to : kinematics::forward(*motion.machine, values[k]);
    leg.dwell_s = k == 0 ? motion.block.dwell_s : 0.0;
    leg.exact_stop = last;
    leg.corner_tolerance_mm = kDogLegCorner;
    out.push_back({leg, element.operation, element.where});
    from = values[k];
    pose = leg.to;
  }
  if (values.empty()) out.push_back(element);
}

}  // namespace

toolpath::ToolPath with_dog_legs(toolpath::ToolPath path, std::span<const MachineModel> by_tool) {
  const bool dog_leg = by_tool.front().rapid == kinematics::RapidMotion::kDogLeg;
  if (!dog_leg || !toolpath::holds_blocks(path)) return path;
  const BlockMotions motions(path.elements, by_tool);
  toolpath::Elements elements;
  size_t copied = 0;
  for (size_t i = 0; i < motions.size(); ++i) {
    if (!path.elements.is_rapid(i) || motions.block(i).law != BlockLaw::kJoint) continue;
    elements.append(path.elements, copied, i);
    append_legs(path.elements[i], motions[i], elements);
    copied = i + 1;
  }
  elements.append(path.elements, copied, path.elements.size());
  path.elements = std::move(elements);
  return path;
}

}  // namespace swarf::motion
