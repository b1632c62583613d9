// Polynomial surface of any degree (Lin & Koren, Eq. 3): S(u,v) = sum a_ij u^i v^j.
#pragma once

#include <vector>

#include "surface/surface.h"

namespace swarf::surface {

/// Over u, v in [0,1]; continues beyond by the same polynomial.
class PolynomialSurface final : public Surface {
 public:
  /// `coefficients[i * (degree_v + 1) + j]` multiplies u^i v^j. Degrees >= 0; `outward_sign` is +1 or -1.
  PolynomialSurface(int degree_u, int degree_v, std::vector<Vec3> coefficients, int outward_sign);
  /// From Bezier control points, same indexing.
  static PolynomialSurface from_bezier(int degree_u, int degree_v, const std::vector<Vec3>& control_points,
                                       int outward_sign);

  Vec3 point(double u, double v) const override;
  Derivatives derivatives(double u, double v) const override;
  /// From the Taylor polynomial about the rectangle's centre: exact for quadratic surfaces.
  BendBounds bend_bounds(const Vec2& low, const Vec2& high) const override;
  int outward_sign() const override { return outward_sign_; }

  int degree_u() const { return degree_u_; }
  int degree_v() const { return degree_v_; }
  const std::vector<Vec3>& coefficients() const { return coefficients_; }

 private:
  int degree_u_, degree_v_;
  std::vector<Vec3> coefficients_;  ///< mm; of u^i v^j at i (degree_v + 1) + j
  int outward_sign_;                ///< of S_u x S_v against the outward normal
};

}  // namespace swarf::surface
