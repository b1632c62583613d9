// Which sweeps come near a place: a tree of boxes over consecutive sweeps. Internal to this folder.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/frames.h"
#include "measure/sweep_cutters.h"
#include "stock/sweep/sweep.h"

namespace swarf::measure {

/// Half lines down from their tops, side by side: one of them, and how far the others stray from it.
struct Columns {
  Vec3 top, normal;                              ///< W, mm; unit, upwards
  double top_spread = 0.0, normal_spread = 0.0;  ///< mm; |normal' - normal|
};

/// Neighbours along the path lie near each other, so the tree halves the sweeps in their order. Borrows the
/// sweeps; sweeps[n].block is n.
class SweepIndex {
 public:
  SweepIndex(std::span<const stock::Sweep> sweeps, const SweepCutters& cutters);

  /// Appends the sweeps whose box meets `box`, in rising order. None that touches it is left out.
  void find(const Box& box, std::vector<uint32_t>& found) const;
  /// As find(box), for what may cut one of the columns below its top: most of those whose lowest plane stays
  /// above all the tops are left out, where the columns leave on the tool's side.
  void find_below(const Columns& columns, const Box& box, std::vector<uint32_t>& found) const;

 private:
  static constexpr size_t kLeafSweeps = 4, kLongGroup = 64, kShortGroup = 8;
  /// The lowest planes of a few sweeps: one pose, and how far the others stray from it.
  struct Planes {
    Vec3 axis, tip;
    double axis_spread = 0.0, tip_spread = 0.0;  ///< |axis' - axis|; mm
    double low = 0.0;                            ///< of a plane over the tip, along the axis, mm
    /// All of them keep above the tops of columns that leave on the tool's side.
    bool keep_above(const Columns& columns) const;
  };
  void build(size_t node, size_t begin, size_t end);
  Planes planes_of(const SweepCutters& cutters, size_t begin, size_t end) const;
  std::vector<Planes> planes_of_groups(const SweepCutters& cutters, size_t length) const;
  template <typename Skips>
  void visit(const Box& box, const Skips& skips, std::vector<uint32_t>& found) const;

  std::span<const stock::Sweep> sweeps_;
  std::vector<Box> boxes_;  ///< of each sweep
  /// Node n covers a half of its parent's sweeps; its children are 2n+1 and 2n+2.
  std::vector<Box> nodes_;
  std::vector<Planes> long_groups_, short_groups_;
};

/// Least z of the cutter's flutes in its own frame, mm.
double lowest_z(const stock::CutterSolid& cutter);

/// A box around all that the cutter passes on a sweep, mm.
Box sweep_box(const stock::Sweep& sweep, const stock::CutterSolid& cutter);

/// The cutter, a cylinder around it at most, keeps farther from a ball than it moves.
bool passes_aside(const stock::Sweep& sweep, const stock::CutterSolid& cutter, const Vec3& centre,
                  double radius_mm);

}  // namespace swarf::measure
