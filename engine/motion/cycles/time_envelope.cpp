#include "motion/cycles/time_envelope.h"

#include <cmath>
#include <limits>

namespace swarf::motion {

void TimeEnvelope::Extremes::see(uint64_t cycle, double value) {
  if (!any || value < min) {
    min = value;
    cycle_min = cycle;
  }
  if (!any || value > max) {
    max = value;
    cycle_max = cycle;
  }
  any = true;
}

void TimeEnvelope::Extremes::join(const Extremes& later) {
  if (!later.any) return;
  see(later.cycle_min, later.min);
  see(later.cycle_max, later.max);
}

void TimeEnvelope::add(std::span<const Cycle> window) {
  for (const Cycle& now : window) {
    const size_t span = cycles_ / per_span_;
    if (span * channels() == extremes_.size()) extremes_.resize(extremes_.size() + channels());
    if (now.sample.kind == SampleKind::kCutting) at(span, 0).see(cycles_, now.sample.feed_mm_s);
    for (size_t i = 0; i < axes_; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      at(span, 1 + i).see(cycles_, now.q[row]);
      if (last_ && last_->sample.tool == now.sample.tool)
        at(span, 1 + axes_ + i).see(cycles_, (now.q[row] - last_->q[row]) / period_s_);
    }
    last_ = now;
    if (++cycles_ == kSpansMost * per_span_) halve();
  }
}

void TimeEnvelope::halve() {
  for (size_t span = 0; span < kSpansMost / 2; ++span) {
    for (size_t channel = 0; channel < channels(); ++channel) {
      Extremes joined = at(2 * span, channel);
      joined.join(at(2 * span + 1, channel));
      at(span, channel) = joined;
    }
  }
  extremes_.resize(kSpansMost / 2 * channels());
  per_span_ *= 2;
}

std::vector<Vec2> TimeEnvelope::points(size_t channel) const {
  std::vector<Vec2> points;
  bool gap = false;
  for (size_t n = channel; n < extremes_.size(); n += channels()) {
    const Extremes& one = extremes_[n];
    const auto point = [&](uint64_t cycle, double value) {
      points.emplace_back(static_cast<double>(cycle) * period_s_, value);
    };
    if (!one.any) {
      if (!gap) point(n / channels() * per_span_, std::numeric_limits<double>::quiet_NaN());
      gap = true;
      continue;
    }
    gap = false;
    const bool min_first = one.cycle_min <= one.cycle_max;
    point(min_first ? one.cycle_min : one.cycle_max, min_first ? one.min : one.max);
    if (one.cycle_min != one.cycle_max)
      point(min_first ? one.cycle_max : one.cycle_min, min_first ? one.max : one.min);
  }
  return points;
}

}  // namespace swarf::motion
