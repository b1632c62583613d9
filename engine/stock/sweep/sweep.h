// Sweeps: what the cutter passes through between two poses, and how ticks are merged into them.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/frames.h"
#include "cutter/convex_piece.h"
#include "cutter/cutter.h"

namespace swarf::stock {

/// The cutter moves from start to end; a point of the work moves on a straight line in the tool's frame
/// (exact for translation; with rotation theta its error is theta^2 * lever / 8, see merge_sweeps).
struct Sweep {
  ToolPose start, end;
  uint32_t block = 0;  ///< caller's id: which samples or block this is
};

/// The cutting part (flutes only) as a solid of revolution standing on the tip: a union of convex pieces.
struct CutterSolid {
  double radius = 5.0;   ///< greatest, mm
  double height = 25.0;  ///< of the flutes, mm
  std::vector<cutter::ConvexPiece> pieces;

  /// A flat end mill.
  CutterSolid(double flat_radius = 5.0, double flute_height = 25.0);
  /// The flutes of any cutter without problems.
  explicit CutterSolid(const cutter::Cutter& cutter);
  /// One piece that is a plain cylinder: the kernels know it in closed form.
  bool is_cylinder() const { return pieces.size() == 1 && pieces.front().is_cylinder(); }
};

/// Poses of consecutive ticks joined greedily into as few sweeps as the tolerance allows.
struct MergedSweeps {
  std::vector<Sweep> sweeps;  ///< Sweep::block = index of the last pose it covers
  double error_bound_mm =
      0.0;  ///< greatest distance between a point of the swept cutter and the tick-wise motion
};
/// `breaks[i]` true: pose i starts a new chain (nothing is swept from i-1 to i). Lever: distance from the tip
/// to the farthest point of the cutter that can touch material.
MergedSweeps merge_sweeps(std::span<const ToolPose> poses, std::span<const uint8_t> breaks, double lever_mm,
                          double tolerance_mm);

/// What merged sweeps err by at most: where poses are left out, and between two poses; both add up.
struct MergeBound {
  double chain_mm = 0.0, tick_mm = 0.0;
};
/// A sweep from one pose to another, by their numbers.
using SweepVisitor = std::function<void(size_t from, size_t to)>;
/// The same for one chain of `count` poses, each asked for once and in order; those of one sweep are held.
MergeBound merge_chain(size_t count, const std::function<ToolPose(size_t)>& pose, double lever_mm,
                       double tolerance_mm, const SweepVisitor& visit);

}  // namespace swarf::stock
