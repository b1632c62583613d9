#include "measure/pass_rule.h"

#include <algorithm>
#include <cmath>

#include "stock/contact/convex_contact.h"
#include "stock/rays/ray_height.h"

namespace swarf::measure {

PassRule::PassRule(std::span<const stock::Sweep> sweeps, std::span<const int> pass_of_sweep, double pitch_mm)
    : sweeps_(sweeps), passes_(pass_of_sweep), pitch_mm_(pitch_mm) {
  constexpr double kGap = 1e-6;  // mm
  double travelled = 0.0;
  uint32_t chain = 0;
  travel_.reserve(sweeps.size());
  chain_.reserve(sweeps.size());
  for (size_t n = 0; n < sweeps.size(); ++n) {
    if (n > 0 && (sweeps[n].start.tip_W - sweeps[n - 1].end.tip_W).norm() > kGap) ++chain;
    const double length = (sweeps[n].end.tip_W - sweeps[n].start.tip_W).norm();
    travel_.push_back(travelled + 0.5 * length);
    chain_.push_back(chain);
    travelled += length;
  }
}

bool PassRule::same(uint32_t a, uint32_t b) const {
  if (!passes_.empty()) return passes_[a] == passes_[b];
  if (chain_[a] != chain_[b]) return false;
  const auto middle = [&](uint32_t n) -> Vec3 {
    return 0.5 * (sweeps_[n].start.tip_W + sweeps_[n].end.tip_W);
  };
  return std::abs(travel_[a] - travel_[b]) <= 2.0 * (middle(a) - middle(b)).norm() + pitch_mm_;
}

const stock::SweepMap& PassHeight::map_of(uint32_t sweep) {
  KnownMap& known = known_[sweep % known_.size()];
  if (known.sweep != sweep) known = {sweep, stock::sweep_map(sweeps_[sweep])};
  return known.map;
}

double PassHeight::height(const Vec3& point, const Vec3& normal, uint32_t sweep) {
  return std::min(kHigh, stock::ray_height(point, normal, map_of(sweep), cutters_[sweep]));
}

bool PassHeight::removes(const Vec3& point) {
  constexpr double kRounding = 1e-6;  // mm
  return stock::swept_contact(point, map_of(owner_), cutters_[owner_]).distance_mm <= kRounding;
}

double PassHeight::operator()(const Vec3& point, const Vec3& normal) {
  double lowest = height(point, normal, owner_);
  for (const int step : {1, -1}) {
    const uint32_t before = owner_;
    for (;;) {
      const int64_t next = static_cast<int64_t>(owner_) + step;
      if (next < 0 || next >= static_cast<int64_t>(sweeps_.size())) break;
      if (!rule_.same(static_cast<uint32_t>(next), first_)) break;
      const double candidate = height(point, normal, static_cast<uint32_t>(next));
      if (candidate >= lowest) break;
      lowest = candidate;
      owner_ = static_cast<uint32_t>(next);
    }
    if (owner_ != before) break;
  }
  return lowest;
}

}  // namespace swarf::measure
