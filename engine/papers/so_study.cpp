#include "papers/so_study.h"

#include <algorithm>

#include "base/tool_axis.h"
#include "kinematics/singularity_model.h"

namespace swarf::papers {
namespace {

using kinematics::BlockEnds;
using kinematics::MachineModel;

constexpr int kMostPieces = 32;
constexpr double kTolerances[] = {0.1, 0.05, 0.02, 0.01, 0.005, 0.001};  // mm

ToolPose pose_at(const MachineModel& machine, const BlockEnds& ends, double u) {
  return kinematics::forward(machine, ends.q_from + u * (ends.q_to - ends.q_from));
}

void trace(const MachineModel& machine, const motion::BlockSingularity& block, BlockStudy& study) {
  const BlockEnds& ends = block.ends;
  const kinematics::SingularityModel model(machine, ends);
  for (int i = 0; i <= BlockStudy::kParts; ++i) {
    const double u = static_cast<double>(i) / BlockStudy::kParts;
    const ToolPose pose = pose_at(machine, ends, u);
    study.tip_W.push_back(pose.tip_W);
    study.axis_W.push_back(pose.axis_W);
    study.analytic_W.push_back(model.tip_W(u));
    study.tcp_axis_W.push_back(slerp(ends.from.axis_W, ends.to.axis_W, u));
  }
  study.farthest_line_W = pose_at(machine, ends, block.error.line.u).tip_W;
  study.farthest_segment_W = pose_at(machine, ends, block.error.segment.u).tip_W;
}

void find_pole(const MachineModel& machine, const Vec3& axis_W, BlockStudy& study) {
  const kinematics::Poles poles = kinematics::find_poles(machine);
  study.outer_W =
      machine.X_MW.linear().transpose() * machine.axes[static_cast<size_t>(poles.outer)].direction_M;
  study.pole_W = std::max_element(poles.at.begin(), poles.at.end(),
                                  [&](const kinematics::Pole& a, const kinematics::Pole& b) {
                                    return a.direction_W.dot(axis_W) < b.direction_W.dot(axis_W);
                                  })
                     ->direction_W;
}

void linearise(const MachineModel& machine, const BlockEnds& ends, BlockStudy& study) {
  const kinematics::InverseKinematics inverse(machine);
  for (int pieces = 1; pieces <= kMostPieces; pieces *= 2)
    study.pieces.push_back({pieces, motion::equal_pieces_error(machine, inverse, ends, pieces)});
  for (const double tolerance_mm : kTolerances) {
    const auto cuts = motion::greedy_cuts(machine, inverse, ends, tolerance_mm);
    study.tolerances.push_back({tolerance_mm, motion::equal_pieces(machine, inverse, ends, tolerance_mm),
                                cuts ? std::optional(static_cast<int>(cuts->size()) - 1) : std::nullopt});
  }
  for (const kinematics::BranchChoice& choice : kinematics::branch_choices(machine, inverse, ends)) {
    const int beyond = choice.out_of_travel_axis;
    study.branches.push_back({choice, beyond < 0 ? "" : machine.axes[static_cast<size_t>(beyond)].name});
  }
}

}  // namespace

BlockStudy study_block(const MachineModel& machine, const motion::BlockSingularity& block) {
  BlockStudy study;
  trace(machine, block, study);
  find_pole(machine, block.ends.from.axis_W, study);
  linearise(machine, block.ends, study);
  return study;
}

const MachineModel& machine_of_worst(const std::vector<MachineModel>& by_tool, const toolpath::ToolPath& path,
                                     const motion::SingularityScan& scan) {
  const auto element = static_cast<size_t>(scan.worst.front().pole.element);
  return by_tool[static_cast<size_t>(path.elements.tool(element))];
}

}  // namespace swarf::papers
