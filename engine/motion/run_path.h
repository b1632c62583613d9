// A run of blocks as one smooth curve of axis values, and its cells for look-ahead.
//
//            corner                  At the end of a block the direction of q(s) breaks. From d before it to
//     block i  .+. block i+1         d after it a blend takes over that meets value, slope and bend of
//   --------x.'  '.x--------         both blocks, so that q(s) has a bounded third derivative everywhere.
//        d            d
//  d is as long as the corner tolerance allows, at most half of the shorter block. The deviation that counts
//  is the distance of the tip from where the program has it at the same s; it bounds that from the path.
//  Material is still cut along the programmed blocks (sim/job_sweeps.h): the tool that the trajectory shows
//  rounds their corners within the tolerance.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "motion/block_curve.h"
#include "motion/interpolator.h"

namespace swarf::motion {

/// A rounded corner over x = s / length: the change of slope comes with a bend that rises evenly to the
/// middle and falls evenly, so that an even speed uses the jerk all the way; a quintic carries the rest,
/// which is a straight line where both blocks are.
struct Blend {
  double length = 0.0;     ///< 2 d
  double before = 0.0;     ///< d: share of it that belongs to the block before the corner
  double deviation = 0.0;  ///< of the tip, mm
  kinematics::AxisValues coefficient[6];
  kinematics::AxisValues turn;  ///< change of slope times length
  kinematics::AxisValues q(double s) const;
};

/// Part of a run: of one block, or a rounded corner between block and the next.
struct Piece {
  size_t block = 0;   ///< index into the run
  double from = 0.0;  ///< s of the block where the piece starts
  double length = 0.0;
  int blend = -1;  ///< index into RunPath::blends
};

struct RunPath {
  std::vector<BlockCurve> curves;  ///< one per block of the run; those that go nowhere have length 0
  std::vector<Blend> blends;
  std::vector<Piece> pieces;
  std::vector<PathCell> cells;
  std::vector<size_t> piece_of_cell;
  std::vector<double> offset_of_cell;  ///< s from the start of its piece
};

/// Greatest deviation that the corner at the end of a block may have, mm.
double corner_tolerance(const toolpath::BlockMove& block, const MotionOptions& options);

/// `motions`: the blocks of one run. Where the machine does not follow a block, it stops at both ends of it.
RunPath run_path(std::span<const BlockMotion> motions, const kinematics::InverseKinematics& inverse,
                 const MotionOptions& options);

/// Block, share of it and axis values at a place.
struct PathPoint {
  size_t block = 0;  ///< index into the run
  double share = 0.0;
  bool rounded = false;  ///< the axis values are those of a rounded corner
  kinematics::AxisValues q = kinematics::AxisValues::Zero();
};
PathPoint point_at(const RunPath& path, size_t cell, double offset);

}  // namespace swarf::motion
