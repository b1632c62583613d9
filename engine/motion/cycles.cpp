#include "motion/cycles.h"

#include <algorithm>

#include "base/check.h"
#include "motion/block_motion.h"

namespace swarf::motion {
namespace {

/// At least so many cycles lie between two places.
constexpr uint64_t kPlaceApart = 50'000;

bool short_of(const Cycle& cycle, int element, double share) {
  return cycle.sample.element < element || (cycle.sample.element == element && cycle.sample.u < share);
}

void throw_if_invalid(const MotionOptions& options) {
  Diagnostics diagnostics;
  for (const std::string& problem : validate(options)) diagnostics.error("bad-options", {}, problem, "");
  diagnostics.throw_if_errors();
}

bool holds_blocks(std::span<const toolpath::Element> elements) {
  return !elements.empty() && std::holds_alternative<toolpath::BlockMove>(elements.front().what);
}

}  // namespace

Cycles::Cycles(std::span<const toolpath::Element> elements, std::span<const kinematics::MachineModel> by_tool,
               const cutter::Cutter& cutter, const MotionOptions& options, const LookAheadReach& reach)
    : elements_(elements),
      by_tool_(by_tool.begin(), by_tool.end()),
      inverses_(by_tool.begin(), by_tool.end()),
      cutter_(cutter),
      options_(options),
      reach_(reach) {
  throw_if_invalid(options);
  if (holds_blocks(elements_)) motions_ = block_motions(elements_, by_tool_);
}

CycleSource Cycles::source() const {
  return {elements_, motions_, by_tool_, inverses_, &cutter_, &options_, reach_};
}

void Cycles::walk(const std::function<void(std::span<const Cycle>)>& visit, Progress& progress) {
  SWARF_CHECK(size_ == 0, "the first pass is made once");
  progress.begin("interpolate", static_cast<double>(elements_.size()), "elements");
  CycleStream stream(source());
  places_.push_back(stream.place());
  std::vector<Cycle> window;
  while (!progress.stop_requested() && stream.next(window)) {
    visit(window);
    size_ += window.size();
    if (stream.place().cycle >= places_.back().cycle + kPlaceApart) places_.push_back(stream.place());
    progress.advance(static_cast<double>(window.back().sample.element));
  }
  progress.end();
}

const Cycle& CycleReader::at(size_t k) {
  SWARF_CHECK(k < cycles_->size(), "a cycle of the program");
  if (holds(k)) return window_[k - first_];
  const std::vector<CyclePlace>& places = cycles_->places();
  const auto after =
      std::upper_bound(places.begin(), places.end(), k,
                       [](size_t sought, const CyclePlace& place) { return sought < place.cycle; });
  const CyclePlace& nearest = *(after - 1);
  const size_t next = first_ + window_.size();
  if (!stream_ || k < next || nearest.cycle > next) start_from(nearest);
  while (!holds(k)) move_on();
  return window_[k - first_];
}

size_t CycleReader::reaching(int element, double share) {
  const std::vector<CyclePlace>& places = cycles_->places();
  const auto after = std::partition_point(places.begin() + 1, places.end(), [&](const CyclePlace& place) {
    return short_of(place.before, element, share);
  });
  const size_t low = (after - 1)->cycle;  // all before it are short of the place
  if (low >= cycles_->size()) return cycles_->size() - 1;
  const bool ahead = !window_.empty() && first_ > low && short_of(window_.front(), element, share);
  size_t k = ahead ? first_ : low;
  for (;;) {
    at(k);
    const auto found =
        std::partition_point(window_.begin() + static_cast<ptrdiff_t>(k - first_), window_.end(),
                             [&](const Cycle& cycle) { return short_of(cycle, element, share); });
    if (found != window_.end()) return first_ + static_cast<size_t>(found - window_.begin());
    const size_t next = first_ + window_.size();
    if (next >= cycles_->size()) return cycles_->size() - 1;
    k = next;
  }
}

void CycleReader::move_on() {
  first_ += window_.size();
  const bool more = stream_->next(window_);
  SWARF_CHECK(more, "the program has as many cycles as its first pass");
}

void CycleReader::start_from(const CyclePlace& place) {
  stream_ = std::make_unique<CycleStream>(cycles_->source(), place);
  window_.clear();
  first_ = place.cycle;
}

}  // namespace swarf::motion
