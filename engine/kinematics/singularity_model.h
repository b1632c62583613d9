// The analytic trajectory of So et al. near the pole, Eq. (3), for any serial chain, with errata E10 to E13.
//
// The tip as the work sees it is split at the outer rotary axis U (next to the work, direction e):
//
//     p(u) = G(u) + R(e, U(u)) M(u)
//
// G: where the axis U stands, moved by the linear axes between the work and U, hence exactly linear in u.
// M: the tip as the link of U sees it. It depends on the inner rotary axis V and the other linear axes; near
// the pole V hardly turns, so the model takes M(u) = M0 + u (M1 - M0), the only approximation. It errs by at
// most 1/8 max|M''|, which the swing of U does not enter.
//
// In the plane across e, with angles counted from x:
//     r(u) = sqrt((a0 + u a)^2 + d^2),  theta = U + phi + beta(u),  beta(u) = -s atan2(d, a0 + u a)
//     a = |M1 - M0|,  a0 = -k a,  k = -M0.(M1 - M0)/a^2,  phi = atan2(dMy, dMx)       (E11: k is not Eq.
//     (5)'s) s = sign(M0x M1y - M0y M1x)                                                     (E10) d:
//     distance of the origin from the line M0 M1, printed as b in beta             (E11)
// Where the projected curve is farthest from the projected line its tangent is parallel to it, Eq. (8):
//     F(u) = sin(U + phi - omega + beta + lambda) + (Gy' cos(omega) - Gx' sin(omega)) / n(u) = 0,
// solved by bracketing (E13: the paper's quartic through five samples is singular for k = 1/2).
#pragma once

#include "kinematics/curve_peak.h"
#include "kinematics/singularity.h"

namespace swarf::kinematics {

/// The letters of Eq. (3) as corrected; lengths mm, angles rad.
struct PolarForm {
  double a = 0.0, a0 = 0.0, k = 0.0, d = 0.0, phi = 0.0, s = 0.0;
};

class SingularityModel {
 public:
  /// The machine must have a rotary axis (SWARF_CHECK). Throws InputError "not-finite".
  SingularityModel(const MachineModel& machine, const BlockEnds& ends);

  /// Tip in W, mm.
  Vec3 tip_W(double u) const;
  /// F(u) of Eq. (8); NaN when the programmed line stands along e or the projected curve rests.
  double tangent_criterion(double u) const;
  /// Eq. (6) with P - P0 (E12): distance of tip_W(u) from the infinite programmed line, mm.
  double deviation(double u) const;
  /// The greatest deviation: the place where the projected curve is farthest from the projected line, by
  /// Eq. (8) in proven brackets, and Eq. (6) there.
  Peak greatest_deviation() const;
  /// Of the part of M across e, in the axes x, y across e. M0 = M1 (a = 0) leaves no line: k and phi are 0
  /// and d is the radius.
  PolarForm polar() const;
  /// The turn U of M about e at u, rad, as Eq. (3) counts it.
  double outer_turn(double u) const { return u0_ + u * du_; }

 private:
  struct State {
    Vec3 point, rate;  ///< in M
    Vec3 turning;      ///< part of the rate that is not G'
  };
  State at(double u) const;

  Vec3 e_, x_, y_;  ///< of U in M; x_ and y_ span the plane across
  double u0_, du_;  ///< turn of M about e, rad
  Vec3 g0_, dg_, m0_, dm_;
  Vec3 from_M_, way_M_;
  Pose X_WM_;
};

}  // namespace swarf::kinematics
