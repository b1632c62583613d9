// The material as the sweeps before a given one have left it, by the sweeps themselves: no grid.
#pragma once

#include <vector>

#include "measure/near_sweeps.h"
#include "sim/run/job_sweeps.h"
#include "stock/contact/contact_finder.h"

namespace swarf::sim {

class EarlierCuts {
 public:
  /// `sweeps` and `solids` (by tool) must outlive it. Depths below `farthest_mm` are not told apart.
  EarlierCuts(const JobSweeps& sweeps, std::span<const stock::CutterSolid> solids, const Box& box,
              double farthest_mm);
  EarlierCuts(const EarlierCuts&) = delete;
  EarlierCuts& operator=(const EarlierCuts&) = delete;

  /// Before the sweep of this index; borrows this object.
  stock::ContactFinder::Material before(size_t sweep) const;

 private:
  double distance(const Vec3& point_W, size_t sweep) const;

  std::vector<stock::Sweep> by_index_;  ///< with the index as their block
  std::vector<int> tools_;              ///< by index
  measure::SweepCutters cutters_;
  measure::NearSweeps near_;
  Box box_;
  double farthest_mm_;
};

}  // namespace swarf::sim
