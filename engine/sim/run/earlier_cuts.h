// The material as the sweeps before a given one have left it, by the sweeps themselves: no grid.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "measure/near_sweeps.h"
#include "sim/run/carried_cuts.h"
#include "sim/run/cut_sweeps.h"
#include "stock/contact/contact_finder.h"
#include "stock/sweep/sweep_map.h"

namespace swarf::sim {

class EarlierCuts {
 public:
  /// `sweeps` and `solids` (by tool) must outlive it. Depths below `farthest_mm` are not told apart.
  /// `carried`: of earlier set-ups, before all others; must outlive it too.
  EarlierCuts(const CutSweeps& sweeps, std::span<const stock::CutterSolid> solids, const CarriedCuts& carried,
              const stock::RawShape& raw, double farthest_mm);
  EarlierCuts(const EarlierCuts&) = delete;
  EarlierCuts& operator=(const EarlierCuts&) = delete;

  /// Before the sweep of this index; borrows this object. For one thread: what is cut about a point is kept
  /// for those near it that are asked for next.
  stock::ContactFinder::Material before(size_t sweep) const;
  /// How far the sweeps of earlier set-ups may lie from their motion.
  double carried_bound_mm() const { return carried_.stock.error_bound_mm; }

 private:
  struct Cut {
    measure::NearSweeps::Capsule capsule;
    stock::SweepMap map;
    const stock::CutterSolid* solid;
  };
  /// The cuts that matter within farthest_mm_ of a point.
  struct Surroundings {
    Vec3 centre = Vec3::Constant(std::numeric_limits<double>::infinity());
    std::vector<Cut> cuts;
  };
  Surroundings surroundings(const Vec3& point_W, size_t sweep) const;
  double distance(const Vec3& point_W, const std::vector<Cut>& cuts) const;

  std::vector<stock::Sweep> part(size_t begin, size_t end) const;
  const stock::CutterSolid& solid(size_t n) const;

  const CutSweeps& sweeps_;
  std::span<const stock::CutterSolid> solids_;  ///< by tool
  const CarriedCuts& carried_;
  size_t first_;  ///< of the program's sweeps, behind the carried ones
  measure::NearSweeps near_;
  stock::RawShape raw_;
  double farthest_mm_;
};

}  // namespace swarf::sim
