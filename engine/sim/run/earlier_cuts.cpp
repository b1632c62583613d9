#include "sim/run/earlier_cuts.h"

#include <algorithm>

#include "stock/contact/convex_contact.h"

namespace swarf::sim {
namespace {

std::vector<stock::Sweep> numbered(std::vector<stock::Sweep> sweeps) {
  for (size_t n = 0; n < sweeps.size(); ++n) sweeps[n].block = static_cast<uint32_t>(n);
  return sweeps;
}

std::vector<int> tools_of(const JobSweeps& sweeps) {
  std::vector<int> tools;
  tools.reserve(sweeps.sweeps.size());
  for (const stock::Sweep& sweep : sweeps.sweeps) tools.push_back(sweeps.sources[sweep.block].tool);
  return tools;
}

}  // namespace

EarlierCuts::EarlierCuts(const JobSweeps& sweeps, std::span<const stock::CutterSolid> solids, const Box& box,
                         double farthest_mm)
    : by_index_(numbered(sweeps.sweeps)),
      tools_(tools_of(sweeps)),
      cutters_(solids, tools_),
      near_(by_index_, cutters_),
      box_(box),
      farthest_mm_(farthest_mm) {}

stock::ContactFinder::Material EarlierCuts::before(size_t sweep) const {
  return [this, sweep](const Vec3& point_W) { return distance(point_W, sweep); };
}

double EarlierCuts::distance(const Vec3& point_W, size_t sweep) const {
  double highest = -std::min((point_W - box_.lower).minCoeff(), (box_.upper - point_W).minCoeff());
  for (const uint32_t n : near_.around(point_W, farthest_mm_)) {
    if (n >= sweep) break;
    const stock::SweepContact contact =
        stock::swept_contact(point_W, stock::sweep_map(by_index_[n]), cutters_[n]);
    highest = std::max(highest, -contact.distance_mm);
  }
  return highest;
}

}  // namespace swarf::sim
