// Which sweeps come near a place: a tree of boxes over consecutive sweeps. Internal to this folder.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/frames.h"
#include "measure/sweep_cutters.h"
#include "stock/sweep/sweep.h"

namespace swarf::measure {

/// Neighbours along the path lie near each other, so the tree halves the sweeps in their order. Borrows the
/// sweeps; sweeps[n].block is n.
class SweepIndex {
 public:
  SweepIndex(std::span<const stock::Sweep> sweeps, const SweepCutters& cutters);

  /// Appends the sweeps whose box meets `box`, in rising order. None that touches it is left out.
  void find(const Box& box, std::vector<uint32_t>& found) const;

 private:
  static constexpr size_t kLeafSweeps = 4;
  void build(size_t node, size_t begin, size_t end);

  std::span<const stock::Sweep> sweeps_;
  std::vector<Box> boxes_;  ///< of each sweep
  /// Node n covers a half of its parent's sweeps; its children are 2n+1 and 2n+2.
  std::vector<Box> nodes_;
};

/// Least z of the cutter's flutes in its own frame, mm.
double lowest_z(const stock::CutterSolid& cutter);

/// A box around all that the cutter passes on a sweep, mm.
Box sweep_box(const stock::Sweep& sweep, const stock::CutterSolid& cutter);

/// The cutter, a cylinder around it at most, keeps farther from a ball than it moves.
bool passes_aside(const stock::Sweep& sweep, const stock::CutterSolid& cutter, const Vec3& centre,
                  double radius_mm);

}  // namespace swarf::measure
