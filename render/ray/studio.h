// The lights of the studio and the surfaces' reflection of them.
#pragma once

#include <vector>

#include "render/ray/ray_scene.h"
#include "render/ray/still.h"

namespace swarf::render {

/// Two unit vectors that complete `n` to a right-handed frame (columns t, b, n).
Eigen::Matrix3f frame_about(const Vec3f& n);

/// The surroundings at infinity: sky, strip lights, floor colour below the horizon, and the key light's disc.
class Studio {
 public:
  explicit Studio(const StillOptions& options);

  /// Radiance from direction d (unit), without the key light.
  float surroundings(const Vec3f& d) const;
  /// Mean of the surroundings over the directions about n (unit), by cosine: irradiance / pi of a surface
  /// that nothing shades. From a table, within 2.5 %, mostly 1 %.
  float irradiance(const Vec3f& n) const;
  /// Mean radiance over the upper half, what a floor point sees of the sky.
  float mean_sky() const { return sky_; }
  /// A direction in the key light's disc, uniform in solid angle.
  Vec3f sample_key(const Eigen::Vector2f& xi) const;
  bool in_key(const Vec3f& d) const { return d.dot(key_axis_) > key_cosine_; }
  float key_radiance() const { return key_radiance_; }
  float key_pdf() const { return key_pdf_; }
  /// Irradiance / pi that the key light gives a surface facing it.
  float key_strength() const { return key_strength_; }
  const Vec3f& key_axis() const { return key_axis_; }

 private:
  float irradiance_about(const Vec3f& n) const;
  float strip_light(const Vec3f& d) const;
  float panel_light(const Vec3f& d) const;

  Vec3f key_axis_, strip_axis_;
  Eigen::Matrix3f key_frame_;
  float key_cosine_, key_radiance_, key_pdf_, key_strength_;
  float sky_, strip_period_, strip_strength_;
  std::vector<float> irradiance_;  ///< on the octahedron of directions, row by row
};

/// Reflection of a surface: Lambert under a GGX coat (Walter et al. 2007; Smith shadowing, Schlick's
/// Fresnel).
struct Reflection {
  Vec3f diffuse;   ///< albedo of the diffuse part
  Vec3f specular;  ///< reflectance at normal incidence
  float alpha;     ///< GGX width, roughness squared

  explicit Reflection(const Hit& hit);
  /// Specular reflectance times cosine for directions in the frame of the normal (z = normal), both upwards.
  Vec3f specular_times_cosine(const Vec3f& out, const Vec3f& in) const;
  float specular_pdf(const Vec3f& out, const Vec3f& in) const;
};

/// A direction in which a surface mirrors, and the share of light from there that it gives back.
struct Mirrored {
  Vec3f in;  ///< in the frame of the normal; z may be <= 0: no reflection
  Vec3f weight;
};

/// Reflected directions for one direction to the eye, distributed as specular_pdf (visible normals, Heitz
/// 2018).
class MirrorLobe {
 public:
  MirrorLobe(const Reflection& reflection, const Vec3f& out);
  Mirrored sample(const Eigen::Vector2f& xi) const { return sample(xi, 0, 1); }
  /// The k-th of `count` that cover the lobe evenly, the first at xi.
  Mirrored sample(const Eigen::Vector2f& xi, int k, int count) const;

 private:
  const Reflection& reflection_;
  Vec3f out_;
  Eigen::Matrix3f frame_;
};

Vec3f sample_cosine(const Eigen::Vector2f& xi);

}  // namespace swarf::render
