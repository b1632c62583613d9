// Light along one camera ray: direct key light, one bounce of everything else.
#pragma once

#include "render/ray/ray_scene.h"
#include "render/ray/sampler.h"
#include "render/ray/studio.h"

namespace swarf::render {

/// What a camera ray meets. The light that reaches a matt surface from all around, and what a dull one
/// mirrors, is kept apart: it hardly changes from pixel to pixel, so that neighbours can share their samples
/// (ambient_filter.h).
struct Seen {
  Vec3f light = Vec3f::Zero();    ///< linear radiance, without `sheen` and the share of `ambient`
  Vec3f ambient = Vec3f::Zero();  ///< a sample of the light from all around, where one was asked for
  Vec3f matt = Vec3f::Zero();     ///< the share of it that the surface gives back
  Vec3f sheen = Vec3f::Zero();    ///< a sample of what a dull surface mirrors, where one was asked for
  bool dull = false;              ///< a surface with `sheen`
  Vec3f normal = Vec3f::Zero(), position = Vec3f::Zero();  ///< of the surface; zero: the backdrop
  bool empty = false;                                      ///< backdrop, or a floor without a trace of shadow
};

/// How often of late a ray left the drawing: as far as it does, what it brings is known without it
/// (Tracer::solid). A running mean over the samples before, in the order in which they are taken.
class Openness {
 public:
  void add(bool left) { share_ += ((left ? 1.0F : 0.0F) - share_) / kSamples; }
  float share() const { return share_; }

 private:
  static constexpr float kSamples = 16.0F;
  float share_ = 0.5F;
};

/// Of what polished surfaces mirror, and of the light from all around matt ones.
struct Openings {
  Openness mirrored, around;
};

class Tracer {
 public:
  Tracer(const RayScene& scene, const Studio& studio, const StillOptions& options);

  /// One sample along a camera ray; `backdrop` is what stands behind the drawing there. `with_shared`: with a
  /// sample of what neighbours share. `openings`: of the samples before, nearby; takes in this one.
  Seen look(const Vec3f& origin, const Vec3f& direction, const Vec3f& backdrop, bool with_shared,
            Sampler& sampler, Openings& openings) const;

 private:
  struct Arriving {
    Vec3f light = Vec3f::Zero();
    bool left = false;  ///< it comes from the surroundings
  };
  Seen solid(const Hit& hit, const Vec3f& direction, bool with_shared, Sampler& sampler,
             Openings& openings) const;
  Vec3f ambient(const Hit& hit, const Vec3f& normal, const Vec3f& in, Sampler& sampler, Openness& open) const;
  Vec3f drawn(const Hit& hit) const;
  Seen floor(const Vec3f& point, const Vec3f& backdrop, bool with_shared, Sampler& sampler) const;
  Vec3f key_light(const Hit& hit, const Reflection& reflection, const Eigen::Matrix3f& frame,
                  const Vec3f& out, Sampler& sampler) const;
  Arriving mirror_light(const Hit& hit, const Reflection& reflection, const Eigen::Matrix3f& frame,
                        const Vec3f& out, const Eigen::Vector2f& xi, Sampler& sampler) const;
  Vec3f polish(const Hit& hit, const Reflection& reflection, const Eigen::Matrix3f& frame, const Vec3f& out,
               Sampler& sampler, Openness& open) const;
  Arriving second_hit(const Vec3f& origin, const Vec3f& direction, Sampler& sampler) const;
  bool key_visible(const Hit& hit, const Vec3f& direction) const;

  const RayScene& scene_;
  const Studio& studio_;
  bool floor_;
  float floor_z_;
};

}  // namespace swarf::render
