// Two rotary axes that point the tool: solves R(e1, t1) R(e2, t2) v = w for t1 and t2.
//
//            e1                 z = R(e2, t2) v lies on two cones at once: around e2 (as v does) and around
//            e1 |  . w             (as w does). In the frame (e1, n, k) that both axes span,
//       z .  | /                  d = e1.e2   s = |e1 x e2|   n = (e2 - d e1)/s   k = e1 x e2 / s
//          \ |/                   z = c1 e1 + p n + r k,   c1 = e1.w,  p = (c2 - d c1)/s,  c2 = e2.v
//           \+------- n           r = +-sqrt((rho - p)(rho + p)),   rho = |w - c1 e1|
//
//   t1 turns (p, r) into (w.n, w.k), t2 turns v into z; the two signs of r are the two branches.
//   (Paden & Kahan's subproblem 2, written so that nothing cancels where rho -> 0.)
//
// The pole: w along e1 (rho = 0). Then p and r vanish too, and any t1 serves. It exists when v lies on the
// cone of e2 through e1 or -e1, that is c2 = d or c2 = -d.
// Known limit: rho below kPoleTolerance counts as the pole itself.
#pragma once

#include "base/frames.h"

namespace swarf::kinematics {

/// Angle between the tool axis and the pole below which the outer rotary is free, rad: a tenth of the
/// orientation tolerance, so that every value passes the forward check, and far above the rounding of a unit
/// vector (1e-16), which would otherwise choose the angle.
inline constexpr double kPoleTolerance = 1e-13;

/// One solution: turns of the outer (next to the work) and the inner (next to the tool) axis, rad, within a
/// few turns of zero. Without default values, so that arrays of them cost nothing.
struct TurnPair {
  double outer, inner;
  bool outer_free;  ///< at the pole: the outer turn is not determined and stands at zero
};

class RotaryPair {
 public:
  RotaryPair() = default;
  /// e1, e2 and v are unit vectors, e1 and e2 not parallel, e2 and v not parallel.
  RotaryPair(const Vec3& e1, const Vec3& e2, const Vec3& v);
  /// Writes up to two solutions for the unit vector w and returns their number: 0 when w is out of reach,
  /// 1 at the pole and where both branches meet.
  int solve(const Vec3& w, TurnPair out[2]) const;
  /// Angle between w and the nearest pole, rad; infinity when the pair has none.
  double pole_distance(const Vec3& w) const;

 private:
  friend struct LaneInverse;
  Mat3 frame_ = Mat3::Identity();  ///< rows e1, n, k
  double d_ = 0.0, s_ = 1.0, c2_ = 0.0;
  double p_at_pole_[2] = {0.0, 0.0};  ///< (c2 - d)/s and (c2 + d)/s; 0: w = e1 or w = -e1 is a pole
  double d_per_s_ = 0.0, per_s_ = 1.0;
  double v_angle_ = 0.0;  ///< of v in the basis (m, -k) across e2, m = (e1 - d e2)/s
};

}  // namespace swarf::kinematics
