// Light along one camera ray: direct key light, one bounce of everything else.
#pragma once

#include "render/ray/ray_scene.h"
#include "render/ray/sampler.h"
#include "render/ray/studio.h"

namespace swarf::render {

class Tracer {
 public:
  Tracer(const RayScene& scene, const Studio& studio, const StillOptions& options);

  /// Linear radiance along a camera ray; `backdrop` is what stands behind the drawing there.
  Vec3f radiance(const Vec3f& origin, const Vec3f& direction, const Vec3f& backdrop, Sampler& sampler) const;

 private:
  Vec3f solid(const Hit& hit, const Vec3f& direction, Sampler& sampler) const;
  Vec3f tube(const Hit& hit) const;
  float floor_light(const Vec3f& point, Sampler& sampler) const;
  Vec3f key_light(const Hit& hit, const Reflection& reflection, const Eigen::Matrix3f& frame,
                  const Vec3f& out, Sampler& sampler) const;
  Vec3f mirror_light(const Hit& hit, const Reflection& reflection, const Eigen::Matrix3f& frame,
                     const Vec3f& out, Sampler& sampler) const;
  Vec3f second_hit(const Vec3f& origin, const Vec3f& direction, Sampler& sampler) const;
  bool key_visible(const Hit& hit, const Vec3f& direction) const;

  const RayScene& scene_;
  const Studio& studio_;
  bool floor_;
  float floor_z_;
};

}  // namespace swarf::render
