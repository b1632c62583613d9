#include "motion/blocks/pose_law.h"

#include "kinematics/chain.h"
#include "toolpath/tool_path.h"

namespace swarf::motion {

using toolpath::BlockLaw;
using toolpath::BlockMove;

PoseLaw::PoseLaw(const BlockMotion& motion) {
  const BlockMove& block = motion.block;
  if (block.law == BlockLaw::kTcp) circle_.emplace(block.from.axis_W, block.to.axis_W);
  if (block.arc && (block.law == BlockLaw::kTcp || block.law == BlockLaw::kTcpAxes)) arc_.emplace(block);
}

ToolPose PoseLaw::at(const BlockMotion& motion, double s) const {
  const BlockMove& block = motion.block;
  if (s <= 0.0) return block.from;
  if (s >= 1.0) return block.to;
  if (block.law == BlockLaw::kCurve)
    return block.curve->curve->pose(block.curve->from + s * (block.curve->to - block.curve->from));
  if (block.law == BlockLaw::kEnds)
    return {block.from.tip_W + s * (block.to.tip_W - block.from.tip_W),
            (block.from.axis_W + s * (block.to.axis_W - block.from.axis_W)).normalized()};
  if (block.law == BlockLaw::kJoint)
    return kinematics::forward(*motion.machine, motion.q_from + s * (motion.q_to - motion.q_from));
  ToolPose pose;
  pose.axis_W =
      circle_ ? circle_->at(s)
              : kinematics::forward_axis(*motion.machine, motion.q_from + s * (motion.q_to - motion.q_from));
  pose.tip_W = arc_ ? arc_->point(s) : Vec3(block.from.tip_W + s * (block.to.tip_W - block.from.tip_W));
  return pose;
}

}  // namespace swarf::motion
