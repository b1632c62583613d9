#include "sim/run/sweep_places.h"

#include <algorithm>

#include "stock/contact/contact_finder.h"

namespace swarf::sim {
namespace {

constexpr double kLever = 50.0;  // mm: what a turn counts beside a way of the tip
constexpr double kSameT = 1e-9;  // of a sweep: rounding

}  // namespace

double SweepPlaces::progress(const stock::Sweep& sweep, const ToolPose& pose) const {
  const Vec3 way = sweep.end.tip_W - sweep.start.tip_W;
  const Vec3 turn = kLever * (sweep.end.axis_W - sweep.start.axis_W);
  const double length2 = way.squaredNorm() + turn.squaredNorm();
  if (length2 <= 0.0) return 1.0;
  return (way.dot(pose.tip_W - sweep.start.tip_W) + turn.dot(kLever * (pose.axis_W - sweep.start.axis_W))) /
         length2;
}

double SweepPlaces::progress(size_t sweep, size_t cycle) const {
  return progress(sweeps_[sweep], reader_.at(cycle).sample.pose);
}

SweepPlaces::Range SweepPlaces::cycles(size_t sweep) const {
  if (cycles_.size() == 0) return {0, 0};
  const size_t first = sweep > 0 ? cycle_of(source(sweep - 1), reader_) : 0U;
  return {first, cycle_of(source(sweep), reader_)};
}

ContactPlace SweepPlaces::at(size_t sweep, double t) const {
  const SweepSource last = source(sweep);
  const Range range = cycles(sweep);
  const int first_element = sweep > 0 ? source(sweep - 1).element : 0;
  size_t low = range.first, high = range.last;  // progress(low) < t <= progress(high)
  while (low + 1 < high) {
    const size_t middle = (low + high) / 2;
    (progress(sweep, middle) < t - kSameT ? low : high) = middle;
  }
  ContactPlace place{last.element, static_cast<double>(range.last) * cycles_.period_s()};
  if (range.first < range.last) {
    const double before = progress(sweep, low), after = progress(sweep, high);
    const double share = after > before ? std::clamp((t - before) / (after - before), 0.0, 1.0) : 1.0;
    const double from_s = reader_.at(low).sample.t_s, to_s = reader_.at(high).sample.t_s;
    place = {reader_.at(high).sample.element, from_s + share * (to_s - from_s)};
  }
  // A cycle may hold the ends of blocks.
  for (; place.element > first_element; --place.element) {
    const toolpath::Elements& elements = cycles_.elements();
    const auto before = static_cast<size_t>(place.element) - 1;
    if (!elements.hold_blocks() || elements.tool(before) != last.tool) break;
    if (progress(sweeps_[sweep], elements.block_end(before)) < t - kSameT) break;
  }
  return place;
}

ContactEvent event_of(const std::string& part, int tool, const stock::Contact& contact,
                      const SweepPlaces& places, size_t sweep) {
  return {part,
          tool,
          places.at(sweep, contact.first_t),
          places.at(sweep, contact.last_t).element,
          contact.depth_mm,
          places.at(sweep, contact.deepest_t),
          contact.place_W};
}

bool goes_on(const ContactEvent& before, const ContactEvent& event) {
  return before.part == event.part && before.tool == event.tool &&
         event.first.element <= before.last_element + 1;
}

void join(ContactEvent& before, const ContactEvent& event) {
  before.last_element = std::max(before.last_element, event.last_element);
  if (event.depth_mm <= before.depth_mm) return;
  before.depth_mm = event.depth_mm;
  before.deepest = event.deepest;
  before.deepest_W = event.deepest_W;
}

}  // namespace swarf::sim
