#include "collision/pair_walk.h"

#include <algorithm>
#include <cmath>

#include "collision/overlap_bound.h"

namespace swarf::collision {
namespace {

constexpr size_t kFirstWays = 64;
constexpr uint64_t kLeastBudget = 64;  ///< triples that a search over several ways may split

/// From one pose of the stretch to another: the straight line, and how far the poses between lie off it at
/// most, each held against the place of the line that stands for its share of the way.
AxisSegment chord_of(PathStretch poses, size_t first, size_t last) {
  AxisSegment chord;
  chord.q0 = poses[first].q;
  chord.q1 = poses[last].q;
  for (size_t k = first + 1; k < last; ++k) {
    const double share = static_cast<double>(k - first) / static_cast<double>(last - first);
    chord.stray = chord.stray.cwiseMax((poses[k].q - chord.at(share)).cwiseAbs());
  }
  return chord;
}

PathPlace place_on(PathStretch poses, size_t way, double share) {
  const PathPose& from = poses[way];
  const PathPose& to = poses[std::min(way + 1, poses.size() - 1)];
  return {from.cycle, share, from.time_s + share * (to.time_s - from.time_s), to.element};
}

class PairWalk {
 public:
  PairWalk(const Encounter& pair, PathStretch poses, const PathCheckOptions& options,
           const PairHistory& before)
      : pair_(pair),
        poses_(poses),
        options_(options),
        hint_(before.hint),
        ways_(std::max<size_t>(1, poses.size() - 1), Way::kFree) {
    near_.lower = near_.upper = before.least;
  }

  void run() {
    // Ways at once: twice as many after those that one search has cleared, else half as many.
    size_t at_once = kFirstWays;
    const size_t last = poses_.size() - 1;
    for (size_t first = 0, to = 0; first == 0 || first < last; first = std::max<size_t>(to, 1)) {
      to = std::min(first + at_once, last);
      at_once = visit(first, to) ? 2 * at_once : std::max<size_t>(1, at_once / 2);
    }
  }
  StretchWalk found() && { return {near_, std::move(ways_)}; }

 private:
  /// Distances from here on do not matter, but for contacts.
  double asked() const { return std::max(near_.upper, 2.0 * options_.touch_mm); }

  Approach search(const AxisSegment& segment, double limit, uint64_t budget = UINT64_MAX) const {
    ApproachQuery query;
    query.limit = limit;
    query.tolerance = std::min(options_.tolerance_mm, limit - options_.touch_mm);
    query.enough = options_.touch_mm;
    query.hint = &hint_;
    query.budget = budget;
    return closest_approach(pair_, segment, query);
  }

  void take_near(size_t way, const Approach& found) {
    if (found.upper >= near_.upper) return;
    near_ = {true,          near_.lower,   found.upper, place_on(poses_, way, found.t),
             found.point_a, found.point_b, found.pair};
  }

  /// Ways from pose `first` to pose `last`. A search over several is given up when it takes longer than those
  /// over each of them would. True: one search has cleared all of them.
  bool visit(size_t first, size_t last) {
    const size_t ways = last - first;
    const Approach found =
        search(chord_of(poses_, first, last), asked(), ways <= 1 ? UINT64_MAX : kLeastBudget + 4 * ways);
    if (!found.within && !found.given_up && found.lower > options_.touch_mm) {
      near_.lower = std::min(near_.lower, found.lower);
      return true;
    }
    if (found.within) hint_ = found.pair;
    if (ways <= 1) {
      settle_way(first, found);
      return false;
    }
    const size_t middle = (first + last) / 2;
    const auto nearest = first + static_cast<size_t>(std::lround(found.t * static_cast<double>(ways)));
    if (found.within) look_at_pose(nearest);
    // The half that comes nearest first, for its distance is what the other is held against.
    const bool late = nearest > middle;
    late ? visit(middle, last) : visit(first, middle);
    late ? visit(first, middle) : visit(middle, last);
    return false;
  }

  /// The way from one cycle to the next, on which the axes go straight. What is not proven to be free counts
  /// as contact.
  void settle_way(size_t way, const Approach& found) {
    if (found.within) take_near(way, found);
    double lower = found.lower;
    bool touches = found.within && found.upper <= options_.touch_mm;
    if (!touches && lower <= options_.touch_mm) {
      const size_t to = std::min(way + 1, poses_.size() - 1);
      const Approach sure = search(chord_of(poses_, way, to), 2.0 * options_.touch_mm);
      if (sure.within) take_near(way, sure);
      lower = sure.within ? sure.lower : std::max(lower, sure.lower);
      touches = (sure.within && sure.upper <= options_.touch_mm) || lower <= 0.0;
    }
    near_.lower = std::min(near_.lower, lower);
    if (touches) ways_[way] = Way::kTouches;
  }

  /// A distance that is known to occur, from the two primitives that came nearest on the chord.
  void look_at_pose(size_t at) {
    if (near_.upper <= options_.touch_mm) return;
    if (distance_at(pair_, poses_[at].q, hint_) >= near_.upper) return;
    AxisSegment still;
    still.q0 = still.q1 = poses_[at].q;
    const Approach found = search(still, asked());
    if (!found.within || found.upper >= near_.upper) return;
    const bool last = at >= ways_.size();
    take_near(last ? ways_.size() - 1 : at, found);
    if (last) near_.place = place_on(poses_, ways_.size() - 1, 1.0);
  }

  const Encounter& pair_;
  PathStretch poses_;
  const PathCheckOptions& options_;
  PrimitivePair hint_;
  NearMiss near_;
  std::vector<Way> ways_;
};

/// Ways `first` to `last` (included), all of which touch.
struct TouchingWays {
  size_t first, last;
};

ContactEvent begin_contact(const Encounter& pair, PathStretch poses, size_t way, bool inside,
                           const PathCheckOptions& options) {
  ContactEvent event;
  event.inside = inside;
  event.first = event.free = place_on(poses, way, 0.0);
  event.first_element = event.first.element;
  if (inside) return event;
  ContactQuery query;
  query.touch = options.touch_mm;
  const FirstContact found =
      first_contact(pair, chord_of(poses, way, std::min(way + 1, poses.size() - 1)), query);
  if (!found.touches) return event;  // by a rounding: the search over the way has found it at touch_mm itself
  event.first = place_on(poses, way, found.t_touch);
  event.free = place_on(poses, way, found.t_free);
  event.point_a = found.point_a;
  event.point_b = found.point_b;
  return event;
}

void look_how_deep(const Encounter& pair, const BodyDepth& in_a, const BodyDepth& in_b, PathStretch poses,
                   const TouchingWays& ways, size_t budget, ContactEvent& event) {
  const size_t last = std::min(ways.last + 1, poses.size() - 1);
  const DepthRange found = depth_over(pair, in_a, in_b, poses, ways.first, last, budget);
  event.depth_mm = found.seen_mm;
  event.depth_bound_mm = found.bound_mm;
  event.deepest_M = found.place_M;
  event.deepest_cycle = poses[static_cast<size_t>(found.at)].cycle;
}

}  // namespace

StretchWalk walk_stretch(const Encounter& pair, PathStretch poses, const PathCheckOptions& options,
                         const PairHistory& before) {
  PairWalk walk(pair, poses, options, before);
  walk.run();
  return std::move(walk).found();
}

void look_inside(const Encounter& pair, PathStretch poses, std::optional<Way> before,
                 std::vector<Way>& ways) {
  for (size_t k = 0; k < ways.size(); ++k) {
    if (ways[k] != Way::kFree) continue;
    size_t end = k;
    while (end < ways.size() && ways[end] == Way::kFree) ++end;
    const AxisValues q = chord_of(poses, k, std::min(k + 1, poses.size() - 1)).at(0.5);
    const bool goes_on = k == 0 && before && *before != Way::kTouches;
    if (goes_on ? *before == Way::kInside : one_holds_other(pair, q))
      std::fill(ways.begin() + static_cast<ptrdiff_t>(k), ways.begin() + static_cast<ptrdiff_t>(end),
                Way::kInside);
    k = end;
  }
}

std::vector<ContactEvent> contacts_of(const Encounter& pair, const BodyDepth& in_a, const BodyDepth& in_b,
                                      PathStretch poses, const PathCheckOptions& options,
                                      const std::vector<Way>& ways, size_t depth_budget) {
  std::vector<ContactEvent> contacts;
  for (size_t k = 0; k < ways.size(); ++k) {
    if (ways[k] == Way::kFree) continue;
    TouchingWays touching{k, k};
    while (touching.last + 1 < ways.size() && ways[touching.last + 1] != Way::kFree) ++touching.last;
    ContactEvent event = begin_contact(pair, poses, k, ways[k] == Way::kInside, options);
    const PathPlace end = place_on(poses, touching.last, 1.0);
    event.last_cycle = poses[std::min(touching.last + 1, poses.size() - 1)].cycle;
    event.last_element = end.element;
    look_how_deep(pair, in_a, in_b, poses, touching, depth_budget, event);
    contacts.push_back(event);
    k = touching.last;
  }
  return contacts;
}

}  // namespace swarf::collision
