#include "sim/run/earlier_cuts.h"

#include <algorithm>

#include "stock/contact/convex_contact.h"

namespace swarf::sim {

EarlierCuts::EarlierCuts(const CutSweeps& sweeps, std::span<const stock::CutterSolid> solids, const Box& box,
                         double farthest_mm)
    : sweeps_(sweeps),
      solids_(solids),
      near_(
          sweeps.size(), [&sweeps](size_t begin, size_t end) { return sweeps.part(begin, end); },
          [&sweeps, solids](size_t n) -> const stock::CutterSolid& {
            return solids[static_cast<size_t>(sweeps.tool(n))];
          }),
      box_(box),
      farthest_mm_(farthest_mm) {}

stock::ContactFinder::Material EarlierCuts::before(size_t sweep) const {
  return [this, sweep](const Vec3& point_W) { return distance(point_W, sweep); };
}

double EarlierCuts::distance(const Vec3& point_W, size_t sweep) const {
  double highest = -std::min((point_W - box_.lower).minCoeff(), (box_.upper - point_W).minCoeff());
  for (const uint32_t n : near_.around(point_W, farthest_mm_)) {
    if (n >= sweep) break;
    const stock::SweepContact contact = stock::swept_contact(point_W, stock::sweep_map(sweeps_[n]),
                                                             solids_[static_cast<size_t>(sweeps_.tool(n))]);
    highest = std::max(highest, -contact.distance_mm);
  }
  return highest;
}

}  // namespace swarf::sim
