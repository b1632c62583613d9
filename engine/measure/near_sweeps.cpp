#include "measure/near_sweeps.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

NearSweeps::Capsule NearSweeps::capsule(const stock::Sweep& s, size_t number) const {
  const stock::CutterSolid& solid = cutter_of_(number);
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

std::vector<stock::Sweep> NearSweeps::run(size_t number) const {
  return part_(number * kRun, std::min(count_, (number + 1) * kRun));
}

NearSweeps::NearSweeps(std::span<const stock::Sweep> sweeps, const SweepCutters& cutters)
    : NearSweeps(
          sweeps.size(),
          [sweeps](size_t begin, size_t end) {
            return std::vector<stock::Sweep>(sweeps.begin() + static_cast<ptrdiff_t>(begin),
                                             sweeps.begin() + static_cast<ptrdiff_t>(end));
          },
          [sweeps, &cutters](size_t n) -> const stock::CutterSolid& { return cutters[sweeps[n].block]; }) {}

NearSweeps::NearSweeps(size_t count, Part part, CutterOf cutter_of)
    : count_(count),
      part_(std::move(part)),
      cutter_of_(std::move(cutter_of)),
      runs_((count + kRun - 1) / kRun) {
  parallel_chunks(runs_.size(), kRunsPerTask, [&](size_t begin, size_t end) {
    for (size_t number = begin; number < end; ++number) {
      Box& box = runs_[number];
      const std::vector<stock::Sweep> sweeps = run(number);
      for (size_t i = 0; i < sweeps.size(); ++i) {
        const Capsule c = capsule(sweeps[i], number * kRun + i);
        const Vec3 to = c.from + c.way, reach = Vec3::Constant(c.radius);
        const Box own{c.from.cwiseMin(to) - reach, c.from.cwiseMax(to) + reach};
        box = i == 0 ? own : Box{box.lower.cwiseMin(own.lower), box.upper.cwiseMax(own.upper)};
      }
    }
  });
}

bool NearSweeps::Capsule::may_reach(const Vec3& point_W, double distance_mm) const {
  const double length2 = way.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((point_W - from).dot(way) / length2, 0.0, 1.0) : 0.0;
  return (point_W - from - t * way).norm() <= radius + distance_mm / kLeastCosine;
}

std::vector<NearSweeps::Near> NearSweeps::near(const Vec3& point_W, double distance_mm, size_t end) const {
  std::vector<Near> near;
  const size_t runs = std::min(runs_.size(), (end + kRun - 1) / kRun);
  for (size_t number = 0; number < runs; ++number) {
    if (distance_to_box(runs_[number], point_W) > distance_mm / kLeastCosine) continue;
    const std::vector<stock::Sweep> sweeps = run(number);
    for (size_t i = 0; i < sweeps.size() && number * kRun + i < end; ++i) {
      const size_t n = number * kRun + i;
      const Capsule capsule = this->capsule(sweeps[i], n);
      if (capsule.may_reach(point_W, distance_mm))
        near.push_back({static_cast<uint32_t>(n), sweeps[i], capsule});
    }
  }
  return near;
}

std::vector<uint32_t> NearSweeps::around(const Vec3& point_W, double distance_mm) const {
  std::vector<uint32_t> numbers;
  for (const Near& one : near(point_W, distance_mm, count_)) numbers.push_back(one.number);
  return numbers;
}

}  // namespace swarf::measure
