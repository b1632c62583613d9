// The material as the sweeps before a given one have left it, by the sweeps themselves: no grid.
#pragma once

#include <span>

#include "measure/near_sweeps.h"
#include "sim/run/cut_sweeps.h"
#include "stock/contact/contact_finder.h"

namespace swarf::sim {

class EarlierCuts {
 public:
  /// `sweeps` and `solids` (by tool) must outlive it. Depths below `farthest_mm` are not told apart.
  EarlierCuts(const CutSweeps& sweeps, std::span<const stock::CutterSolid> solids, const Box& box,
              double farthest_mm);
  EarlierCuts(const EarlierCuts&) = delete;
  EarlierCuts& operator=(const EarlierCuts&) = delete;

  /// Before the sweep of this index; borrows this object.
  stock::ContactFinder::Material before(size_t sweep) const;

 private:
  double distance(const Vec3& point_W, size_t sweep) const;

  const CutSweeps& sweeps_;
  std::span<const stock::CutterSolid> solids_;  ///< by tool
  measure::NearSweeps near_;
  Box box_;
  double farthest_mm_;
};

}  // namespace swarf::sim
