#include "program/move_way.h"

#include <cmath>

#include "base/angles.h"

namespace swarf::program {
namespace {

/// Ends closer than this are one point, mm: the arc is a whole circle.
constexpr double kSamePoint = 1e-9;

/// Counter-clockwise about n from a to b, in [0, 2 pi).
double angle_about(const Vec3& n, const Vec3& a, const Vec3& b) {
  const double angle = signed_angle(n, a, b);
  return angle < 0.0 ? angle + kTurn : angle;
}

/// An arc from its centre, along its normal and across.
struct ArcWay {
  explicit ArcWay(const Move& move) : n(move.arc->normal_W) {
    from = across(move.from.tip_W - move.arc->centre_W);
    const Vec3 to = across(move.to.tip_W - move.arc->centre_W);
    swept = (from - to).norm() <= kSamePoint ? kTurn : angle_about(n, from, to);
    rise = (move.to.tip_W - move.from.tip_W).dot(n);
  }
  Vec3 across(const Vec3& v) const { return v - v.dot(n) * n; }

  Vec3 n, from;
  double swept = 0.0, rise = 0.0;  ///< rad, mm
};

}  // namespace

double way_mm(const Move& move) {
  if (!move.arc) return (move.to.tip_W - move.from.tip_W).norm();
  const ArcWay arc(move);
  return std::hypot(arc.from.norm() * arc.swept, arc.rise);
}

Eigen::AlignedBox3d extent_W(const Move& move) {
  Eigen::AlignedBox3d box(move.from.tip_W);
  box.extend(move.to.tip_W);
  if (!move.arc) return box;
  // Where the arc is farthest along X, Y and Z, when it passes there.
  const ArcWay arc(move);
  for (int k = 0; k < 6; ++k) {
    const Vec3 way = arc.across((k < 3 ? 1.0 : -1.0) * Vec3::Unit(k % 3));
    if (way.norm() < 1e-12) continue;
    const Vec3 spoke = arc.from.norm() * way.normalized();
    const double angle = angle_about(arc.n, arc.from, spoke);
    if (angle < arc.swept)
      box.extend(Vec3(move.from.tip_W - arc.from + spoke + angle / arc.swept * arc.rise * arc.n));
  }
  return box;
}

}  // namespace swarf::program
