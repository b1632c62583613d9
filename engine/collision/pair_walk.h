// One pair of bodies over a stretch of poses. Internal to this folder.
#pragma once

#include "collision/path_check.h"

namespace swarf::collision {

/// What the check keeps of a cycle.
struct PathPose {
  AxisValues q = AxisValues::Zero();
  double time_s = 0.0;
  uint64_t cycle = 0;
  int element = 0, tool = 0;
};

/// Poses that follow each other with one tool; a single one where a tool makes no more.
using PathStretch = std::span<const PathPose>;

/// What a stretch says about a pair.
struct StretchFindings {
  NearMiss near_miss;                  ///< bounds of this stretch; `within`: below what was known before
  std::vector<ContactEvent> contacts;  ///< in their order
  bool starts_touching = false;  ///< the first contact holds on the first way; the last on the last one:
  bool ends_touching = false;
};

/// What is known before.
struct PairHistory {
  double least = 0.0;  ///< the limit, or the least distance of earlier stretches, mm
  PrimitivePair hint;
};

StretchFindings walk_stretch(const Encounter& pair, const BodyDepth& in_a, const BodyDepth& in_b,
                             PathStretch poses, const PathCheckOptions& options, const PairHistory& before);

}  // namespace swarf::collision
