// Bounds of the distance of two bodies over spans of time. Internal to this folder.
#pragma once

#include <vector>

#include "collision/closest_approach.h"
#include "collision/convex_distance.h"

namespace swarf::collision {

/// Between two instants of a segment: where the moving body stands at both.
struct Span {
  double t0 = 0.0, t1 = 1.0;
  Pose first = Pose::Identity(), last = Pose::Identity();  ///< moving body's home drawing -> the still one's
  Mat3 turned_first, turned_last, turned_between;          ///< absolute values of the rotations
  bool aligned = false;                                    ///< `first` does not turn
  double square = 0.0;                                     ///< (t1 - t0)^2 / 8
  /// What the motion may take off a gap along the still body's axes, and along the moving one's at t0, mm.
  Vec3 slack = Vec3::Zero(), slack_turned = Vec3::Zero();
  int32_t child = -1;  ///< index of its first half; the other follows
};

/// A box of each body over a span.
struct Triple {
  double lower = 0.0;  ///< mm
  int32_t still = 0, moving = 0, span = 0;
};

/// Two primitives over a span.
struct LeafDistance {
  double lower = 0.0, upper = 0.0;  ///< mm; the upper one at t, of the straight line of axis values
  double stray = 0.0;               ///< mm that was taken off the lower one because the axes stray
  double sagitta = 0.0;             ///< mm, at most taken off it because the motion is not straight
  double t = 0.0;
  Vec3 home_still = Vec3::Zero(), home_moving = Vec3::Zero();
};

class SpaceTime {
 public:
  /// Whichever body has the smaller bounds of motion is the moving one.
  SpaceTime(const Encounter& pair, const AxisSegment& segment);

  /// Of the two bodies of the encounter the first one moves.
  bool a_moves() const { return moving_ == pair_.a; }
  const Span& span(int32_t at) const { return spans_[static_cast<size_t>(at)]; }
  const MotionBounds& motion() const { return bounds_; }
  /// Greatest way of any point over the span, mm.
  double travel(int32_t span) const;
  bool is_leaf_pair(const Triple& triple) const;

  /// All of both bodies over the whole segment.
  Triple root();
  /// Appends what the triple is split into, none with a bound below its own.
  void split(const Triple& triple, std::vector<Triple>& parts);
  void split_time(const Triple& triple, std::vector<Triple>& parts);
  /// `enough`: the lower bound need not be better.
  LeafDistance leaf_distance(const Triple& triple, double enough) const;
  LeafDistance leaf_distance(uint32_t still, uint32_t moving, int32_t span, double enough) const;
  /// Puts the points of a leaf pair into M.
  void tell_points(const LeafDistance& found, Vec3& point_a, Vec3& point_b) const;
  PrimitivePair pair_of(const Triple& triple) const;

 private:
  Span make_span(double t0, double t1, const Pose& first, const Pose& last) const;
  void halve_span(int32_t span);
  double bound(int32_t still, int32_t moving, const Span& span) const;
  void add_part(int32_t still, int32_t moving, int32_t span, double least, std::vector<Triple>& parts) const;

  const Encounter& pair_;
  AxisSegment segment_;
  const Body *still_, *moving_;
  const RelativeMotion* motion_;
  MotionBounds bounds_;
  std::vector<Span> spans_;
};

}  // namespace swarf::collision
