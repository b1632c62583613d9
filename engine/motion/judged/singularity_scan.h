// The singularity of a whole path: every block's distance to the pole, and what its axes would do to the tip.
//
// Deviations are those of linear axes, whatever law the blocks follow: under joint they are the error of the
// run, under the other laws they are what the program would suffer without TCP.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kinematics/singularity.h"
#include "motion/blocks/block_motions.h"
#include "motion/judged/circle_error.h"
#include "toolpath/tool_path.h"

namespace swarf::motion {

/// One feed block, cheap to know.
struct BlockPole {
  int element = 0;                 ///< index into ToolPath::elements
  double pole_distance_rad = 0.0;  ///< least over the block, by its own law
  double cone_rad = 0.0;  ///< half angle of its singular cone (singular_cone); 0 without turn or time
  double bound_mm = 0.0;  ///< 1/8 max|p''| of linear axes
  double outer_swing_rad = 0.0, inner_swing_rad = 0.0;  ///< signed, between its ends
  bool in_cone() const { return pole_distance_rad < cone_rad; }
};

/// One block in full.
struct BlockSingularity {
  BlockPole pole;
  kinematics::BlockEnds ends;
  kinematics::TrajectoryError error;
  kinematics::Peak analytic;         ///< So's Eq. (3), (8), (6)
  std::optional<int> equal, greedy;  ///< pieces within the tolerance; none: it passes the pole
};

struct SingularityScan {
  double tolerance_mm = 0.0;  ///< of `equal` and `greedy`
  std::string outer_axis, inner_axis;
  int blocks = 0;            ///< feed blocks that were looked at
  int rapids = 0, arcs = 0;  ///< not looked at: without a feed; no line to deviate from
  int unreachable = 0;       ///< not looked at: no axis values
  int in_cone = 0;
  BlockPole nearest;  ///< the block that comes nearest to the pole; the first of equals
  /// Those that deviate most from their segment, greatest first; at most kWorstBlocks. Proven: every block
  /// whose bound exceeds the last of them was measured.
  std::vector<BlockSingularity> worst;
  std::optional<CircleError> circle;  ///< of the longest circle that the program gives as lines
};
inline constexpr int kWorstBlocks = 10;

/// None when the machine has no pole, or the path no feed block with a line. Deterministic for any number of
/// threads. Blocks are those of block_motions(path, by_tool).
std::optional<SingularityScan> scan_singularity(const toolpath::ToolPath& path,
                                                std::span<const kinematics::MachineModel> by_tool,
                                                double tolerance_mm);
inline std::optional<SingularityScan> scan_singularity(const toolpath::ToolPath& path,
                                                       const kinematics::MachineModel& machine,
                                                       double tolerance_mm) {
  return scan_singularity(path, std::span(&machine, 1), tolerance_mm);
}

}  // namespace swarf::motion
