// What So et al. look at in one block near the pole, as numbers: its trajectory (Fig. 9), the way of its tool
// axis around the pole, its linearisation and its rotary solutions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinematics/machine_model.h"
#include "motion/blocks/linearise.h"
#include "motion/judged/singularity_scan.h"
#include "toolpath/tool_path.h"

namespace swarf::papers {

/// The block cut into equal pieces on its programmed line.
struct PiecesRow {
  int pieces = 0;
  motion::PiecesError error;
};

/// Pieces that keep a tolerance; none: the block passes the pole, where no number helps.
struct ToleranceRow {
  double tolerance_mm = 0.0;
  std::optional<int> equal, greedy;
};

/// The other rotary solution at either end, and the other way round, with linear axes.
struct BranchRow {
  kinematics::BranchChoice choice;
  std::string beyond_travel;  ///< name of the axis that leaves its travel; empty: none does
};

struct BlockStudy {
  /// Parts of the block between two of the points below: u = i / kParts.
  static constexpr int kParts = 400;
  std::vector<Vec3> tip_W, analytic_W;       ///< with linear axes; by So's Eq. (3) as corrected, mm
  std::vector<Vec3> axis_W, tcp_axis_W;      ///< tool axis with linear axes; on the great circle
  Vec3 farthest_line_W, farthest_segment_W;  ///< tips where they leave line and segment most, mm
  Vec3 outer_W;                              ///< direction of the outer rotary axis
  Vec3 pole_W;                               ///< the pole that the axis comes nearest to at the block's start
  std::vector<PiecesRow> pieces;             ///< 1, 2, 4 .. 32
  std::vector<ToleranceRow> tolerances;      ///< .1 mm down to .001 mm
  std::vector<BranchRow> branches;           ///< the first is the block as it runs
};

/// `machine` holds the tool of the block.
BlockStudy study_block(const kinematics::MachineModel& machine, const motion::BlockSingularity& block);

/// The machine of a scan's worst block: with the tool that is in the spindle there. `by_tool` as in the scan.
const kinematics::MachineModel& machine_of_worst(const std::vector<kinematics::MachineModel>& by_tool,
                                                 const toolpath::ToolPath& path,
                                                 const motion::SingularityScan& scan);

}  // namespace swarf::papers
