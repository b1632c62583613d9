#include "measure/near_sweeps.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace swarf::measure {
namespace {

constexpr size_t kRun = 32;
constexpr size_t kRunsPerTask = 64;
/// Of half the turn of a sweep: no sweep turns by more than 120 degrees.
constexpr double kLeastCosine = 0.5;

double distance_to_box(const Box& box, const Vec3& point) {
  return (point - point.cwiseMax(box.lower).cwiseMin(box.upper)).norm();
}

}  // namespace

NearSweeps::Capsule NearSweeps::capsule(uint32_t sweep) const {
  const stock::Sweep& s = sweeps_[sweep];
  const stock::CutterSolid& solid = cutters_[s.block];
  const double half = 0.5 * solid.height;
  const Vec3 from = s.start.tip_W + half * s.start.axis_W, to = s.end.tip_W + half * s.end.axis_W;
  // At t a point x stands in the tool's frame at M(x), the mean of two rigid maps (sweep_map.h). With c on
  // the straight line of the middle m, |M(c) - m| <= t (1 - t) |R0 - R1| |way|, and |M(x) - M(c)| is at least
  // the cosine of half the turn times |x - c|. |R0 - R1| is the chord of the turn.
  const double chord = (s.end.axis_W - s.start.axis_W).norm();
  const double cosine = std::sqrt(std::max(kLeastCosine * kLeastCosine, 1.0 - 0.25 * chord * chord));
  const double radius = (std::hypot(solid.radius, half) + 0.25 * chord * (to - from).norm()) / cosine;
  return {from, to - from, radius};
}

NearSweeps::NearSweeps(std::span<const stock::Sweep> sweeps, const SweepCutters& cutters)
    : sweeps_(sweeps), cutters_(cutters), runs_((sweeps.size() + kRun - 1) / kRun) {
  parallel_chunks(runs_.size(), kRunsPerTask, [&](size_t begin, size_t end) {
    for (size_t run = begin; run < end; ++run) {
      Box& box = runs_[run];
      for (size_t n = run * kRun; n < std::min(sweeps.size(), (run + 1) * kRun); ++n) {
        const Capsule c = capsule(static_cast<uint32_t>(n));
        const Vec3 to = c.from + c.way, reach = Vec3::Constant(c.radius);
        const Box own{c.from.cwiseMin(to) - reach, c.from.cwiseMax(to) + reach};
        box = n == run * kRun ? own : Box{box.lower.cwiseMin(own.lower), box.upper.cwiseMax(own.upper)};
      }
    }
  });
}

std::vector<uint32_t> NearSweeps::around(const Vec3& point_W, double distance_mm) const {
  const double reach = distance_mm / kLeastCosine;
  std::vector<uint32_t> near;
  for (size_t run = 0; run < runs_.size(); ++run) {
    if (distance_to_box(runs_[run], point_W) > reach) continue;
    for (size_t n = run * kRun; n < std::min(sweeps_.size(), (run + 1) * kRun); ++n) {
      const Capsule c = capsule(static_cast<uint32_t>(n));
      const double length2 = c.way.squaredNorm();
      const double t = length2 > 0.0 ? std::clamp((point_W - c.from).dot(c.way) / length2, 0.0, 1.0) : 0.0;
      if ((point_W - c.from - t * c.way).norm() <= c.radius + reach) near.push_back(static_cast<uint32_t>(n));
    }
  }
  return near;
}

}  // namespace swarf::measure
