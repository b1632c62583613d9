// A parametric surface S(u,v) over the unit square, in the work frame, mm.
#pragma once

#include <memory>

#include "base/frames.h"

namespace swarf::surface {

/// Position and partial derivatives up to the second order at one (u,v). mm per unit parameter.
struct Derivatives {
  Vec3 S, Su, Sv, Suu, Suv, Svv;
};

/// A second derivative over a part of the parameters: it stays within `stray` of `mean`; mm.
struct Bend {
  Vec3 mean = Vec3::Zero();
  double stray = 0.0;
  double most() const { return mean.norm() + stray; }
};
/// Of Suu, Suv and Svv.
struct BendBounds {
  Bend uu, uv, vv;
};

/// Evaluation must allocate nothing: the interpolator calls it inside its cycle.
/// Parameters a little outside [0,1] are legal where the surface has a natural continuation
/// (polynomials do); passes overrun the edge of the part that way.
class Surface {
 public:
  virtual ~Surface() = default;
  virtual Vec3 point(double u, double v) const = 0;
  virtual Derivatives derivatives(double u, double v) const = 0;
  /// Proven over the rectangle low <= (u, v) <= high, which lies in [0,1]^2: what the surface does between
  /// two places is bounded by them, not sampled.
  virtual BendBounds bend_bounds(const Vec2& low, const Vec2& high) const = 0;
  /// +1 when Su x Sv points out of the material, -1 when it points in (erratum E4).
  virtual int outward_sign() const = 0;
};

using SurfacePtr = std::shared_ptr<const Surface>;

/// Unit normal that points out of the material. |Su x Sv| must not vanish.
Vec3 outward_normal(const Surface& surface, const Derivatives& d);
/// The same, `d` being those at uv: where Su x Sv vanishes (the pole of a sphere, the tip of a cone, patches
/// with three sides) the limit on the way from uv to the middle of the square. Zero, never not a number,
/// where that vanishes too: a place without a normal.
Vec3 outward_normal(const Surface& surface, const Derivatives& d, const Vec2& uv);

}  // namespace swarf::surface
