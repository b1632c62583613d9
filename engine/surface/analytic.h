// Analytic designs with exact derivatives: the plane and surfaces of revolution. Their exact shapes are the
// oracles of theory 6.
#pragma once

#include <functional>

#include "surface/surface.h"

namespace swarf::surface {

/// Where the material is: convex surfaces hold it inside (a shaft), concave ones outside (a bore).
enum class MaterialSide { kConvex, kConcave };

/// S = origin + u along_u + v along_v; the material lies against along_u x along_v.
class PlaneSurface final : public Surface {
 public:
  /// mm; the two directions must not be parallel.
  PlaneSurface(const Vec3& origin, const Vec3& along_u, const Vec3& along_v);
  Vec3 point(double u, double v) const override;
  Derivatives derivatives(double u, double v) const override;
  BendBounds bend_bounds(const Vec2&, const Vec2&) const override { return {}; }
  int outward_sign() const override { return 1; }

 private:
  Vec3 origin_, along_u_, along_v_;  ///< W, mm
};

/// Radius and height of a meridian and their first two derivatives by its parameter v in [0,1].
struct Meridian {
  double r = 0.0, dr = 0.0, ddr = 0.0;
  double z = 0.0, dz = 0.0, ddz = 0.0;
};

/// Upper bounds of |r|, |dr| and |(ddr, ddz)| over the whole meridian.
struct MeridianBounds {
  double r = 0.0, dr = 0.0, bend = 0.0;
};

/// Where a surface of revolution stands and how far round it goes.
struct Turn {
  Vec3 base_W = Vec3::Zero();                              ///< z = 0 of the meridian
  Vec3 axis_W = Vec3::UnitZ();                             ///< unit, the meridian's z
  double from_rad = 0.0, to_rad = 6.28318530717958647692;  ///< about the axis, from x_W as seen square to it
};

/// S(u,v) = base + r(v) (cos(phi) X + sin(phi) Y) + z(v) A, phi linear in u. z must rise with v and r stay
/// above 0. X is the part of (1,0,0) square to the axis, or of (0,1,0) where the axis lies near (1,0,0).
class RevolvedSurface final : public Surface {
 public:
  RevolvedSurface(const Turn& turn, std::function<Meridian(double)> meridian, const MeridianBounds& bounds,
                  MaterialSide side);
  Vec3 point(double u, double v) const override;
  Derivatives derivatives(double u, double v) const override;
  BendBounds bend_bounds(const Vec2& low, const Vec2& high) const override;
  int outward_sign() const override { return side_ == MaterialSide::kConvex ? 1 : -1; }

 private:
  Turn turn_;
  Vec3 x_W_, y_W_;                            ///< square to the axis, right-handed with it
  std::function<Meridian(double)> meridian_;  ///< by v in [0,1]
  MeridianBounds bounds_;
  MaterialSide side_;
};

/// Radius > 0, height > 0, mm.
SurfacePtr cylinder_surface(const Turn& turn, double radius, double height, MaterialSide side);

/// Frustum: radius at the base, half angle (above 0: it narrows along the axis), height. The radius at the
/// top must stay above 0.
SurfacePtr cone_surface(const Turn& turn, double base_radius, double half_angle_rad, double height,
                        MaterialSide side);

/// Sphere about turn.base_W between two polar angles from the axis, 0 < from < to < pi (the poles have no
/// parameters).
SurfacePtr sphere_surface(const Turn& turn, double radius, double polar_from_rad, double polar_to_rad,
                          MaterialSide side);

/// The core that a skew cylinder leaves when the table turns under it (theory 6): its axis passes through
/// (distance, 0, 0) along (0, sin g, cos g) as seen from base_W, radius `cutter_radius`.
struct Hyperboloid {
  double distance = 30.0;      ///< mm
  double skew_rad = 0.35;      ///< between the cylinder's axis and the table's
  double cutter_radius = 5.0;  ///< mm
};
/// Radius and height of the contact at s mm along the cylinder's axis, with derivatives by s.
Meridian hyperboloid_meridian(const Hyperboloid& shape, double s);
/// Its part between two heights over base_W. distance > cutter_radius; 0 < |skew| < pi/2.
SurfacePtr hyperboloid_surface(const Turn& turn, const Hyperboloid& shape, double z_low, double z_high);

}  // namespace swarf::surface
