// All pairs of bodies over all cycles of a program: least distances and contacts, between the cycles too.
//
//   Cycle window --> add() --> batches of poses --> chunks x pairs, in parallel --> merged in their order
//
// Over a stretch of cycles the axes lie within a stray of the straight line from its first to its last cycle.
// One search over that line (closest_approach.h) clears the stretch when its lower bound is above what is
// asked: the near-miss limit, or the least distance so far. Otherwise it is halved, down to the way from one
// cycle to the next, on which the axes go straight. So whatever comes nearer is found, wherever it lies.
// Memory does not grow with the program, but for the contacts: kEventsMost a pair are kept, of the others
// only their cycles.
#pragma once

#include <cstdint>
#include <span>

#include "collision/body_pairs.h"
#include "collision/containment.h"
#include "motion/tool_sample.h"

namespace swarf::collision {

struct PathCheckOptions {
  double near_miss_mm = 10.0;  ///< distances below it are told, but for pairs with a rule; above 0
  double tolerance_mm = 2e-3;  ///< between the bounds of a least distance; above 0
  double touch_mm = 1e-4;      ///< gaps of this or less are contacts; above 0
  PairRules rules;             ///< of single pairs
};

/// A place on the way from one cycle to the next.
struct PathPlace {
  uint64_t cycle = 0;  ///< number of the first of both
  double share = 0.0;  ///< of the way
  double time_s = 0.0;
  int element = 0;  ///< of the second of both, which is the one that moves
};

/// Least distance of a pair over the program.
struct NearMiss {
  bool within = false;  ///< below the limit; else `lower` alone means something
  double lower = 0.0;   ///< mm; proven: at no instant is it less
  double upper = 0.0;   ///< mm; of the points below
  PathPlace place;
  Vec3 point_a = Vec3::Zero(), point_b = Vec3::Zero();  ///< in M
  PrimitivePair pair;
};

/// Cycles that follow each other, on the way between all of which the pair touches.
struct ContactEvent {
  PathPlace first;  ///< where it is proven to touch; before `free` it does not
  PathPlace free;   ///< at most .01 mm of travel earlier
  Vec3 point_a = Vec3::Zero(), point_b = Vec3::Zero();  ///< in M, at `first`
  uint64_t last_cycle = 0;  ///< number of the cycle behind the last way on which it touches
  int first_element = 0, last_element = 0;
  bool inside = false;  ///< one body lies wholly inside the other at the start, or all the while
  /// Deepest point of one body's surface in the other that was found, and what none lies deeper than over all
  /// these ways (overlap_bound.h). Nothing lies in an open mesh.
  double depth_mm = 0.0, depth_bound_mm = 0.0;
  Vec3 deepest_M = Vec3::Zero();
  uint64_t deepest_cycle = 0;
};

/// Numbers of cycles: a contact on every way from the first to the last one; at the first where both are
/// equal.
struct CycleSpan {
  uint64_t first = 0, last = 0;
};

struct PairFindings {
  size_t a = 0, b = 0;  ///< indices into the bodies
  NearMiss near_miss;
  std::vector<ContactEvent> contacts;  ///< the first ones
  std::vector<CycleSpan> spans;        ///< of all of them
  uint64_t contact_count() const { return spans.size(); }
};

struct PathFindings {
  std::vector<PairFindings> pairs;  ///< those that are watched
  /// Elements before which a tool is changed at another place of the axes than the one where the element
  /// begins: no way there is part of the program, none is looked at. The first kEventsMost.
  std::vector<int> unseen_changes;
  std::vector<LeftOutPair> left_out;
  uint64_t cycles = 0;
};

/// Takes the cycles of a program in their order. Results are the same bits for any number of threads and any
/// division into windows. Changes of the tool are no motion (cycle_stream.h): where the axes do not stand
/// still over one, the way is not looked at (PathFindings::unseen_changes).
class PathCheck {
 public:
  static constexpr size_t kEventsMost = 1000;

  /// `scene` must outlive it. Warnings of choose_pairs() go to `diagnostics`; throws InputError
  /// "unknown-body" and "bad-options".
  PathCheck(const machine::MachineScene& scene, std::vector<Body> bodies, const PathCheckOptions& options,
            Diagnostics& diagnostics);
  ~PathCheck();
  PathCheck(const PathCheck&) = delete;
  PathCheck& operator=(const PathCheck&) = delete;

  void add(std::span<const motion::Cycle> window);
  /// Nothing may be added afterwards.
  PathFindings finish();

  const std::vector<Body>& bodies() const { return bodies_; }

 private:
  struct State;
  void check_batch();

  const machine::MachineScene& scene_;
  std::vector<Body> bodies_;
  PathCheckOptions options_;
  std::unique_ptr<State> state_;
};

}  // namespace swarf::collision
