// What a program does over its time, in a few thousand points that keep every minimum and maximum: for plots.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/frames.h"
#include "motion/tool_sample.h"

namespace swarf::motion {

/// Takes the cycles of a program in their order. They fall into spans of equal time, which become twice as
/// long whenever there are more than kSpansMost: memory does not grow with the program.
class TimeEnvelope {
 public:
  TimeEnvelope(size_t axes, double period_s) : axes_(axes), period_s_(period_s) {}
  void add(std::span<const Cycle> window);

  /// (s, mm/s) in contact; NaN once in each gap.
  std::vector<Vec2> feed() const { return points(0); }
  /// (s, mm or rad)
  std::vector<Vec2> position(size_t axis) const { return points(1 + axis); }
  /// (s, mm/s or rad/s): the way of each cycle over its period, but for changes of the tool.
  std::vector<Vec2> speed(size_t axis) const { return points(1 + axes_ + axis); }

  static constexpr size_t kSpansMost = 4096;

 private:
  /// Least and greatest value of a span, each with its cycle.
  struct Extremes {
    uint64_t cycle_min = 0, cycle_max = 0;
    double min = 0.0, max = 0.0;
    bool any = false;
    void see(uint64_t cycle, double value);
    void join(const Extremes& later);
  };
  size_t channels() const { return 1 + 2 * axes_; }
  Extremes& at(size_t span, size_t channel) { return extremes_[span * channels() + channel]; }
  void halve();
  std::vector<Vec2> points(size_t channel) const;

  size_t axes_;
  double period_s_;
  uint64_t cycles_ = 0, per_span_ = 1;
  std::vector<Extremes> extremes_;  ///< by span, then channel
  std::optional<Cycle> last_;
};

}  // namespace swarf::motion
