// What the rotary axes do over blocks: the tip error of the other mode, fast rotary moves, swings.
#pragma once

#include <vector>

#include "motion/blocks/block_motions.h"
#include "motion/options.h"
#include "motion/result.h"
#include "toolpath/tool_path.h"

namespace swarf::motion {

/// Distance of the tip under joint-linear axes from the tip under tcp, greatest over the block: where it is
/// and how much, mm. Straight blocks: from the segment between the ends (theory 2, E15); arcs: from the
/// arc's point at the same share. 0 where no rotary axis turns.
struct ModeError {
  double mm = 0.0;
  double share = 0.0;
};
ModeError mode_error(const BlockMotion& motion);

/// The greatest of all blocks.
OtherMode other_mode(const BlockMotions& motions);

/// Warnings "fast-rotary" (rotary distance per tip distance beyond the threshold, feed blocks) and "swing"
/// (one rotary axis turns far within a block, and which way): the first kListed of each with their blocks,
/// then how many there are. Their times are left to the caller.
std::vector<MotionFinding> find_fast_turns(const toolpath::Elements& elements, const BlockMotions& motions,
                                           const MotionOptions& options);
inline constexpr int kListed = 20;

}  // namespace swarf::motion
