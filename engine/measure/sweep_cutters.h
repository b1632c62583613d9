// Which cutter each sweep was made with.
#pragma once

#include <cstdint>
#include <span>

#include "base/check.h"
#include "stock/sweep/sweep.h"

namespace swarf::measure {

/// Borrows what it is made from.
class SweepCutters {
 public:
  /// One cutter for every sweep.
  SweepCutters(const stock::CutterSolid& one) : solids_(&one, 1) {}
  /// `solid_of_sweep`: index into `solids`, by Sweep::block.
  SweepCutters(std::span<const stock::CutterSolid> solids, std::span<const int> solid_of_sweep)
      : solids_(solids), solid_of_sweep_(solid_of_sweep) {
    for (const int solid : solid_of_sweep) {
      SWARF_CHECK(solid >= 0 && static_cast<size_t>(solid) < solids.size(), "every sweep has a cutter");
    }
  }

  const stock::CutterSolid& operator[](uint32_t sweep) const {
    return solids_[solid_of_sweep_.empty() ? 0 : static_cast<size_t>(solid_of_sweep_[sweep])];
  }

 private:
  std::span<const stock::CutterSolid> solids_;
  std::span<const int> solid_of_sweep_;
};

}  // namespace swarf::measure
