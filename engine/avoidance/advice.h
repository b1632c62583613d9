// What neither solution of the rotary axes, clamping nor tool length can avoid is the path's to avoid (method
// D of Kruth et al.): the smallest lead or tilt of each block that frees it, else the smallest lift.
//
//   1. The first block that is faulty: by the axes and their collisions (trial.h), by neck, shank and holder
//      in the material, by a gouge beyond [accept] where there is a design.
//   2. Its end is changed: lead and tilt to either side, in bands of kBandDeg one after the other up to
//      kLeanMostDeg, until everything up to this block is free in one; then bisected to kResolutionDeg, and
//      the least is taken. Angles at which the machine cannot stand, whatever solution its axes take, are
//      left out at once; of the ranges between them that are at least kStandDeg wide each is tried. Where
//      none frees it: lift, doubled and bisected. A gouge is lifted first, by twice its depth at most. Where
//      its end alone does not help: with its start, with the block behind it.
//   3. Again from 1., until the whole program is free. So the change of a block takes those before it as
//      given, and the blocks back to the CAM system's own axis are looked at like the others.
//
// Every look is the whole check over the whole motion, not of poses: what is advised is what has been proven.
// Gouges are looked for on the rays, and proven between them once nothing else is found. A free range
// narrower than a band may be passed over where what blocks its sides is met on the way, or is material. A
// block is tried with the change of the one before it first, and takes it where less does not do.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "avoidance/control.h"
#include "avoidance/path_change.h"

namespace swarf::avoidance {

/// A position that is changed.
struct BlockChange {
  int line = 0;
  PathChange change;
  ToolPose before, after;  ///< W
  std::string frees;       ///< the fault that it was first changed for
};

struct Advice {
  bool free = false;                ///< the program with the changes is
  std::vector<BlockChange> blocks;  ///< in the order of the file
  std::string text;                 ///< the CL data with them
  std::optional<Failure> left;      ///< what no change frees
  size_t looks = 0;                 ///< programs that were looked at

  static constexpr double kLeanMostDeg = 45.0, kResolutionDeg = 0.002;
  /// Width of a band: for what machine, tool and fixtures meet; for gouges, where a look cuts the whole part.
  static constexpr double kBandDeg = 1.0, kGougeBandDeg = 5.0;
  static constexpr double kStandDeg = 0.1;
  static constexpr double kLiftStepMm = 0.25, kLiftMostMm = 64.0, kLiftResolutionMm = 5e-4;
};

/// For the clamping and tools of the outcome: the best ones, or those that came farthest. A stopped search
/// leaves `free` false. Throws InputError "block-fixed" as program::rewrite_cl() does.
Advice advise(const Task& task, const Outcome& outcome, Progress& progress);

}  // namespace swarf::avoidance
