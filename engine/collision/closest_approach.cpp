#include "collision/closest_approach.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "collision/space_time.h"

namespace swarf::collision {
namespace {

/// Spans over which nothing moves farther than this are split no more, mm: rounding is near.
constexpr double kLeastTravel = 1e-7;

struct FarthestFirst {
  bool operator()(const Triple& a, const Triple& b) const { return a.lower > b.lower; }
};

/// The search for the least distance: a heap of triples, the nearest on top.
class ApproachSearch {
 public:
  ApproachSearch(const Encounter& pair, const AxisSegment& segment, const ApproachQuery& query)
      : space_(pair, segment),
        query_(query),
        nearest_(query.limit),
        proven_(query.limit),
        strays_(!segment.stray.isZero(0.0)) {}

  Approach run() {
    open_.push_back(space_.root());
    if (query_.hint != nullptr) look_at_hint();
    while (!open_.empty() && nearest_ > query_.enough && !stopped_) {
      std::pop_heap(open_.begin(), open_.end(), FarthestFirst{});
      const Triple triple = open_.back();
      open_.pop_back();
      if (!is_open(triple.lower)) {
        settle(triple.lower);  // and all that are left are farther
        break;
      }
      if (spent_++ >= query_.budget) {
        settle(triple.lower);
        answer_.given_up = true;
        break;
      }
      space_.is_leaf_pair(triple) ? meet(triple) : divide(triple);
    }
    return answer();
  }

 private:
  bool is_open(double lower) const { return lower < nearest_ - query_.tolerance; }
  /// A bound below which nothing more will be looked for.
  void settle(double lower) { proven_ = std::min(proven_, lower); }

  void push(const Triple& triple) {
    if (!is_open(triple.lower)) return settle(triple.lower);
    open_.push_back(triple);
    std::push_heap(open_.begin(), open_.end(), FarthestFirst{});
  }

  void divide(const Triple& triple) {
    parts_.clear();
    space_.split(triple, parts_);
    for (const Triple& part : parts_) push(part);
  }

  void take(const LeafDistance& found, const PrimitivePair& pair) {
    if (found.upper >= nearest_) return;
    nearest_ = found.upper;
    best_ = found;
    answer_.pair = pair;
    answer_.within = true;
  }

  void meet(Triple triple) {
    const LeafDistance found = space_.leaf_distance(triple, nearest_ - query_.tolerance);
    triple.lower = std::max(triple.lower, found.lower);
    if (!is_open(triple.lower)) return settle(triple.lower);
    if (strays_) return meet_strayed(triple, found);
    take(found, space_.pair_of(triple));
    is_open(triple.lower) ? divide_time(triple) : settle(triple.lower);
  }

  /// Where the axes stray, no division brings the bounds together: as soon as the stray alone may take a
  /// distance below the limit, that is the answer.
  void meet_strayed(const Triple& triple, const LeafDistance& found) {
    const bool stray_decides = found.upper - found.stray < query_.limit - query_.tolerance;
    if (!stray_decides && found.sagitta > 0.1 * query_.tolerance) return divide_time(triple);
    stopped_ = answer_.within = true;
    best_ = found;
    answer_.pair = space_.pair_of(triple);
    nearest_ = found.upper;
    settle(triple.lower);
  }

  void divide_time(const Triple& triple) {
    if (space_.travel(triple.span) <= kLeastTravel) return settle(triple.lower);
    parts_.clear();
    space_.split_time(triple, parts_);
    for (const Triple& part : parts_) push(part);
  }

  void look_at_hint() {
    if (strays_) return;
    const bool a_moves = space_.a_moves();
    const uint32_t still = a_moves ? query_.hint->b : query_.hint->a;
    const uint32_t moving = a_moves ? query_.hint->a : query_.hint->b;
    take(space_.leaf_distance(still, moving, 0, nearest_), *query_.hint);
  }

  Approach answer() {
    for (const Triple& triple : open_) settle(triple.lower);
    answer_.lower = std::min(proven_, nearest_);
    if (!answer_.within) return answer_;
    answer_.upper = nearest_;
    answer_.t = best_.t;
    space_.tell_points(best_, answer_.point_a, answer_.point_b);
    return answer_;
  }

  SpaceTime space_;
  ApproachQuery query_;
  double nearest_;  ///< least upper bound so far, or the limit
  double proven_;   ///< nothing that has been settled comes nearer
  bool strays_, stopped_ = false;
  uint64_t spent_ = 0;  ///< triples that were split
  LeafDistance best_;
  Approach answer_;
  std::vector<Triple> open_, parts_;
};

/// Spans in the order of their beginning; of one beginning the nearest first.
struct LatestFirst {
  const SpaceTime* space;
  bool operator()(const Triple& a, const Triple& b) const {
    const double one = space->span(a.span).t0, other = space->span(b.span).t0;
    return one != other ? one > other : a.lower > b.lower;
  }
};

/// The search for the first contact: a heap of triples, the earliest on top. What has left the heap is free
/// of contact, so that the beginning of the one on top is proven.
class ContactSearch {
 public:
  ContactSearch(const Encounter& pair, const AxisSegment& segment, const ContactQuery& query)
      : space_(pair, segment), query_(query) {}

  FirstContact run() {
    push(space_.root());
    while (!open_.empty() && !answer_.touches) {
      std::pop_heap(open_.begin(), open_.end(), LatestFirst{&space_});
      const Triple triple = open_.back();
      open_.pop_back();
      space_.is_leaf_pair(triple) ? meet(triple) : divide(triple);
    }
    return answer_;
  }

 private:
  void push(const Triple& triple) {
    if (triple.lower > query_.touch) return;
    if (space_.span(triple.span).t0 > known_) return;
    open_.push_back(triple);
    std::push_heap(open_.begin(), open_.end(), LatestFirst{&space_});
  }

  void divide(const Triple& triple) {
    parts_.clear();
    space_.split(triple, parts_);
    for (const Triple& part : parts_) push(part);
  }

  void meet(const Triple& triple) {
    const LeafDistance found = space_.leaf_distance(triple, query_.touch);
    if (found.lower > query_.touch) return;
    if (found.upper <= query_.touch) known_ = std::min(known_, found.t);
    const double travel = space_.travel(triple.span);
    if (travel <= query_.travel && found.upper <= query_.touch) return tell(triple, found);
    if (travel <= kLeastTravel) return tell(triple, found);
    parts_.clear();
    space_.split_time(triple, parts_);
    for (const Triple& part : parts_) push(part);
  }

  void tell(const Triple& triple, const LeafDistance& found) {
    answer_.touches = true;
    answer_.t_free = space_.span(triple.span).t0;
    answer_.t_touch = found.t;
    answer_.gap = found.upper;
    answer_.pair = space_.pair_of(triple);
    space_.tell_points(found, answer_.point_a, answer_.point_b);
  }

  SpaceTime space_;
  ContactQuery query_;
  double known_ = std::numeric_limits<double>::infinity();  ///< at this instant they touch
  FirstContact answer_;
  std::vector<Triple> open_, parts_;
};

bool empty(const Encounter& pair) {
  return pair.a->nodes.empty() || pair.b->nodes.empty();
}

}  // namespace

Encounter encounter(const machine::MachineScene& scene, const Body& a, const Body& b) {
  return {&scene, &a, &b, RelativeMotion(scene, a.link, b.link), RelativeMotion(scene, b.link, a.link)};
}

Approach closest_approach(const Encounter& pair, const AxisSegment& segment, const ApproachQuery& query) {
  SWARF_CHECK(query.tolerance > 0.0, "distances are known to within a tolerance");
  if (empty(pair)) return {};
  return ApproachSearch(pair, segment, query).run();
}

double distance_at(const Encounter& pair, const AxisValues& q, const PrimitivePair& primitives) {
  const Pose pose = pair.b_from_a.pose(q);
  const ConvexView a = view_of(*pair.a, primitives.a), b = view_of(*pair.b, primitives.b, pose);
  return convex_distance(a, b, std::numeric_limits<double>::infinity()).upper;
}

FirstContact first_contact(const Encounter& pair, const AxisSegment& segment, const ContactQuery& query) {
  SWARF_CHECK(query.touch > 0.0 && query.travel > 0.0, "contacts are told to within a tolerance");
  SWARF_CHECK(segment.stray.isZero(0.0), "the first contact needs the axes themselves");
  if (empty(pair)) return {};
  return ContactSearch(pair, segment, query).run();
}

}  // namespace swarf::collision
