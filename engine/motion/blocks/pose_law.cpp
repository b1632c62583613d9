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

void PoseLaw::set(const BlockMotion& motion, double s, ToolPose& pose) const {
  const BlockMove& block = motion.block;
  if (s <= 0.0 || s >= 1.0) {
    pose = s <= 0.0 ? block.from : block.to;
  } else if (block.law == BlockLaw::kCurve) {
    pose = block.curve->curve->pose(block.curve->from + s * (block.curve->to - block.curve->from));
  } else if (block.law == BlockLaw::kJoint) {
    pose = kinematics::forward(*motion.machine, motion.q_from + s * (motion.q_to - motion.q_from));
  } else {
    if (arc_)
      pose.tip_W = arc_->point(s);
    else
      pose.tip_W = block.from.tip_W + s * (block.to.tip_W - block.from.tip_W);
    if (circle_)
      pose.axis_W = circle_->at(s);
    else if (block.law == BlockLaw::kEnds)
      pose.axis_W = (block.from.axis_W + s * (block.to.axis_W - block.from.axis_W)).normalized();
    else
      pose.axis_W =
          kinematics::forward_axis(*motion.machine, motion.q_from + s * (motion.q_to - motion.q_from));
  }
}

}  // namespace swarf::motion
