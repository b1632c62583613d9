#include "render/ray/tracer.h"

#include <algorithm>

#include "base/units.h"

namespace swarf::render {
namespace {

constexpr auto kPiSingle = static_cast<float>(kPi);
/// Share of a line's colour that glows by itself, so that lines stay legible in shadow.
constexpr float kLineGlow = 0.7F;
/// What a metal met by a secondary ray mirrors, relative to the surroundings in that direction.
constexpr float kSecondMirror = 0.8F;

/// Rougher surfaces mirror so blurred that neighbours share it: their lobes are 15 degrees wide and more.
constexpr float kDullRoughness = 0.35F;

/// Directions in which a polished surface looks at the surroundings, for one ray.
constexpr int kMirrors = 4;
/// Where fewer rays leave the drawing than this, what is known of the surroundings is hardly of use.
constexpr float kLeastOpen = 0.25F;

/// The shading normal, bent towards the viewer when interpolation turned it away.
Vec3f facing_normal(const Hit& hit, const Vec3f& out) {
  constexpr float kGrazing = 1e-3F;
  const float cosine = hit.normal.dot(out);
  if (cosine > kGrazing) return hit.normal;
  return (hit.normal + (kGrazing - cosine) * out).normalized();
}

}  // namespace

Tracer::Tracer(const RayScene& scene, const Studio& studio, const StillOptions& options)
    : scene_(scene),
      studio_(studio),
      floor_(options.floor && !options.transparent),
      floor_z_(scene.lowest_z()) {}

Seen Tracer::look(const Vec3f& origin, const Vec3f& direction, const Vec3f& backdrop, bool with_shared,
                  Sampler& sampler, Openings& openings) const {
  Seen seen;
  if (const auto hit = scene_.nearest(origin, direction, true)) {
    if (!hit->drawn) return solid(*hit, direction, with_shared, sampler, openings);
    seen.light = drawn(*hit);
    return seen;
  }
  const float height = origin.z() - floor_z_;
  if (floor_ && direction.z() < 0.0F && height > 0.0F)
    return floor(origin + height / -direction.z() * direction, backdrop, with_shared, sampler);
  seen.light = backdrop;
  seen.empty = true;
  return seen;
}

/// Light that reaches a floor point over what an empty studio would give it: the backdrop without shadow.
Seen Tracer::floor(const Vec3f& point, const Vec3f& backdrop, bool with_shared, Sampler& sampler) const {
  const Vec3f start = point + scene_.offset() * Vec3f::UnitZ();
  const Vec3f to_key = studio_.sample_key(sampler.next());
  const Vec3f to_sky = sample_cosine(sampler.next());
  const float key = studio_.key_strength() * std::max(0.0F, studio_.key_axis().z());
  const float all = key + studio_.mean_sky();
  const bool key_seen = !scene_.occluded(start, to_key);
  const bool sky_seen = !with_shared || !scene_.occluded(start, to_sky);
  Seen seen;
  if (key_seen) seen.light = (key / all) * backdrop;
  if (sky_seen) seen.ambient = Vec3f::Ones();
  seen.matt = (studio_.mean_sky() / all) * backdrop;
  seen.normal = Vec3f::UnitZ();
  seen.position = point;
  seen.empty = key_seen && sky_seen;
  return seen;
}

Vec3f Tracer::drawn(const Hit& hit) const {
  const float facing = 0.5F + 0.5F * hit.normal.dot(studio_.key_axis());
  return (kLineGlow + (1.0F - kLineGlow) * facing) * hit.colour;
}

bool Tracer::key_visible(const Hit& hit, const Vec3f& direction) const {
  return hit.face_normal.dot(direction) > 0.0F &&
         !scene_.occluded(hit.position + scene_.offset() * hit.face_normal, direction);
}

/// The rays for what comes from all around carry only what the drawing changes in the surroundings' light,
/// which is known: T - c S + c mean(S), where T is what the ray brings, S the surroundings in its direction.
/// True for every c that does not depend on the ray; c as large as the share of rays that leave the drawing
/// has the least noise, none in the open (control variates, Kalos and Whitlock 1986).
Seen Tracer::solid(const Hit& hit, const Vec3f& direction, bool with_shared, Sampler& sampler,
                   Openings& openings) const {
  const Reflection reflection(hit);
  const Eigen::Matrix3f frame = frame_about(facing_normal(hit, -direction));
  const Vec3f out = frame.transpose() * -direction;
  Seen seen;
  seen.normal = hit.normal;
  seen.position = hit.position;
  seen.light = key_light(hit, reflection, frame, out, sampler);
  seen.dull = hit.roughness >= kDullRoughness;
  if (!seen.dull) {
    seen.light += polish(hit, reflection, frame, out, sampler, openings.mirrored);
  } else if (with_shared) {
    seen.sheen = mirror_light(hit, reflection, frame, out, sampler.next(), sampler).light;
  }
  const Eigen::Vector2f xi = sampler.next();
  if (reflection.diffuse.maxCoeff() > 0.0F) {
    seen.matt = reflection.diffuse;
    if (with_shared)
      seen.ambient = ambient(hit, frame.col(2), frame * sample_cosine(xi), sampler, openings.around);
  }
  return seen;
}

Vec3f Tracer::ambient(const Hit& hit, const Vec3f& normal, const Vec3f& in, Sampler& sampler,
                      Openness& open) const {
  const float share = open.share();
  Arriving arriving;
  if (in.dot(hit.face_normal) > 0.0F)
    arriving = second_hit(hit.position + scene_.offset() * hit.face_normal, in, sampler);
  open.add(arriving.left);
  const float surplus = studio_.irradiance(normal) - studio_.surroundings(in);
  return arriving.light + Vec3f::Constant(share * surplus);
}

/// Key light by a sample of its disc; the mirror part shares the work with mirror_light (balance heuristic).
Vec3f Tracer::key_light(const Hit& hit, const Reflection& reflection, const Eigen::Matrix3f& frame,
                        const Vec3f& out, Sampler& sampler) const {
  const Vec3f to_key = studio_.sample_key(sampler.next());
  const Vec3f in = frame.transpose() * to_key;
  if (in.z() <= 0.0F || !key_visible(hit, to_key)) return Vec3f::Zero();
  const float share = studio_.key_pdf() / (studio_.key_pdf() + reflection.specular_pdf(out, in));
  const Vec3f scatter =
      (in.z() / kPiSingle) * reflection.diffuse + share * reflection.specular_times_cosine(out, in);
  return (studio_.key_radiance() / studio_.key_pdf()) * scatter;
}

Tracer::Arriving Tracer::mirror_light(const Hit& hit, const Reflection& reflection,
                                      const Eigen::Matrix3f& frame, const Vec3f& out,
                                      const Eigen::Vector2f& xi, Sampler& sampler) const {
  const MirrorLobe lobe(reflection, out);
  const Mirrored mirrored = lobe.sample(xi);
  const Vec3f direction = frame * mirrored.in;
  if (mirrored.in.z() <= 0.0F || direction.dot(hit.face_normal) <= 0.0F) return {};
  Arriving arriving = second_hit(hit.position + scene_.offset() * hit.face_normal, direction, sampler);
  if (studio_.in_key(direction) && key_visible(hit, direction)) {
    const float pdf = reflection.specular_pdf(out, mirrored.in);
    arriving.light += Vec3f::Constant(studio_.key_radiance() * pdf / (pdf + studio_.key_pdf()));
  }
  arriving.light = mirrored.weight.cwiseProduct(arriving.light);
  return arriving;
}

/// What polished surfaces mirror: the surroundings' part as the mean of several directions.
Vec3f Tracer::polish(const Hit& hit, const Reflection& reflection, const Eigen::Matrix3f& frame,
                     const Vec3f& out, Sampler& sampler, Openness& open) const {
  const Eigen::Vector2f xi = sampler.next();
  const float share = open.share();
  const Arriving arriving = mirror_light(hit, reflection, frame, out, xi, sampler);
  open.add(arriving.left);
  if (share < kLeastOpen) return arriving.light;
  const MirrorLobe lobe(reflection, out);
  Vec3f surplus = Vec3f::Zero();
  for (int k = 0; k < kMirrors; ++k) {
    const Mirrored mirrored = lobe.sample(xi, k, kMirrors);
    if (mirrored.in.z() <= 0.0F) continue;
    const float weight = 1.0F / static_cast<float>(kMirrors) - (k == 0 ? 1.0F : 0.0F);
    surplus += (weight * studio_.surroundings(frame * mirrored.in)) * mirrored.weight;
  }
  return arriving.light + share * surplus;
}

/// What a secondary ray brings: the surroundings, or a surface under the key light and an unshadowed sky.
Tracer::Arriving Tracer::second_hit(const Vec3f& origin, const Vec3f& direction, Sampler& sampler) const {
  const auto hit = scene_.nearest(origin, direction, false);
  if (!hit) return {Vec3f::Constant(studio_.surroundings(direction)), true};
  const Reflection reflection(*hit);
  const Vec3f to_key = studio_.sample_key(sampler.next());
  const float cosine = hit->normal.dot(to_key);
  const float key = cosine > 0.0F && key_visible(*hit, to_key) ? cosine * studio_.key_strength() : 0.0F;
  const float sky = studio_.mean_sky() * (0.5F + 0.5F * hit->normal.z());
  const Vec3f mirrored = direction - 2.0F * direction.dot(hit->normal) * hit->normal;
  const Vec3f light = (key + sky) * reflection.diffuse +
                      (kSecondMirror * studio_.surroundings(mirrored)) * reflection.specular;
  return {light, false};
}

}  // namespace swarf::render
