#include "motion/cycles/axis_keys.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/units.h"

namespace swarf::motion {
namespace {

/// Rotary keys lie less than a quarter turn apart, so that every viewer turns the short way.
constexpr double kTurnMost = 0.5 * kPi;

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

void KeyLine::thin() {
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
