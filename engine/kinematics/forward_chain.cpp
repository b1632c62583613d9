#include "kinematics/forward_chain.h"

#include <algorithm>

#include "kinematics/chain.h"
#include "kinematics/model_check.h"

namespace swarf::kinematics {

ForwardChain::ForwardChain(const MachineModel& machine)
    : tip_M_(machine.tip_M), axis_M_(machine.tool_axis_M), X_MW_(machine.X_MW) {
  from_tool_to_work(machine, [&](const LinkStep& step) { steps_.push_back(step); });
  const std::vector<int> rotary = rotary_order(machine);
  for (size_t i = 0; i < 2 && !rotary.empty(); ++i) rotary_[i] = rotary[std::min(i, rotary.size() - 1)];
}

void ForwardChain::at(const AxisValues (&q)[2], ToolPose (&pose_W)[2]) const {
  const double angle[4] = {q[0][rotary_[0]], q[1][rotary_[0]], q[0][rotary_[1]], q[1][rotary_[1]]};
  double sine[4], cosine[4];
  lane_sines<4>(angle, sine, cosine);
  Points tip = both(tip_M_), axis = both(axis_M_);
  for (const LinkStep& step : steps_) {
    if (!step.rotary) {
      tip = tip + (step.sense * Pair{q[0][step.axis], q[1][step.axis]}) * both(step.direction);
      continue;
    }
    const size_t slot = step.axis == rotary_[0] ? 0 : 2;
    const Pair s = step.sense * Pair{sine[slot], sine[slot + 1]}, c{cosine[slot], cosine[slot + 1]};
    const Points origin = both(step.origin);
    tip = origin + rotate(step.along, step.direction, s, c, tip - origin);
    axis = rotate(step.along, step.direction, s, c, axis);
  }
  for (int lane = 0; lane < 2; ++lane) {
    const Vec3 tip_M(tip.x[lane], tip.y[lane], tip.z[lane]), axis_M(axis.x[lane], axis.y[lane], axis.z[lane]);
    pose_W[lane].tip_W = X_MW_.linear().transpose() * (tip_M - X_MW_.translation());
    pose_W[lane].axis_W = X_MW_.linear().transpose() * axis_M;
  }
}

}  // namespace swarf::kinematics
