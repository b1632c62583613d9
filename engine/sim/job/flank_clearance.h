// [flank] clearance_mm: the passes are moved until the tool keeps off the fixtures of the scene, a
// neighbouring blade or the hub for example, all along its motion.
#pragma once

#include "sim/job/scene.h"

namespace swarf::sim {

/// Finds the least of these moves of all passes, in this order, and plans them again:
///
///   1. a slide along the tool's axis, an eighth of the flank below guide curve 0 at a time: a cylinder's
///      envelope stays as it is, cones and barrels are placed anew;
///   2. with the whole slide lifts off the surface, at the shank's end, at the tip, at both, by what
///      flank.limit_um leaves above the placement's own error.
///
/// Each is held against the fixtures over the whole motion, approach and retract included, between the cycles
/// too (collision/path_check.h). Diagnostics: "no-obstacle" without a fixture, "flank-too-near" with the
/// place and the greatest of the least gaps.
void keep_clear(Job& job, Diagnostics& diagnostics);

}  // namespace swarf::sim
