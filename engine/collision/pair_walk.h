// One pair of bodies over a stretch of poses. Internal to this folder.
#pragma once

#include <optional>

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

/// What is known of the way from one cycle to the next.
enum class Way : uint8_t {
  kFree,     ///< the surfaces do not touch
  kTouches,  ///< they do, or are not proven not to
  kInside,   ///< free, and one body is wholly inside the other
};

/// What a stretch says about the surfaces of a pair.
struct StretchWalk {
  NearMiss near_miss;     ///< bounds of this stretch; `within`: below what was known before
  std::vector<Way> ways;  ///< at least one
};

/// What is known before.
struct PairHistory {
  double least = 0.0;  ///< the limit, or the least distance of earlier stretches, mm
  PrimitivePair hint;
};

StretchWalk walk_stretch(const Encounter& pair, PathStretch poses, const PathCheckOptions& options,
                         const PairHistory& before);

/// Where the surfaces do not touch over some ways, one look says whether one body is inside the other. The
/// way before the stretch, if its end is where this one starts, spares the first look.
void look_inside(const Encounter& pair, PathStretch poses, std::optional<Way> before, std::vector<Way>& ways);

/// The contacts in their order: ways that follow each other and are not free. `depth_budget`: of
/// depth_over(), for each.
std::vector<ContactEvent> contacts_of(const Encounter& pair, const BodyDepth& in_a, const BodyDepth& in_b,
                                      PathStretch poses, const PathCheckOptions& options,
                                      const std::vector<Way>& ways, size_t depth_budget);

}  // namespace swarf::collision
