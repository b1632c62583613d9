#include "collision/path_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/check.h"
#include "base/parallel.h"
#include "collision/pair_walk.h"

namespace swarf::collision {
namespace {

constexpr size_t kStretch = 1024;         // ways
constexpr size_t kBatch = 16 * kStretch;  // ways

void check_path_options(const PathCheckOptions& options) {
  const auto bad = [](const char* name, double value) {
    if (value > 0.0 && value < 1e6) return;
    throw InputError("bad-options", {}, fmt::format("{} of the collision check is {} mm", name, value),
                     "give a number of mm above 0");
  };
  bad("the near-miss limit", options.near_miss_mm);
  bad("the tolerance", options.tolerance_mm);
  bad("the gap that counts as contact", options.touch_mm);
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
  bool touching = false;   ///< at the end of what has been seen
  uint64_t end_cycle = 0;  ///< number of the last pose that has been seen
};

namespace {

void merge_stretch(WatchedPair& pair, const StretchFindings& found, PathStretch poses) {
  const bool follows = pair.touching && found.starts_touching && pair.end_cycle == poses.front().cycle;
  merge_near(pair.findings.near_miss, found.near_miss);
  if (found.near_miss.within) pair.hint = found.near_miss.pair;
  std::vector<ContactEvent>& kept = pair.findings.contacts;
  for (size_t i = 0; i < found.contacts.size(); ++i) {
    const bool joins = i == 0 && follows;
    const bool is_kept = pair.findings.contact_count <= PathCheck::kEventsMost;
    if (joins && is_kept) join_events(kept.back(), found.contacts[i]);
    if (joins) continue;
    if (pair.findings.contact_count++ < PathCheck::kEventsMost) kept.push_back(found.contacts[i]);
  }
  pair.touching = found.ends_touching;
  pair.end_cycle = poses.back().cycle;
}

}  // namespace

struct PathCheck::State {
  std::vector<WatchedPair> pairs;
  std::vector<BodyDepth> depths;  ///< by body
  std::vector<LeftOutPair> left_out;
  std::vector<PathPose> poses;  ///< the first one has been looked at, but for the start
  uint64_t cycles = 0;
  bool begun = false;
};

PathCheck::PathCheck(const machine::MachineScene& scene, std::vector<Body> bodies,
                     const PathCheckOptions& options, Diagnostics& diagnostics)
    : scene_(scene), bodies_(std::move(bodies)), options_(options), state_(std::make_unique<State>()) {
  check_path_options(options_);
  PairChoice choice = choose_pairs(scene_, bodies_, options_.allowed, options_.touch_mm, diagnostics);
  state_->left_out = std::move(choice.left_out);
  for (const Body& body : bodies_) state_->depths.emplace_back(body);
  for (const auto& [a, b] : choice.watched) {
    WatchedPair pair{encounter(scene_, bodies_[a], bodies_[b]), {}, {}, false, 0};
    pair.findings.a = a;
    pair.findings.b = b;
    pair.findings.near_miss.lower = pair.findings.near_miss.upper = options_.near_miss_mm;
    state_->pairs.push_back(std::move(pair));
  }
}

PathCheck::~PathCheck() = default;

void PathCheck::add(std::span<const motion::Cycle> window) {
  for (const motion::Cycle& cycle : window) {
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
  const size_t pairs = state.pairs.size();
  std::vector<StretchFindings> found(ranges.size() * pairs);
  const auto poses_of = [&](const StretchRange& range) {
    return PathStretch(state.poses).subspan(range.first, range.last - range.first + 1);
  };
  const auto watched = [&](const WatchedPair& pair, const StretchRange& range) {
    const int tool = state.poses[range.first].tool;
    return is_there(*pair.encounter.a, tool) && is_there(*pair.encounter.b, tool);
  };
  parallel_chunks(found.size(), 1, [&](size_t i, size_t) {
    const WatchedPair& pair = state.pairs[i % pairs];
    const StretchRange& range = ranges[i / pairs];
    if (!watched(pair, range)) return;
    found[i] = walk_stretch(pair.encounter, state.depths[pair.findings.a], state.depths[pair.findings.b],
                            poses_of(range), options_, {pair.findings.near_miss.upper, pair.hint});
  });
  for (size_t i = 0; i < found.size(); ++i) {
    if (watched(state.pairs[i % pairs], ranges[i / pairs])) {
      merge_stretch(state.pairs[i % pairs], found[i], poses_of(ranges[i / pairs]));
    }
  }
  state.poses.erase(state.poses.begin(), state.poses.end() - 1);
  state.begun = true;
}

PathFindings PathCheck::finish() {
  State& state = *state_;
  if (!state.poses.empty() && (state.poses.size() > 1 || !state.begun)) check_batch();
  PathFindings findings;
  for (WatchedPair& pair : state.pairs) findings.pairs.push_back(std::move(pair.findings));
  findings.left_out = std::move(state.left_out);
  findings.cycles = state.cycles;
  return findings;
}

}  // namespace swarf::collision
