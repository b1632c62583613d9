#include "sim/run/earlier_cuts.h"

#include <algorithm>
#include <memory>

#include "stock/contact/convex_contact.h"

namespace swarf::sim {

EarlierCuts::EarlierCuts(const CutSweeps& sweeps, std::span<const stock::CutterSolid> solids,
                         const CarriedCuts& carried, const stock::RawShape& raw, double farthest_mm)
    : sweeps_(sweeps),
      solids_(solids),
      carried_(carried),
      first_(carried.stock.sweeps.size()),
      near_(
          first_ + sweeps.size(), [this](size_t begin, size_t end) { return part(begin, end); },
          [this](size_t n) -> const stock::CutterSolid& { return solid(n); }),
      raw_(raw),
      farthest_mm_(farthest_mm) {}

std::vector<stock::Sweep> EarlierCuts::part(size_t begin, size_t end) const {
  const std::vector<stock::Sweep>& carried = carried_.stock.sweeps;
  std::vector<stock::Sweep> part(carried.begin() + static_cast<ptrdiff_t>(std::min(begin, first_)),
                                 carried.begin() + static_cast<ptrdiff_t>(std::min(end, first_)));
  if (end <= first_) return part;
  const std::vector<stock::Sweep> own = sweeps_.part(std::max(begin, first_) - first_, end - first_);
  part.insert(part.end(), own.begin(), own.end());
  return part;
}

const stock::CutterSolid& EarlierCuts::solid(size_t n) const {
  if (n < first_) return carried_.solids[static_cast<size_t>(carried_.stock.solids[n])];
  return solids_[static_cast<size_t>(sweeps_.tool(n - first_))];
}

stock::ContactFinder::Material EarlierCuts::before(size_t sweep) const {
  return [this, sweep, about = std::make_shared<Surroundings>()](const Vec3& point_W) {
    // Written so that a point that is not near the centre, and none at all, both ask anew.
    if (!((point_W - about->centre).norm() <= farthest_mm_)) *about = surroundings(point_W, sweep);
    return distance(point_W, about->cuts);
  };
}

EarlierCuts::Surroundings EarlierCuts::surroundings(const Vec3& point_W, size_t sweep) const {
  Surroundings about{point_W, {}};
  for (const auto& near : near_.near(point_W, 2.0 * farthest_mm_, first_ + sweep))
    about.cuts.push_back({near.capsule, stock::sweep_map(near.sweep), &solid(near.number)});
  return about;
}

double EarlierCuts::distance(const Vec3& point_W, const std::vector<Cut>& cuts) const {
  const Box& box = raw_.box();
  double highest = raw_.is_box()
                       ? -std::min((point_W - box.lower).minCoeff(), (box.upper - point_W).minCoeff())
                       : raw_.distance_mm(point_W);
  for (const Cut& cut : cuts) {
    if (!cut.capsule.may_reach(point_W, farthest_mm_)) continue;
    highest = std::max(highest, -stock::swept_contact(point_W, cut.map, *cut.solid).distance_mm);
  }
  return highest;
}

}  // namespace swarf::sim
