#include "collision/path_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/check.h"
#include "base/parallel.h"
#include "collision/free_range.h"

namespace swarf::collision {
namespace {

constexpr size_t kStretch = 1024;         // ways
constexpr double kStands = 1e-6;          // mm, rad
constexpr size_t kBatch = 16 * kStretch;  // ways

/// Pieces that a contact's depth may take in a stretch: of the first contacts of a pair, and of all others.
constexpr size_t kDepthPieces = 8192, kDepthPiecesMany = 256, kDeepContacts = 64;

void check_path_options(const PathCheckOptions& options) {
  const auto bad = [](const char* name, double value) {
    if (value > 0.0 && value < 1e6) return;
    throw InputError("bad-options", {}, fmt::format("{} of the collision check is {} mm", name, value),
                     "give a number of mm above 0");
  };
  bad("the near-miss limit", options.near_miss_mm);
  bad("the tolerance", options.tolerance_mm);
  bad("the gap that counts as contact", options.touch_mm);
  for (const NearMissRule& rule : options.rules.watched)
    bad("the near-miss limit of a pair", rule.near_miss_mm);
}

/// A stretch as indices of its first and last pose.
struct StretchRange {
  size_t first, last;
};

std::vector<StretchRange> stretches_of(const std::vector<PathPose>& poses, size_t last_pose) {
  std::vector<StretchRange> ranges;
  for (size_t first = 0; first <= last_pose;) {
    size_t last = first;
    while (last < last_pose && last - first < kStretch && poses[last + 1].tool == poses[first].tool) ++last;
    ranges.push_back({first, last});
    const bool tool_stays = last < last_pose && poses[last + 1].tool == poses[last].tool;
    first = tool_stays ? last : last + 1;
  }
  return ranges;
}

bool is_there(const Body& body, int tool) {
  return body.tool < 0 || body.tool == tool;
}

void merge_near(NearMiss& all, const NearMiss& found) {
  const double lower = std::min(all.lower, found.lower);
  if (found.within && found.upper < all.upper) all = found;
  all.lower = lower;
}

void join_events(ContactEvent& event, const ContactEvent& later) {
  event.last_cycle = later.last_cycle;
  event.last_element = later.last_element;
  event.depth_bound_mm = std::max(event.depth_bound_mm, later.depth_bound_mm);
  if (later.depth_mm <= event.depth_mm) return;
  event.depth_mm = later.depth_mm;
  event.deepest_M = later.deepest_M;
  event.deepest_cycle = later.deepest_cycle;
}

}  // namespace

/// A pair and what has been found of it so far.
struct WatchedPair {
  Encounter encounter;
  PairFindings findings;
  PrimitivePair hint;
  FreeRange free;
  std::optional<Way> last;  ///< the last way that has been seen
  uint64_t end_cycle = 0;   ///< number of the last pose that has been seen
};

namespace {

/// A pair over a stretch.
struct StretchVisit {
  PathStretch poses;
  bool watched = false;  ///< both bodies are there
  bool open = false;     ///< not known to be free at once
  bool joins = false;    ///< its first contact goes on where the stretch before ends
  StretchWalk walk;      ///< of an open one
  std::vector<ContactEvent> contacts;
};

/// Distances from here on do not matter.
double asked_of(const WatchedPair& pair, const PathCheckOptions& options) {
  return std::max(pair.findings.near_miss.upper, 2.0 * options.touch_mm);
}

/// In the order of the stretches, for what is inside stays inside until the surfaces touch.
void follow_inside(WatchedPair& pair, StretchVisit& visit) {
  const bool follows = pair.last && pair.end_cycle == visit.poses.front().cycle;
  if (visit.open)
    look_inside(pair.encounter, visit.poses, follows ? pair.last : std::nullopt, visit.walk.ways);
  visit.joins = visit.open && follows && *pair.last != Way::kFree && visit.walk.ways.front() != Way::kFree;
  pair.last = visit.open ? visit.walk.ways.back() : Way::kFree;
  pair.end_cycle = visit.poses.back().cycle;
}

void merge_visit(WatchedPair& pair, const StretchVisit& visit) {
  merge_near(pair.findings.near_miss, visit.walk.near_miss);
  if (visit.walk.near_miss.within) pair.hint = visit.walk.near_miss.pair;
  PairFindings& all = pair.findings;
  for (size_t i = 0; i < visit.contacts.size(); ++i) {
    const ContactEvent& one = visit.contacts[i];
    const bool is_kept = all.spans.size() <= PathCheck::kEventsMost;
    if (i == 0 && visit.joins) {
      if (is_kept) join_events(all.contacts.back(), one);
      all.spans.back().last = one.last_cycle;
      continue;
    }
    if (all.spans.size() < PathCheck::kEventsMost) all.contacts.push_back(one);
    all.spans.push_back({one.first.cycle, one.last_cycle});
  }
}

}  // namespace

struct PathCheck::State {
  std::vector<WatchedPair> pairs;
  std::vector<BodyDepth> depths;  ///< by body
  std::vector<LeftOutPair> left_out;
  std::vector<PathPose> poses;  ///< the first one has been looked at, but for the start
  std::vector<int> unseen_changes;
  uint64_t cycles = 0;
  bool begun = false;

  void look_at_change(const motion::Cycle& next);

  PathStretch stretch(const StretchRange& range) const {
    return PathStretch(poses).subspan(range.first, range.last - range.first + 1);
  }
  void look_at_open(std::vector<StretchVisit>& visits, size_t stretches, const PathCheckOptions& options);
};

void PathCheck::State::look_at_change(const motion::Cycle& next) {
  if (poses.empty() || poses.back().tool == next.sample.tool) return;
  const bool stands = (poses.back().q - next.q).cwiseAbs().maxCoeff() <= kStands;
  if (!stands && unseen_changes.size() < kEventsMost) unseen_changes.push_back(next.sample.element);
}

/// What is not known to be free, in parallel by stretches; whether one body is inside the other by pairs.
void PathCheck::State::look_at_open(std::vector<StretchVisit>& visits, size_t stretches,
                                    const PathCheckOptions& options) {
  std::vector<size_t> open;
  for (size_t i = 0; i < visits.size(); ++i)
    if (visits[i].open) open.push_back(i);
  parallel_chunks(open.size(), 1, [&](size_t n, size_t) {
    StretchVisit& visit = visits[open[n]];
    const WatchedPair& pair = pairs[open[n] / stretches];
    visit.walk =
        walk_stretch(pair.encounter, visit.poses, options, {pair.findings.near_miss.upper, pair.hint});
  });
  parallel_chunks(pairs.size(), 1, [&](size_t p, size_t) {
    for (size_t i = p * stretches; i < (p + 1) * stretches; ++i)
      if (visits[i].watched) follow_inside(pairs[p], visits[i]);
  });
  parallel_chunks(open.size(), 1, [&](size_t n, size_t) {
    StretchVisit& visit = visits[open[n]];
    const WatchedPair& pair = pairs[open[n] / stretches];
    visit.contacts = contacts_of(
        pair.encounter, depths[pair.findings.a], depths[pair.findings.b], visit.poses, options,
        visit.walk.ways, pair.findings.spans.size() < kDeepContacts ? kDepthPieces : kDepthPiecesMany);
  });
}

PathCheck::PathCheck(const machine::MachineScene& scene, std::vector<Body> bodies,
                     const PathCheckOptions& options, Diagnostics& diagnostics)
    : scene_(scene), bodies_(std::move(bodies)), options_(options), state_(std::make_unique<State>()) {
  check_path_options(options_);
  PairChoice choice = choose_pairs(scene_, bodies_, options_.rules, options_.touch_mm, diagnostics);
  state_->left_out = std::move(choice.left_out);
  for (const Body& body : bodies_) state_->depths.emplace_back(body);
  for (const auto& [a, b] : choice.watched) {
    WatchedPair pair{encounter(scene_, bodies_[a], bodies_[b]), {}, {}, {}, {}, 0};
    pair.findings.a = a;
    pair.findings.b = b;
    const NearMissRule* const rule = options_.rules.near_miss_of(bodies_[a].name, bodies_[b].name);
    pair.findings.near_miss.lower = pair.findings.near_miss.upper =
        rule == nullptr ? options_.near_miss_mm : rule->near_miss_mm;
    state_->pairs.push_back(std::move(pair));
  }
}

PathCheck::~PathCheck() = default;

void PathCheck::add(std::span<const motion::Cycle> window) {
  for (const motion::Cycle& cycle : window) {
    state_->look_at_change(cycle);
    state_->poses.push_back(
        {cycle.q, cycle.sample.t_s, cycle.number, cycle.sample.element, cycle.sample.tool});
    ++state_->cycles;
    if (state_->poses.size() > kBatch) check_batch();
  }
}

/// All poses there are; the last one is where the next batch starts.
void PathCheck::check_batch() {
  State& state = *state_;
  const std::vector<StretchRange> ranges = stretches_of(state.poses, state.poses.size() - 1);
  std::vector<AxisBox> boxes;
  for (const StretchRange& range : ranges) boxes.push_back(box_of(state.stretch(range)));
  const size_t pairs = state.pairs.size(), stretches = ranges.size();
  std::vector<StretchVisit> visits(pairs * stretches);  // those of a pair stand together
  parallel_chunks(pairs, 1, [&](size_t p, size_t) {
    WatchedPair& pair = state.pairs[p];
    for (size_t i = 0; i < stretches; ++i) {
      StretchVisit& visit = visits[p * stretches + i];
      visit.poses = state.stretch(ranges[i]);
      const int tool = visit.poses.front().tool;
      visit.watched = is_there(*pair.encounter.a, tool) && is_there(*pair.encounter.b, tool);
      visit.open = visit.watched && !pair.free.covers(pair.encounter, boxes[i], asked_of(pair, options_),
                                                      options_.tolerance_mm);
    }
  });
  state.look_at_open(visits, stretches, options_);
  for (size_t i = 0; i < visits.size(); ++i)
    if (visits[i].open) merge_visit(state.pairs[i / stretches], visits[i]);
  state.poses.erase(state.poses.begin(), state.poses.end() - 1);
  state.begun = true;
}

PathFindings PathCheck::finish() {
  State& state = *state_;
  if (!state.poses.empty() && (state.poses.size() > 1 || !state.begun)) check_batch();
  PathFindings findings;
  for (WatchedPair& pair : state.pairs) findings.pairs.push_back(std::move(pair.findings));
  findings.left_out = std::move(state.left_out);
  findings.unseen_changes = std::move(state.unseen_changes);
  findings.cycles = state.cycles;
  return findings;
}

}  // namespace swarf::collision
