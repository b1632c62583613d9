#include "flank/extended_surface.h"

#include <algorithm>
#include <utility>

namespace swarf::flank {
namespace {

class ExtendedSurface final : public surface::Surface {
 public:
  explicit ExtendedSurface(surface::SurfacePtr inner) : inner_(std::move(inner)) {}

  Vec3 point(double u, double v) const override { return derivatives(u, v).S; }
  surface::Derivatives derivatives(double u, double v) const override {
    const double at = std::clamp(u, 0.0, 1.0);
    surface::Derivatives d = inner_->derivatives(at, v);
    if (u == at) return d;
    d.S += (u - at) * d.Su;
    d.Sv += (u - at) * d.Suv;
    d.Suu.setZero();
    return d;
  }
  surface::BendBounds bend_bounds(const Vec2& low, const Vec2& high) const override {
    return inner_->bend_bounds(low, high);
  }
  int outward_sign() const override { return inner_->outward_sign(); }

 private:
  surface::SurfacePtr inner_;
};

}  // namespace

surface::SurfacePtr extended(surface::SurfacePtr surface) {
  return std::make_shared<ExtendedSurface>(std::move(surface));
}

}  // namespace swarf::flank
