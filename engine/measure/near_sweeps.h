// The sweeps that come near a point, found by boxes around runs of them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/frames.h"
#include "measure/sweep_cutters.h"
#include "stock/sweep/sweep.h"

namespace swarf::measure {

/// Borrows the sweeps.
class NearSweeps {
 public:
  NearSweeps(std::span<const stock::Sweep> sweeps, const SweepCutters& cutters);
  /// Indices of all sweeps whose cutter may come within `distance_mm` of the point, in order; some of them
  /// stay farther away.
  std::vector<uint32_t> around(const Vec3& point_W, double distance_mm) const;

 private:
  struct Capsule {
    Vec3 from, way;  ///< of the middle of the flutes, W
    double radius;   ///< of a ball about it that holds them
  };
  Capsule capsule(uint32_t sweep) const;

  std::span<const stock::Sweep> sweeps_;
  const SweepCutters& cutters_;
  std::vector<Box> runs_;  ///< around kRun consecutive sweeps each
};

}  // namespace swarf::measure
