// Drilling cycles, kept as cycles.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/units.h"
#include "post/writer.h"

namespace swarf::post {
namespace {

/// Heights that are nearer are the same, mm.
constexpr double kSameHeight = 1e-6;

const LineTemplate& cycle_lines(const CycleWords& words, const program::ClHole& hole) {
  const bool dwells = hole.cycle.dwell_s > 0.0;
  switch (hole.cycle.kind) {
    case program::ClCycleKind::kDeep:
      return words.deep;
    case program::ClCycleKind::kChipBreak:
      return words.chip_break;
    case program::ClCycleKind::kBore:
      return dwells ? words.bore_dwell : words.bore;
    case program::ClCycleKind::kTap:
      return words.tap;
    case program::ClCycleKind::kDrill:
    case program::ClCycleKind::kFace:
      break;
  }
  return dwells ? words.drill_dwell : words.drill;
}

void set_heights(const PostFormat& format, const PlanStep& step, const program::ClHole& hole,
                 PlaceValues& values) {
  const program::ClCycle& cycle = hole.cycle;
  const auto linear = [&](Place place, double value) {
    values.set(place, written(format.numbers.linear, value / format.unit.length_mm()));
  };
  const double surface = step.p.z() - cycle.retract_mm;
  linear(Place::kSurface, surface);
  linear(Place::kBottom, surface - cycle.depth_mm);
  linear(Place::kClear, surface + cycle.clear_mm);
  linear(Place::kRetract, step.p.z());
  linear(Place::kDepth, -cycle.depth_mm);
  // Rounded apart, surface and clearance could add up to more than the height of the retract.
  const double room = format.unit.length_mm() * (std::strtod(values.of(Place::kRetract).c_str(), nullptr) -
                                                 std::strtod(values.of(Place::kSurface).c_str(), nullptr));
  linear(Place::kClearance, std::min(cycle.clear_mm, room));
  linear(Place::kSecondClearance, cycle.retract_mm);
  linear(Place::kStep, cycle.step_mm > 0.0 ? cycle.step_mm : cycle.depth_mm);
  linear(Place::kStepFirst, surface - (cycle.first_step_mm > 0.0 ? cycle.first_step_mm : cycle.step_mm));
}

/// Returns, times, feed, pitch and speed.
void set_rates(const PostFormat& format, const PlanStep& step, const program::ClHole& hole,
               PlaceValues& values) {
  const program::ClCycle& cycle = hole.cycle;
  const bool to_start = std::abs(cycle.retract_mm - cycle.arrive_mm) < kSameHeight;
  values.set(Place::kReturn, to_start ? format.cycle.return_start : format.cycle.return_clear);
  const double dwell = cycle.dwell_s * (format.cycle.dwell_in_ms ? 1e3 : 1.0);
  NumberFormat time = format.numbers.time;
  if (format.cycle.dwell_in_ms) time.decimals = 0, time.point = false;
  values.set(Place::kDwell, written(time, dwell));
  const double feed = mm_min_from_mm_s(cycle.feed_mm_s);
  values.set(Place::kFeed, written(format.numbers.feed, feed / format.unit.feed_mm()));
  if (step.spindle_rpm != 0.0)
    values.set(Place::kPitch,
               written(format.numbers.linear, feed / format.unit.length_mm() / std::abs(step.spindle_rpm)));
  values.set(Place::kS, written(format.numbers.speed, std::abs(step.spindle_rpm)));
}

}  // namespace

/// The lines of the cycle without where the hole is.
std::string Writer::definition(const PlanStep& step, const program::ClHole& hole) {
  set_heights(format_, step, hole, values_);
  set_rates(format_, step, hole, values_);
  values_.set(Place::kAxes, "");
  values_.set(Place::kF, "F" + values_.of(Place::kFeed));
  lines_.clear();
  cycle_lines(format_.cycle, hole).fill(values_, lines_);
  std::string text;
  for (const std::string& one : lines_) text += one + "\n";
  return text;
}

bool Writer::merges_with(const PlanStep& arrival, const PlanStep& step, const program::ClHole& hole) {
  if (cycle_.empty() || format_.cycle.next.empty() || arrival.tcp || tcp_ || arrival.dwell_s > 0.0 ||
      arrival.tilt != tilt_ || step.tilt != tilt_)
    return false;
  if (step.spindle_rpm != spindle_ || definition(step, hole) != cycle_) return false;
  const Words there = words_of(arrival);
  for (size_t i = 2; i < 6; ++i) {
    if (there.at(i) != words_.at(i)) return false;
  }
  return true;
}

void Writer::hole(const PlanStep& step, const program::ClHole& hole) {
  spindle(step.spindle_rpm);
  set_tcp(false);
  set_tilt(step.tilt);
  set_timed(false);
  set_plane(0);
  const std::string text = definition(step, hole);
  const bool known = text == cycle_ && !format_.cycle.call.empty();
  if (!known) {
    for (size_t at = 0; at < text.size();) {
      const size_t end = text.find('\n', at);
      put_line(std::string_view(text).substr(at, end - at));
      at = end + 1;
    }
    cycle_ = text;
  }
  put(format_.cycle.call);
  feed_.clear();
  motion_word_.clear();
  const double height = hole.cycle.retract_mm;
  const bool to_clear = std::abs(height - hole.cycle.clear_mm) < kSameHeight,
             to_start = std::abs(height - hole.cycle.arrive_mm) < kSameHeight;
  const bool returns = cycle_lines(format_.cycle, hole).uses(Place::kReturn);
  if (returns && !to_clear && !to_start) {
    end_cycle();
    values_.set(Place::kAxes, changed(words_of(step), true));
    motion(format_.motion.rapid);
  } else {
    changed(words_of(step), false);
  }
}

void Writer::end_cycle() {
  if (cycle_.empty()) return;
  cycle_.clear();
  if (!format_.cycle.end.empty()) put_line(format_.cycle.end);
  motion_word_.clear();
}

}  // namespace swarf::post
