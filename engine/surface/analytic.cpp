#include "surface/analytic.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "base/check.h"
#include "base/units.h"

namespace swarf::surface {
namespace {

/// The parameter s at which the meridian of the hyperboloid has this height. dz/ds >= cos g > 0, so bisection
/// has one root; |z| <= r + |s| cos g bounds it.
double hyperboloid_parameter(const Hyperboloid& shape, double z) {
  const double reach = (std::abs(z) + shape.cutter_radius) / std::cos(shape.skew_rad) + 1.0;
  double low = -reach, high = reach;
  for (int i = 0; i < 200 && high - low > 1e-14 * reach; ++i) {
    const double middle = 0.5 * (low + high);
    (hyperboloid_meridian(shape, middle).z < z ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

PlaneSurface::PlaneSurface(const Vec3& origin, const Vec3& along_u, const Vec3& along_v)
    : origin_(origin), along_u_(along_u), along_v_(along_v) {
  SWARF_CHECK(along_u.cross(along_v).norm() > 0.0, "a plane needs two directions");
}

Vec3 PlaneSurface::point(double u, double v) const {
  return origin_ + u * along_u_ + v * along_v_;
}

Derivatives PlaneSurface::derivatives(double u, double v) const {
  const Vec3 none = Vec3::Zero();
  return {point(u, v), along_u_, along_v_, none, none, none};
}

RevolvedSurface::RevolvedSurface(const Turn& turn, std::function<Meridian(double)> meridian,
                                 const MeridianBounds& bounds, MaterialSide side)
    : turn_(turn), meridian_(std::move(meridian)), bounds_(bounds), side_(side) {
  SWARF_CHECK(std::abs(turn.axis_W.norm() - 1.0) < 1e-9,
              "the axis of a surface of revolution is a unit vector");
  SWARF_CHECK(turn.to_rad > turn.from_rad, "a surface of revolution goes round positively");
  constexpr double kNearX = 0.9;
  const Vec3 seed = std::abs(turn.axis_W.x()) < kNearX ? Vec3::UnitX() : Vec3::UnitY();
  x_W_ = (seed - seed.dot(turn.axis_W) * turn.axis_W).normalized();
  y_W_ = turn.axis_W.cross(x_W_);
}

Vec3 RevolvedSurface::point(double u, double v) const {
  const Meridian m = meridian_(v);
  const double phi = turn_.from_rad + u * (turn_.to_rad - turn_.from_rad);
  return turn_.base_W + m.r * (std::cos(phi) * x_W_ + std::sin(phi) * y_W_) + m.z * turn_.axis_W;
}

Derivatives RevolvedSurface::derivatives(double u, double v) const {
  const Meridian m = meridian_(v);
  const double rate = turn_.to_rad - turn_.from_rad;
  const double phi = turn_.from_rad + u * rate;
  const Vec3 radial = std::cos(phi) * x_W_ + std::sin(phi) * y_W_;
  const Vec3 round = -std::sin(phi) * x_W_ + std::cos(phi) * y_W_;
  const Vec3& axis = turn_.axis_W;
  return {turn_.base_W + m.r * radial + m.z * axis,
          m.r * rate * round,
          m.dr * radial + m.dz * axis,
          -m.r * rate * rate * radial,
          m.dr * rate * round,
          m.ddr * radial + m.ddz * axis};
}

BendBounds RevolvedSurface::bend_bounds(const Vec2& low, const Vec2& high) const {
  const Vec2 centre = 0.5 * (low + high), half = 0.5 * (high - low);
  const Derivatives d = derivatives(centre.x(), centre.y());
  const double rate = turn_.to_rad - turn_.from_rad, turn = rate * half.x();
  // Suu and Suv turn with the radius and grow by what the meridian moves; of Svv only the size is known.
  return {{d.Suu, rate * rate * bounds_.dr * half.y() + d.Suu.norm() * turn},
          {d.Suv, rate * bounds_.bend * half.y() + d.Suv.norm() * turn},
          {Vec3::Zero(), bounds_.bend}};
}

SurfacePtr cylinder_surface(const Turn& turn, double radius, double height, MaterialSide side) {
  return cone_surface(turn, radius, 0.0, height, side);
}

SurfacePtr cone_surface(const Turn& turn, double base_radius, double half_angle_rad, double height,
                        MaterialSide side) {
  const double narrowing = height * std::tan(half_angle_rad);
  SWARF_CHECK(height > 0.0 && base_radius > 0.0 && base_radius > narrowing,
              "a cone needs a radius everywhere");
  return std::make_shared<RevolvedSurface>(
      turn,
      [=](double v) {
        return Meridian{base_radius - v * narrowing, -narrowing, 0.0, v * height, height, 0.0};
      },
      MeridianBounds{std::max(base_radius, base_radius - narrowing), std::abs(narrowing), 0.0}, side);
}

SurfacePtr sphere_surface(const Turn& turn, double radius, double polar_from_rad, double polar_to_rad,
                          MaterialSide side) {
  SWARF_CHECK(radius > 0.0 && 0.0 < polar_from_rad && polar_from_rad < polar_to_rad && polar_to_rad < kPi,
              "a sphere between two polar angles");
  const double rate = polar_from_rad - polar_to_rad;  // so that z rises with v
  return std::make_shared<RevolvedSurface>(
      turn,
      [=](double v) {
        const double polar = polar_to_rad + v * rate;
        const double sine = radius * std::sin(polar), cosine = radius * std::cos(polar);
        return Meridian{sine,   cosine * rate, -sine * rate * rate,
                        cosine, -sine * rate,  -cosine * rate * rate};
      },
      MeridianBounds{radius, radius * std::abs(rate), radius * rate * rate}, side);
}

Meridian hyperboloid_meridian(const Hyperboloid& shape, double s) {
  // rho = rho0 - r c/m, z = s c + r k/m with rho0^2 = d^2 + s^2 S, k = rho0' = s S/rho0, m^2 = c^2 + k^2
  // (theory 6), S = sin^2 g, c = cos g. Primes are by s.
  const double d2 = shape.distance * shape.distance, r = shape.cutter_radius;
  const double c = std::cos(shape.skew_rad), S = 1.0 - c * c;
  const double rho0 = std::sqrt(d2 + s * s * S);
  const double k = s * S / rho0;
  const double dk = S * d2 / (rho0 * rho0 * rho0);
  const double ddk = -3.0 * k * dk / rho0;
  const double m = std::sqrt(c * c + k * k);
  const double m3 = m * m * m, m5 = m3 * m * m;
  const double d_1_m = -k * dk / m3;
  const double dd_1_m = -(dk * dk + k * ddk) / m3 + 3.0 * k * k * dk * dk / m5;
  const double d_k_m = c * c * dk / m3;
  const double dd_k_m = c * c * (ddk / m3 - 3.0 * k * dk * dk / m5);
  return {rho0 - r * c / m,  k - r * c * d_1_m, dk - r * c * dd_1_m,
          s * c + r * k / m, c + r * d_k_m,     r * dd_k_m};
}

namespace {

/// Over |s| <= reach, with rho0 >= d, |k| <= sin g, dk <= S/d, |ddk| <= 3 k dk / d and m >= c: term by term
/// what hyperboloid_meridian adds up. `rate`: ds/dv.
MeridianBounds hyperboloid_bounds(const Hyperboloid& shape, double reach, double rate) {
  const double d = shape.distance, r = shape.cutter_radius;
  const double c = std::cos(shape.skew_rad), S = 1.0 - c * c;
  const double rho0 = std::sqrt(d * d + reach * reach * S);
  const double k = std::min(std::sqrt(S), reach * S / d), dk = S / d, ddk = 3.0 * k * dk / d;
  const double c3 = c * c * c, c5 = c3 * c * c;
  const double d_1_m = k * dk / c3, dd_1_m = (dk * dk + k * ddk) / c3 + 3.0 * k * k * dk * dk / c5;
  const double dd_k_m = c * c * (ddk / c3 + 3.0 * k * dk * dk / c5);
  return {rho0 + r, (k + r * c * d_1_m) * rate, std::hypot(dk + r * c * dd_1_m, r * dd_k_m) * rate * rate};
}

}  // namespace

SurfacePtr hyperboloid_surface(const Turn& turn, const Hyperboloid& shape, double z_low, double z_high) {
  SWARF_CHECK(shape.distance > shape.cutter_radius && shape.cutter_radius > 0.0 && z_low < z_high,
              "a hyperboloid needs a core and a height");
  const double from = hyperboloid_parameter(shape, z_low);
  const double rate = hyperboloid_parameter(shape, z_high) - from;
  return std::make_shared<RevolvedSurface>(
      turn,
      [=](double v) {
        Meridian m = hyperboloid_meridian(shape, from + v * rate);
        m.dr *= rate;
        m.ddr *= rate * rate;
        m.dz *= rate;
        m.ddz *= rate * rate;
        return m;
      },
      hyperboloid_bounds(shape, std::max(std::abs(from), std::abs(from + rate)), std::abs(rate)),
      MaterialSide::kConvex);
}

}  // namespace swarf::surface
