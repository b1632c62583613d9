// The sweeps that come near a point, found by boxes around runs of them.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/frames.h"
#include "measure/sweep_cutters.h"
#include "stock/sweep/sweep.h"

namespace swarf::measure {

/// Borrows the sweeps.
class NearSweeps {
 public:
  /// Sweeps [begin, end) by their numbers, and the cutter of one.
  using Part = std::function<std::vector<stock::Sweep>(size_t begin, size_t end)>;
  using CutterOf = std::function<const stock::CutterSolid&(size_t sweep)>;
  NearSweeps(size_t count, Part part, CutterOf cutter_of);
  /// `cutters`: by Sweep::block.
  NearSweeps(std::span<const stock::Sweep> sweeps, const SweepCutters& cutters);
  struct Capsule {
    Vec3 from, way;  ///< of the middle of the flutes, W
    double radius;   ///< of a ball about it that holds them
    /// False: the flutes stay farther than this away from the point.
    bool may_reach(const Vec3& point_W, double distance_mm) const;
  };
  struct Near {
    uint32_t number;
    stock::Sweep sweep;
    Capsule capsule;
  };
  /// All of the first `end` sweeps whose cutter may come within `distance_mm` of the point, in order; some of
  /// them stay farther away.
  std::vector<Near> near(const Vec3& point_W, double distance_mm, size_t end) const;
  /// The numbers of those of all sweeps.
  std::vector<uint32_t> around(const Vec3& point_W, double distance_mm) const;

 private:
  Capsule capsule(const stock::Sweep& sweep, size_t number) const;
  std::vector<stock::Sweep> run(size_t number) const;

  size_t count_;
  Part part_;
  CutterOf cutter_of_;
  std::vector<Box> runs_;  ///< around kRun consecutive sweeps each
};

}  // namespace swarf::measure
