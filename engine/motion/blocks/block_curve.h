// One block as a curve of axis values q(s), s in mm: what look-ahead plans along.
//
// s measures what takes time: the way of the tip, or that of an axis counted by its speed limit, whichever is
// longer (limited_way()). So |q'| stays bounded near a pole, where s follows the axis that turns, and one
// speed along s suits blocks that follow each other.
//  1. Axes that move evenly (joint law; straight blocks that do not turn): s is an even share of the block.
//  2. Other blocks: the inverse gives q at shares x of the block by continuity. Near a pole x(s) is a spline
//     through the solution of dx/ds = 1/|dq/dx|: what limits the speed moves evenly along s, and its bend
//     does not take from its acceleration. q is always that of the exact pose at x(s), however well the
//     spline is met. Where the axis comes to within a small share of its way of a pole, or begins or ends
//     there, the spline is that of u(s), with x = centre + width sinh u: near the pole the axes turn evenly
//     by u, farther off x grows by a factor per u, so that steps of u meet every scale of the approach. Sums
//     of even steps of x or s would jump over it.
//  3. Blocks on one smooth curve (BlockLaw::kCurve): s is the way of the tip, so that q(s) runs on from
//     block to block with two continuous derivatives. Near a pole such a block is passed slowly instead of
//     stretched.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "base/cubic_spline.h"
#include "motion/blocks/pose_law.h"
#include "motion/speed/look_ahead.h"
#include "motion/speed/speed_clamps.h"

namespace swarf::motion {

/// Jumps of rotary axes count as long as this arm would swing, mm.
inline constexpr double kTurnArm = 100.0;

/// Way between two sets of axis values, mm.
double axis_way(const kinematics::MachineModel& machine, const kinematics::AxisValues& from,
                const kinematics::AxisValues& to);

/// Way of the tip over the block, mm.
double way_of_tip(const BlockMotion& motion);

class BlockCurve {
 public:
  /// Machine and inverse must outlive it. `speed_mm_s`: reference for the axes' lengths, one for all blocks
  /// of a run, about the speed of its tip.
  BlockCurve(const BlockMotion& motion, const kinematics::InverseKinematics& inverse, double speed_mm_s);

  /// A block and where it is at a share of it.
  struct Law {
    explicit Law(const BlockMotion& of) : motion(of), law(of) {}
    ToolPose at(double x) const { return law.at(motion, x); }
    void set(double x, ToolPose& pose) const { law.set(motion, x, pose); }
    BlockMotion motion;
    PoseLaw law;
  };
  /// Where the axis comes as near to a pole as a small share of the block's way: x = centre + width sinh u.
  struct Pole {
    double centre = 0.0, width = 0.0;  ///< width 0: none
    double share(double u) const { return centre + width * std::sinh(u); }
    double place(double share) const { return std::asinh((share - centre) / width); }
  };
  /// None of a block that is even.
  const Law* law() const { return law_.get(); }

  double length() const { return length_; }
  const kinematics::InverseKinematics& inverse() const { return *inverse_; }
  double tip_way() const { return tip_way_; }  ///< mm
  bool even() const { return even_; }          ///< q(s) is a straight line
  /// False where the machine does not follow: out of reach, or a jump at the pole or to the program's values.
  bool followed() const { return followed_; }
  /// The axis values at the block's end miss those of the program by this much, mm; 0 when followed.
  double jump_mm() const { return jump_mm_; }
  /// Share of the block at s.
  double share(double s) const;
  kinematics::AxisValues q(double s) const;
  /// q at s, whose share is known, for those who solve the inverse themselves, several places at once. False
  /// where there is something to solve: what follows `before` by continuity at `pose`, or, out of reach, q.
  bool is_solved(double s, double share, kinematics::AxisValues& q, ToolPose& pose,
                 kinematics::AxisValues& before) const;
  /// q and its first two derivatives by s.
  struct Jet {
    kinematics::AxisValues value, first, second;
  };
  Jet jet(double s) const;
  /// Appends the cells of [from, to] with bounds of the derivatives; speed and tip limits are those of the
  /// tip under `feed` (0: none) and the path limits.
  struct TipLimits {
    double feed_mm_s = 0.0;   ///< 0: none
    double duration_s = 0.0;  ///< 0: none
    RampLimits path;          ///< of the tip
  };
  void append_cells(double from, double to, const TipLimits& tip, std::vector<PathCell>& cells) const;
  /// Lowers speed and tip limits of a cell to those of all that append_cells() would append.
  void limit_tip(double from, double to, const TipLimits& tip, PathCell& cell) const;

 private:
  kinematics::AxisValues solve(double x, const kinematics::AxisValues& hint) const;
  kinematics::AxisValues before(double x, const kinematics::AxisValues& hint) const;
  /// The values at share x need no inverse: those of given().
  bool is_given(double x) const { return even_ || x == 0.0 || (x == 1.0 && followed_); }
  kinematics::AxisValues given(double x) const;
  const kinematics::AxisValues& nearest_node(double s) const;
  /// Length of a change of axis values over a share of the block: the tip counts 1 per mm, an axis as far as
  /// the tip would go at the reference speed while the axis needs its speed limit. Close to the greatest of
  /// all, smoothly.
  double limited_way(const kinematics::AxisValues& change, double share) const;
  void follow();
  double way_rate(const std::vector<PathNode>& nodes, size_t near, double x) const;
  void stretch(const std::vector<PathNode>& nodes);
  void follow_rate(const std::vector<PathNode>& nodes, size_t steps);
  void spread(const std::vector<PathNode>& nodes, size_t steps);
  void sample(double least);
  template <typename Visit>
  void divide(double from, double to, const Visit& visit) const;
  PathCell bounds_between(size_t from, size_t to) const;
  /// A rotary axis turns too far from this node to the next.
  bool jumps_after(size_t node) const;
  /// Greatest jump of x''' at the spline's knots near these nodes, over x'.
  double bends_of_share(size_t from, size_t to) const;

  kinematics::AxisValues q_from_, q_to_;  ///< of the block
  const kinematics::MachineModel* machine_;
  const toolpath::BlockMove& block() const { return law_->motion.block; }
  std::shared_ptr<const Law> law_;  ///< when it is not even
  const kinematics::InverseKinematics* inverse_;
  double speed_ = 0.0;
  double length_ = 0.0, tip_way_ = 0.0;
  bool even_ = false, followed_ = true, stretched_ = false;
  bool jumps_ = false;  ///< after some node
  double jump_mm_ = 0.0;
  Pole pole_;
  CubicSpline share_;                          ///< x(s), when stretched; past a narrow pole u(s)
  double share_step_ = 0.0;                    ///< between its knots
  std::vector<kinematics::AxisValues> nodes_;  ///< q at even steps of s, when not even
};

}  // namespace swarf::motion
