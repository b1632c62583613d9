#include "surface/surface.h"

namespace swarf::surface {

Vec3 outward_normal(const Surface& surface, const Derivatives& d) {
  return surface.outward_sign() * d.Su.cross(d.Sv).normalized();
}

Vec3 outward_normal(const Surface& surface, const Derivatives& d, const Vec2& uv) {
  // Of N = Su x Sv the first-order term along the way inwards: where N vanishes it is the limit's direction.
  // At this share of it the limit and the rounding of N err alike.
  constexpr double kVanished = 1e-8;
  const Vec2 way = Vec2(0.5, 0.5) - uv;
  const Vec3 N = d.Su.cross(d.Sv);
  const Vec3 change =
      way.x() * (d.Suu.cross(d.Sv) + d.Su.cross(d.Suv)) + way.y() * (d.Suv.cross(d.Sv) + d.Su.cross(d.Svv));
  const bool vanished = N.norm() <= kVanished * change.norm();
  return surface.outward_sign() * (vanished ? change : N).normalized();
}

}  // namespace swarf::surface
