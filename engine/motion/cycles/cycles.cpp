#include "motion/cycles/cycles.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/check.h"
#include "base/parallel.h"
#include "motion/blocks/block_motions.h"

namespace swarf::motion {
namespace {

/// At least so many cycles lie between two places.
constexpr uint64_t kPlaceApart = 50'000;
/// A reader that goes far holds so many cycles before the sought one, for those who go back a little.
constexpr size_t kBefore = 1024;

bool short_of(const Cycle& cycle, int element, double share) {
  return cycle.sample.element < element || (cycle.sample.element == element && cycle.sample.u < share);
}

void throw_if_invalid(const MotionOptions& options) {
  Diagnostics diagnostics;
  for (const std::string& problem : validate(options)) diagnostics.error("bad-options", {}, problem, "");
  diagnostics.throw_if_errors();
}

}  // namespace

Cycles::Cycles(const toolpath::Elements& elements, std::span<const kinematics::MachineModel> by_tool,
               const cutter::Cutter& cutter, const MotionOptions& options, const CycleLimits& limits)
    : elements_(elements),
      by_tool_(by_tool.begin(), by_tool.end()),
      inverses_(by_tool.begin(), by_tool.end()),
      cutter_(cutter),
      options_(options),
      limits_(limits) {
  throw_if_invalid(options);
  if (elements_.hold_blocks()) motions_ = BlockMotions(elements_, by_tool_);
}

CycleSource Cycles::source() const {
  return {elements_, motions_, by_tool_, inverses_, &cutter_, &options_, limits_.reach};
}

void Cycles::add_to(Hash& hash, const Cycle& cycle) {
  for (const double q : cycle.q) hash.add(q);
  hash.add(cycle.sample.feed_mm_s);
  hash.add(static_cast<uint64_t>(cycle.sample.element));
}

void Cycles::recall(CycleRecall before) {
  SWARF_CHECK(size_ == 0 && before.checks.size() == before.places.size(), "a motion is recalled once");
  places_ = std::move(before.places);
  checks_ = std::move(before.checks);
  size_ = before.cycles;
  recalled_ = true;
}

/// The next window is made while the last one is visited, the next stretch planned while cycles are made.
void Cycles::walk(const std::function<void(std::span<const Cycle>)>& visit, Progress& progress) {
  SWARF_CHECK(size_ == 0, "the first pass is made once");
  progress.begin("interpolate", static_cast<double>(elements_.size()), "elements");
  CycleSource source = this->source();
  if (thread_count() > 1) source.plan_ahead = PlanAhead::kYes;
  CycleStream stream(source);
  places_.push_back(stream.place());
  kept_.reserve(limits_.kept);  // pages that are not written cost nothing; growing would move all of them
  std::vector<Cycle> window, ahead;
  bool more = !progress.stop_requested() && stream.next(window);
  while (more) {
    const CyclePlace place = stream.place();
    parallel_chunks(2, 1, [&](size_t i, size_t) {
      if (i == 0) take(window, place, visit);
      if (i == 1) more = !progress.stop_requested() && stream.next(ahead);
    });
    progress.advance(static_cast<double>(window.back().sample.element));
    window.swap(ahead);
  }
  stopped_ = progress.stop_requested();
  progress.end();
}

void Cycles::take(std::span<const Cycle> window, const CyclePlace& place,
                  const std::function<void(std::span<const Cycle>)>& visit) {
  visit(window);
  for (const Cycle& cycle : window) keep(cycle);
  check(window);
  size_ += window.size();
  if (place.cycle < places_.back().cycle + kPlaceApart) return;
  places_.push_back(place);
  check(window);
}

/// Of the last place, whose first cycles may lie in this window.
void Cycles::check(std::span<const Cycle> window) {
  const uint64_t first = places_.back().cycle;
  if (checks_.size() < places_.size()) {
    place_hash_ = {};
    checks_.push_back(place_hash_.value());
  }
  if (window.front().number >= first + kPlaceChecked) return;
  for (const Cycle& cycle : window) {
    if (cycle.number >= first && cycle.number < first + kPlaceChecked) add_to(place_hash_, cycle);
  }
  checks_.back() = place_hash_.value();
}

void Cycles::keep(const Cycle& cycle) {
  add_to(hash_, cycle);
  if (kept_.size() < limits_.kept) kept_.push_back(cycle);
  last_ = cycle;
  if (cycle.number % sparse_step_ != 0) return;
  sparse_.push_back(cycle);
  if (sparse_.size() < 2 * kSpreadLeast) return;
  for (size_t i = 1; 2 * i < sparse_.size(); ++i) sparse_[i] = sparse_[2 * i];
  sparse_.resize(kSpreadLeast);
  sparse_step_ *= 2;
}

std::vector<Cycle> Cycles::spread(size_t count) const {
  std::vector<Cycle> spread;
  for (size_t i = 0; i < std::min(count, size_); ++i) {
    const size_t k = count == 1 ? 0 : (size_ - 1) * i / (std::min(count, size_) - 1);
    spread.push_back(k < kept_.size() ? kept_[k]
                     : k + 1 == size_ ? last_
                                      : sparse_[std::min(k / sparse_step_, sparse_.size() - 1)]);
  }
  return spread;
}

const Cycle& CycleReader::at(size_t k) {
  SWARF_CHECK(k < cycles_->size(), "a cycle of the program");
  if (k < cycles_->kept().size()) return cycles_->kept()[k];
  if (holds(k)) return window_[k - first_];
  const std::vector<CyclePlace>& places = cycles_->places();
  const auto after =
      std::upper_bound(places.begin(), places.end(), k,
                       [](size_t sought, const CyclePlace& place) { return sought < place.cycle; });
  const size_t next = first_ + window_.size();
  if (!stream_ || k < next || (after - 1)->cycle > next)
    start_from(static_cast<size_t>(after - 1 - places.begin()));
  if (k >= first_ + window_.size() + CycleStream::kWindow) pass_to(k - kBefore);
  while (!holds(k)) move_on();
  return window_[k - first_];
}

size_t CycleReader::reaching(int element, double share) {
  const auto is_short = [&](const Cycle& cycle) { return short_of(cycle, element, share); };
  const std::span<const Cycle> kept = cycles_->kept();
  if (!kept.empty() && !is_short(kept.back()))
    return static_cast<size_t>(std::partition_point(kept.begin(), kept.end(), is_short) - kept.begin());
  const std::vector<CyclePlace>& places = cycles_->places();
  const auto after = std::partition_point(places.begin() + 1, places.end(),
                                          [&](const CyclePlace& place) { return is_short(place.before); });
  // All cycles before these are short of the place.
  size_t k = std::max<size_t>((after - 1)->cycle, kept.size());
  if (!window_.empty() && first_ > k && is_short(window_.front())) k = first_;
  while (k < cycles_->size()) {
    at(k);
    const auto from = window_.begin() + static_cast<ptrdiff_t>(k - first_);
    const auto found = std::partition_point(from, window_.end(), is_short);
    if (found != window_.end()) return first_ + static_cast<size_t>(found - window_.begin());
    k = first_ + window_.size();
  }
  return cycles_->size() - 1;
}

void CycleReader::move_on() {
  first_ += window_.size();
  const bool more = stream_->next(window_);
  SWARF_CHECK(more, "the program has as many cycles as its first pass");
}

void CycleReader::start_from(size_t place) {
  stream_ = std::make_unique<CycleStream>(cycles_->source(), cycles_->places()[place]);
  window_.clear();
  first_ = cycles_->places()[place].cycle;
  if (cycles_->recalled_checks().empty()) return;
  move_on();
  Hash hash;
  for (size_t i = 0; i < std::min<size_t>(kPlaceChecked, window_.size()); ++i)
    Cycles::add_to(hash, window_[i]);
  if (hash.value() == cycles_->recalled_checks()[place]) return;
  throw InputError("run-differs", {"the kept motion"},
                   fmt::format("from {:.3f} s on it is not the one that was run: its inputs were changed, or "
                               "this is another version of swarf",
                               window_.front().sample.t_s),
                   "run the scene again");
}

void CycleReader::pass_to(size_t k) {
  stream_->pass_to(k);
  window_.clear();
  first_ = k;
}

}  // namespace swarf::motion
