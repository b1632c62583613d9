// A run of blocks as one smooth curve of axis values, and its cells for look-ahead.
//
//            corner                  At the end of a block the direction of q(s) breaks. From d before it to
//     block i  .+. block i+1         d after it a blend takes over that meets value, slope and bend of
//   --------x.'  '.x--------         both blocks, so that q(s) has a bounded third derivative everywhere.
//        d            d
//  d is as long as the corner tolerance allows, at most half of the shorter block. The deviation that counts
//  is the distance of the tip from where the program has it at the same s; it bounds that from the path.
//  Material is still cut along the programmed blocks (sim/run/job_sweeps.h): the tool that the trajectory
//  shows rounds their corners within the tolerance.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "kinematics/forward_chain.h"
#include "motion/blocks/block_curve.h"
#include "motion/blocks/block_motions.h"
#include "motion/options.h"
#include "toolpath/tool_path.h"

namespace swarf::motion {

/// A rounded corner over x = s / length: the change of slope comes with a bend that rises evenly to the
/// middle and falls evenly, so that an even speed uses the jerk all the way; a quintic carries the rest,
/// which is a straight line where both blocks are.
struct Blend {
  double length = 0.0;     ///< 2 d
  double before = 0.0;     ///< d: share of it that belongs to the block before the corner
  double deviation = 0.0;  ///< of the tip, mm
  std::array<kinematics::AxisValues, 6> coefficient;
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

/// Of a run, or of a stretch of it. Blocks are counted from the start of the run.
struct RunPath {
  size_t first = 0;                ///< block of curves.front()
  std::vector<BlockCurve> curves;  ///< one per block; those that go nowhere have length 0
  std::vector<Blend> blends;
  std::vector<Piece> pieces;
  std::vector<PathCell> cells;
  std::vector<size_t> piece_of_cell;
  std::vector<double> offset_of_cell;  ///< s from the start of its piece
  const BlockCurve& curve(size_t block) const { return curves[block - first]; }
};

/// Greatest deviation that the corner at the end of a block may have, mm.
double corner_tolerance(const toolpath::BlockMove& block, const MotionOptions& options);

/// The start of a cell: from here a run's path can be made again.
struct PathPlace {
  std::optional<size_t> before;  ///< block whose piece and corner are next; none at the start of the run
  size_t next = 0;               ///< first block behind it that has not been looked at
  double from = 0.0;             ///< s of `before` where its own piece starts
  size_t skip = 0;               ///< cells between there and the place
};

/// The path of one run, made cell by cell from any place on.
class RunPathBuilder {
 public:
  /// `motions`: the blocks of one run; machines, inverse and options must outlive it. Where the machine does
  /// not follow a block, it stops at both ends of it.
  RunPathBuilder(const BlockMotions& motions, const kinematics::InverseKinematics& inverse,
                 const MotionOptions& options, const PathPlace& start = {});

  /// Goes on until there are so many cells or the run is over.
  void extend(size_t cells);
  bool at_end() const { return done_; }
  const RunPath& path() const { return path_; }
  const AxisLimits& limits() const { return limits_; }
  /// The start of one of the path's cells.
  PathPlace place(size_t cell) const;
  /// Hands over the path and goes on without its first cells.
  RunPath take(size_t cells);

 private:
  double reference_speed() const;
  void look_at(size_t block);
  const BlockCurve& curve(size_t block);
  BlockCurve::TipLimits tip_limits(size_t block) const;
  void add_cells(size_t first);
  void add_block_piece(size_t block, double from, double to);
  double add_corner(size_t a, size_t b);
  void limit_tip(size_t a, size_t b, PathCell& cell) const;
  std::optional<Blend> fit(size_t a, size_t b) const;
  /// Two blocks that meet in a corner.
  struct Corner {
    const BlockCurve &in, &out;
    const BlockCurve::Law &in_law, &out_law;
  };
  double deviation(const Corner& corner, const Blend& blend) const;

  BlockMotions motions_;
  const kinematics::InverseKinematics& inverse_;
  const MotionOptions& options_;
  const kinematics::MachineModel& machine_;
  kinematics::ForwardChain forward_;
  AxisLimits limits_;
  bool rapid_ = false, done_ = false;
  double reference_mm_s_ = 0.0;
  PathPlace at_;  ///< skip: cells of this corner so far
  RunPath path_;
  std::vector<PathPlace> place_of_piece_;  ///< of its first cell
};

/// Block, share of it and axis values at a place.
struct PathPoint {
  size_t block = 0;  ///< index into the run
  double share = 0.0;
  bool rounded = false;  ///< the axis values are those of a rounded corner
  kinematics::AxisValues q = kinematics::AxisValues::Zero();
  std::optional<ToolPose> pose;  ///< of the block, where it had to be found
};
PathPoint point_at(const RunPath& path, size_t cell, double offset);

struct CellOffset {
  size_t cell = 0;
  double offset = 0.0;  ///< mm from its start
};
/// Points whose inverse is to be solved side by side.
struct OpenPoints {
  static constexpr size_t kMost = 32;
  std::array<PathPoint*, kMost> point;
  std::array<ToolPose, kMost> pose;
  std::array<kinematics::AxisValues, kMost> before;
  std::array<kinematics::Branch, kMost> found;
  size_t count = 0;
  void solve(const kinematics::InverseKinematics& inverse);
};
/// The same of several places. `open`: room that needs not be made for each call.
void points_at(const RunPath& path, std::span<const CellOffset> places, std::span<PathPoint> points,
               OpenPoints& open);

}  // namespace swarf::motion
