#include "motion/cycles/axis_keys.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/units.h"

namespace swarf::motion {
namespace {

/// Rotary keys lie less than 12 degrees apart: viewers that mix quaternions are off by a fifth of the
/// tolerance at most (mixing_error()), and every viewer turns the short way.
constexpr double kTurnMost = kPi / 15.0;
/// Of the keys that turns need at least, so many are not too many.
constexpr double kKeysOfTurns = 4.0;

bool is_exact(uint64_t cycle) {
  return static_cast<double>(static_cast<float>(cycle)) == static_cast<double>(cycle);
}

double on_line(const AxisKey& a, const AxisKey& b, uint64_t cycle) {
  const double share = static_cast<double>(cycle - a.cycle) / static_cast<double>(b.cycle - a.cycle);
  return a.q + share * (b.q - a.q);
}

}  // namespace

AxisKey KeyLine::end_at(const AxisKey& at) const {
  return {at.cycle, static_cast<double>(static_cast<float>(at.q))};
}

void KeyLine::begin(const AxisKey& key) {
  keys_.push_back(end_at(key));
  cone_ = {};
  has_end_ = false;
}

void KeyLine::add(uint64_t cycle, double q) {
  if (keys_.empty()) {
    SWARF_CHECK(is_exact(cycle), "the first key stands where a float can");
    begin({cycle, q});
    rounding_ = std::abs(keys_.front().q - q);
    return;
  }
  see({cycle, q});
  if (keys_.size() > most_) thin();
}

void KeyLine::see(const AxisKey& at) {
  const AxisKey& key = keys_.back();
  const double steps = static_cast<double>(at.cycle - key.cycle);
  const AxisKey end = end_at(at);
  rounding_ = std::max(rounding_, std::abs(end.q - at.q));
  const double slope = (end.q - key.q) / steps;
  const bool within = slope >= cone_.low && slope <= cone_.high && std::abs(end.q - key.q) < step_most_;
  cone_.low = std::max(cone_.low, (at.q - tolerance_ - key.q) / steps);
  cone_.high = std::min(cone_.high, (at.q + tolerance_ - key.q) / steps);
  behind_.push_back(at);
  if (!is_exact(at.cycle)) return;
  if (within) {
    has_end_ = true;
    end_ = end;
    behind_.clear();
    return;
  }
  // The line ends before here; what lies behind its end belongs to the next one.
  const std::vector<AxisKey> again = std::move(behind_);
  behind_.clear();
  if (has_end_) {
    begin(end_);
    for (const AxisKey& one : again) see(one);
    return;
  }
  // Not even the first place where a key may stand: it takes it all the same.
  for (const AxisKey& one : again)
    forced_ = std::max(forced_, std::abs(on_line(key, end, one.cycle) - one.q));
  begin(end);
}

double KeyLine::longest_step() const {
  double longest = 0.0;
  for (size_t i = 1; i < keys_.size(); ++i)
    longest = std::max(longest, std::abs(keys_[i].q - keys_[i - 1].q));
  return longest;
}

void KeyLine::thin() {
  double way = 0.0;
  for (size_t i = 1; i < keys_.size(); ++i) way += std::abs(keys_[i].q - keys_[i - 1].q);
  // No tolerance spares these.
  most_ = std::max(most_, static_cast<size_t>(kKeysOfTurns * way / step_most_));
  if (keys_.size() <= most_) return;
  const double before = tolerance_;
  while (keys_.size() > most_ / 2) {
    KeyLine fewer(tolerance_, step_most_, std::numeric_limits<size_t>::max());
    for (const AxisKey& key : keys_) fewer.add(key.cycle, key.q);
    fewer.finish();
    thinned_ += fewer.error_;
    keys_ = std::move(fewer.keys_);
    tolerance_ *= 2.0;
    if (tolerance_ > 1e6 * before) break;  // turns beyond step_most_ are not thinned
  }
  most_ = std::max(most_, 2 * keys_.size());
}

void KeyLine::finish() {
  if (keys_.empty()) return;
  if (has_end_) {
    const std::vector<AxisKey> rest = std::move(behind_);
    behind_.clear();
    begin(end_);
    for (const AxisKey& one : rest) see(one);
    if (has_end_) begin(end_);
  }
  // Cycles behind the last place for a key: the line stands still there.
  for (const AxisKey& one : behind_) forced_ = std::max(forced_, std::abs(one.q - keys_.back().q));
  error_ = std::max({tolerance_, forced_, rounding_}) + thinned_;
}

double mixing_error(double turn_rad) {
  const double half = 0.5 * turn_rad;  // a quaternion has half of the angle
  if (half < 1e-4) return 0.0;         // below 1e-13
  // Mixed at t its angle is atan2(t sin, 1 - t + t cos), which is farthest from t * half where both change
  // alike: where the square of the mixture's length, 1 - 2 t (1 - t) (1 - cos), is sin / half.
  const double product = 0.5 * (1.0 - std::sin(half) / half) / (1.0 - std::cos(half));
  const double t = 0.5 * (1.0 - std::sqrt(1.0 - 4.0 * product));
  return 2.0 * (t * half - std::atan2(t * std::sin(half), 1.0 - t + t * std::cos(half)));
}

AxisKeys::AxisKeys(std::span<const kinematics::Axis> axes, double linear_mm, double rotary_rad, size_t most) {
  for (const kinematics::Axis& axis : axes) {
    const bool rotary = axis.kind == kinematics::AxisKind::kRotary;
    lines_.emplace_back(rotary ? rotary_rad : linear_mm,
                        rotary ? kTurnMost : std::numeric_limits<double>::infinity(), most);
  }
}

void AxisKeys::add(std::span<const Cycle> window) {
  if (window.empty()) return;
  if (!any_) first_ = window.front().number;
  any_ = true;
  last_ = window.back().number;
  for (size_t i = 0; i < lines_.size(); ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    for (const Cycle& cycle : window) lines_[i].add(cycle.number - first_, cycle.q[axis]);
  }
  for (const Cycle& cycle : window) {
    if (tools_.empty() || tools_.back().tool != cycle.sample.tool)
      tools_.push_back({cycle.number - first_, cycle.sample.tool});
  }
}

void AxisKeys::finish() {
  for (KeyLine& line : lines_) line.finish();
}

}  // namespace swarf::motion
