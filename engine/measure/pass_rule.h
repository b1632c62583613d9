// Which sweeps belong to the same pass: a cusp stands between two passes, not between two blocks of one.
// Internal to this folder.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "measure/sweep_cutters.h"
#include "stock/rays/surface_dexels.h"
#include "stock/sweep/sweep.h"
#include "stock/sweep/sweep_map.h"

namespace swarf::measure {

/// With pass numbers from the planner, those. Without (a CL path), by the length of the path: two sweeps
/// belong to different passes when the way from one to the other along the path is more than twice as long as
/// the straight line between them, plus the pitch of the rays. On a pass the two are about equal, and a
/// corner of 90 degrees makes it 1.41; from one turn of a zigzag, of a spiral or of a contour to the next the
/// way is far longer than the step-over, except within half a step-over of a zigzag's reversal, where the
/// passes run into one another. A gap in the path (the end of one sweep is not the start of the next) parts
/// passes too.
class PassRule {
 public:
  /// `pass_of_sweep`: pass of each sweep, -1 for moves between passes; or empty.
  PassRule(std::span<const stock::Sweep> sweeps, std::span<const int> pass_of_sweep, double pitch_mm);

  /// False for moves between passes.
  bool is_pass(uint32_t sweep) const { return passes_.empty() || passes_[sweep] >= 0; }
  bool same(uint32_t a, uint32_t b) const;
  /// Way of the tip from the first sweep's start to the middle of this one, gaps left out; mm.
  double travel_mm(uint32_t sweep) const { return travel_[sweep]; }

 private:
  std::span<const stock::Sweep> sweeps_;
  std::span<const int> passes_;
  std::vector<double> travel_;
  std::vector<uint32_t> chain_;  ///< counts the gaps
  double pitch_mm_;
};

/// The height that one pass leaves on any ray: its sweeps from a known one on, as long as the height falls.
class PassHeight {
 public:
  PassHeight(std::span<const stock::Sweep> sweeps, const PassRule& rule, const SweepCutters& cutters,
             uint32_t owner)
      : sweeps_(sweeps), rule_(rule), cutters_(cutters), first_(owner), owner_(owner) {}

  /// mm; at most kHigh, which stands for "not under the cutter". Along a pass the height has one minimum near
  /// the sweep that owns the neighbouring ray; the owner is remembered for the next call.
  double operator()(const Vec3& point, const Vec3& normal);
  /// Whether the owner's sweep removes the material at a point.
  bool removes(const Vec3& point);
  uint32_t owner() const { return owner_; }

  static constexpr double kHigh = 1e6;

 private:
  /// Of the owner and those beside it, which are asked at every place.
  struct KnownMap {
    uint32_t sweep = stock::kUncut;
    stock::SweepMap map;
  };
  double height(const Vec3& point, const Vec3& normal, uint32_t sweep);
  const stock::SweepMap& map_of(uint32_t sweep);

  std::span<const stock::Sweep> sweeps_;
  const PassRule& rule_;
  const SweepCutters& cutters_;
  uint32_t first_, owner_;
  std::array<KnownMap, 4> known_;  ///< by the last bits of the sweep's number
};

}  // namespace swarf::measure
