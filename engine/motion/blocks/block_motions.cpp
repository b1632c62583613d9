#include "motion/blocks/block_motions.h"

#include <algorithm>
#include <functional>

#include "kinematics/reach.h"
#include "motion/blocks/pole_turn.h"

namespace swarf::motion {
namespace {

using kinematics::AxisValues;
using kinematics::MachineModel;
using toolpath::AxisSpan;
using toolpath::BlockLaw;
using toolpath::BlockMove;

/// Finds the axis values at the ends of blocks, one after the other.
class AxisFollower {
 public:
  explicit AxisFollower(std::span<const MachineModel> by_tool)
      : by_tool_(by_tool), inverses_(by_tool.begin(), by_tool.end()) {
    const std::vector<kinematics::Axis>& axes = by_tool.front().axes;
    for (size_t i = 0; i < axes.size(); ++i) q_[static_cast<Eigen::Index>(i)] = axes[i].home;
  }

  AxisSpan next(const BlockMove& block, const std::function<SourceLocation()>& where) {
    const size_t index = by_tool_.size() == 1 ? 0 : static_cast<size_t>(block.tool);
    const bool tool_is_new = block.tool != tool_;
    tool_ = block.tool;
    if (block.axes) {
      q_ = block.axes->to;
      return {block.axes->from, block.axes->to};
    }
    if (tool_is_new) solve(block.from, block, index, where);
    const AxisValues from = q_ = leaving_pole(inverses_[index], block, q_);
    solve(block.to, block, index, where);
    return {from, q_};
  }

 private:
  void solve(const ToolPose& pose, const BlockMove& block, size_t index,
             const std::function<SourceLocation()>& where) {
    const kinematics::Branch branch = inverses_[index].solve_nearest(pose, q_);
    if (branch.outcome != kinematics::InverseOutcome::kUnreachable) {
      q_ = branch.q;
    } else if (block.law == BlockLaw::kJoint || block.law == BlockLaw::kTcpAxes) {
      const kinematics::UnreachableText why = kinematics::unreachable_text(by_tool_[index], pose);
      throw InputError("unreachable", where(), why.text, why.fix);
    }
  }

  std::span<const MachineModel> by_tool_;
  std::vector<kinematics::InverseKinematics> inverses_;
  AxisValues q_ = AxisValues::Zero();
  int tool_ = -1;
};

bool has_rotary_axis(const MachineModel& machine) {
  return std::any_of(machine.axes.begin(), machine.axes.end(),
                     [](const kinematics::Axis& axis) { return axis.kind == kinematics::AxisKind::kRotary; });
}

}  // namespace

BlockMotions::BlockMotions(const toolpath::Elements& elements, std::span<const MachineModel> by_tool)
    : elements_(elements), by_tool_(by_tool), count_(elements.size()) {
  if (elements.all_give_axes()) return;
  AxisFollower follower(by_tool);
  auto found = std::make_shared<std::vector<AxisSpan>>();
  found->reserve(count_);
  for (size_t i = 0; i < count_; ++i)
    found->push_back(follower.next(elements.block(i), [&] { return elements.where(i); }));
  found_ = std::move(found);
}

BlockMotion BlockMotions::operator[](size_t i) const {
  BlockMotion motion;
  motion.block = block(i);
  motion.machine = &by_tool_[by_tool_.size() == 1 ? 0 : static_cast<size_t>(motion.block.tool)];
  const AxisSpan ends = found_ ? (*found_)[first_ + i] : *motion.block.axes;
  motion.q_from = ends.from;
  motion.q_to = ends.to;
  return motion;
}

BlockMotions BlockMotions::subspan(size_t first, size_t count) const {
  BlockMotions part = *this;
  part.first_ += first;
  part.count_ = count;
  return part;
}

bool BlockMotions::may_turn() const {
  return std::any_of(by_tool_.begin(), by_tool_.end(), has_rotary_axis);
}

}  // namespace swarf::motion
