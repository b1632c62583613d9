#include "render/ray/studio.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/parallel.h"
#include "base/units.h"

namespace swarf::render {
namespace {

constexpr auto kPiF = static_cast<float>(kPi);
/// Smoothest surface drawn: below it the highlight is narrower than the pixels' samples can find.
constexpr float kMinAlpha = 0.004F;
/// Reflectance of plastics and paints at normal incidence.
constexpr float kDielectric = 0.04F;
/// Share of the period that a strip light fills, and the share over which its edge fades.
constexpr float kStripShare = 0.45F, kStripEdge = 0.10F;
/// Strips fill the ceiling out to these angles from the zenith, across and along.
constexpr float kStripReachRad = 1.30F;
/// Radiance of floor and walls below the horizon, relative to the sky.
constexpr float kFloorShare = 0.55F;

/// Upright light panels stand round the subject: their number, half width, and how far up and down they
/// reach. Below the horizon they are their own reflections in the floor, weaker.
constexpr int kPanels = 5;
constexpr float kPanelHalfRad = 0.20F, kPanelEdgeRad = 0.06F, kPanelTop = 0.70F, kPanelBottom = -0.85F;
constexpr float kPanelShare = 0.7F, kPanelMirrored = 0.5F;

/// As std::round, which is a call where the processor has no instruction that every compiler may use.
float nearest_whole(float x) {
  return static_cast<float>(static_cast<int>(x + std::copysign(0.5F, x)));
}

float smooth_step(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

/// atan2 within 1e-4 rad (minimax polynomial of odd powers on -1..1), a quarter of its time: for lights whose
/// edges are many times as wide.
float quick_atan2(float y, float x) {
  const float ax = std::abs(x), ay = std::abs(y);
  const float small = std::min(ax, ay) / std::max(std::max(ax, ay), 1e-30F), s = small * small;
  float angle = (((-0.0464964749F * s + 0.15931422F) * s - 0.327622764F) * s) * small + small;
  if (ay > ax) angle = 0.5F * kPiF - angle;
  if (x < 0.0F) angle = kPiF - angle;
  return y < 0.0F ? -angle : angle;
}

/// The table of irradiances: nodes along a side of the unfolded octahedron, an odd number, so that the axes
/// and the fold at the horizon are nodes, and directions for each.
constexpr int kIrradianceSide = 17, kIrradianceRays = 1024;

float node_place(int node) {
  return 2.0F * static_cast<float>(node) / (kIrradianceSide - 1) - 1.0F;
}

/// Of a place on the unfolded octahedron, -1..1 (Cigolle et al. 2014), and back.
Vec3f octahedral_direction(float u, float v) {
  Vec3f n(u, v, 1.0F - std::abs(u) - std::abs(v));
  if (n.z() < 0.0F)
    n.head<2>() = Eigen::Vector2f(std::copysign(1.0F - std::abs(v), u), std::copysign(1.0F - std::abs(u), v));
  return n.normalized();
}
Eigen::Vector2f octahedral_place(const Vec3f& n) {
  const float u = n.x() / n.lpNorm<1>(), v = n.y() / n.lpNorm<1>();
  if (n.z() >= 0.0F) return {u, v};
  return {std::copysign(1.0F - std::abs(v), u), std::copysign(1.0F - std::abs(u), v)};
}

float ggx_density(float cosine, float alpha) {
  const float a2 = alpha * alpha, d = cosine * cosine * (a2 - 1.0F) + 1.0F;
  return a2 / (kPiF * d * d);
}

/// Schlick's, by the cosine between a direction and the half vector.
Vec3f fresnel(const Vec3f& at_normal, float cosine) {
  const float grazing = 1.0F - std::clamp(cosine, 0.0F, 1.0F), square = grazing * grazing;
  return at_normal + square * square * grazing * (Vec3f::Ones() - at_normal);
}

/// Smith's masking of one direction with cosine z.
float smith_g1(float z, float alpha) {
  const float a2 = alpha * alpha;
  return 2.0F * z / (z + std::sqrt(a2 + (1.0F - a2) * z * z));
}

}  // namespace

Eigen::Matrix3f frame_about(const Vec3f& n) {
  // Duff et al. 2017: continuous except at n = -z.
  const float sign = std::copysign(1.0F, n.z());
  const float a = -1.0F / (sign + n.z()), b = n.x() * n.y() * a;
  Eigen::Matrix3f frame;
  frame.col(0) = Vec3f(1.0F + sign * n.x() * n.x() * a, sign * b, -sign * n.x());
  frame.col(1) = Vec3f(b, sign + n.y() * n.y() * a, -n.y());
  frame.col(2) = n;
  return frame;
}

Studio::Studio(const StillOptions& options)
    : key_axis_(options.key_light_direction.normalized().cast<float>()),
      strip_axis_(
          Vec3(options.strip_direction.x(), options.strip_direction.y(), 0.0).normalized().cast<float>()),
      key_frame_(frame_about(key_axis_)),
      key_cosine_(static_cast<float>(std::cos(options.key_light_radius_rad))),
      key_strength_(static_cast<float>(options.key_light_strength)),
      sky_(static_cast<float>(options.sky_strength)),
      strip_period_(static_cast<float>(rad_from_deg(options.strip_period_deg))),
      strip_strength_(static_cast<float>(options.strip_strength)) {
  SWARF_CHECK(options.key_light_direction.norm() > 0.0 && options.key_light_radius_rad > 0.0, "key light");
  SWARF_CHECK(strip_axis_.norm() > 0.0F && strip_period_ > 0.0F, "strip lights");
  const float solid_angle = 2.0F * kPiF * (1.0F - key_cosine_);
  key_pdf_ = 1.0F / solid_angle;
  key_radiance_ = kPiF * key_strength_ / solid_angle;
  irradiance_.resize(size_t{kIrradianceSide} * kIrradianceSide);
  parallel_chunks(irradiance_.size(), kIrradianceSide, [this](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const auto column = static_cast<int>(i) % kIrradianceSide, row = static_cast<int>(i) / kIrradianceSide;
      irradiance_[i] = irradiance_about(octahedral_direction(node_place(column), node_place(row)));
    }
  });
}

float Studio::irradiance_about(const Vec3f& n) const {
  const Eigen::Matrix3f frame = frame_about(n);
  constexpr double kGolden = 0.6180339887498949;
  double sum = 0.0;
  for (int i = 0; i < kIrradianceRays; ++i) {
    const double turn = i * kGolden;
    const Eigen::Vector2f xi((static_cast<float>(i) + 0.5F) / kIrradianceRays,
                             static_cast<float>(turn - std::floor(turn)));
    sum += surroundings(frame * sample_cosine(xi));
  }
  return static_cast<float>(sum / kIrradianceRays);
}

float Studio::irradiance(const Vec3f& n) const {
  const Eigen::Vector2f at = 0.5F * (kIrradianceSide - 1) * (octahedral_place(n) + Eigen::Vector2f::Ones());
  const int i = std::clamp(static_cast<int>(at.x()), 0, kIrradianceSide - 2);
  const int j = std::clamp(static_cast<int>(at.y()), 0, kIrradianceSide - 2);
  const float x = at.x() - static_cast<float>(i), y = at.y() - static_cast<float>(j);
  const float* corner = &irradiance_[static_cast<size_t>(j * kIrradianceSide + i)];
  const float above = (1.0F - x) * corner[0] + x * corner[1];
  const float below = (1.0F - x) * corner[kIrradianceSide] + x * corner[kIrradianceSide + 1];
  return (1.0F - y) * above + y * below;
}

float Studio::strip_light(const Vec3f& d) const {
  if (d.z() <= 0.0F || strip_strength_ <= 0.0F) return 0.0F;
  const Vec3f across(-strip_axis_.y(), strip_axis_.x(), 0.0F);
  const float angle = quick_atan2(d.dot(across), d.z());
  const float along = std::abs(quick_atan2(d.dot(strip_axis_), d.z()));
  const float phase = angle / strip_period_;
  const float from_centre = std::abs(phase - nearest_whole(phase));
  const float edge =
      1.0F - smooth_step(0.5F * (kStripShare - kStripEdge), 0.5F * (kStripShare + kStripEdge), from_centre);
  const float reach = smooth_step(kStripReachRad, 0.8F * kStripReachRad, std::max(std::abs(angle), along));
  return strip_strength_ * edge * reach;
}

float Studio::surroundings(const Vec3f& d) const {
  // The sky is a little brighter overhead, with mean `sky_` over the cosine-weighted upper half.
  const float sky = sky_ * (0.6F + 0.6F * std::max(d.z(), 0.0F));
  const float below = kFloorShare * sky_;
  const float horizon = smooth_step(-0.08F, 0.08F, d.z());
  return below + horizon * (sky - below) + strip_light(d) + panel_light(d);
}

float Studio::panel_light(const Vec3f& d) const {
  if (strip_strength_ <= 0.0F || d.z() > kPanelTop || d.z() < kPanelBottom) return 0.0F;
  constexpr float kSector = 2.0F * kPiF / kPanels;
  const float turn =
      quick_atan2(strip_axis_.x() * d.y() - strip_axis_.y() * d.x(), d.dot(strip_axis_)) / kSector;
  // Half a sector off the strips' direction, so that no panel stands behind the end of a strip.
  const float from_centre = std::abs(turn - 0.5F - nearest_whole(turn - 0.5F)) * kSector;
  const float width =
      1.0F - smooth_step(kPanelHalfRad - kPanelEdgeRad, kPanelHalfRad + kPanelEdgeRad, from_centre);
  const float top = smooth_step(kPanelTop, kPanelTop - 0.15F, d.z());
  const float bottom = smooth_step(kPanelBottom, kPanelBottom + 0.5F, d.z());
  const float mirrored = d.z() < 0.0F ? kPanelMirrored * bottom : 1.0F;
  return kPanelShare * strip_strength_ * width * top * mirrored;
}

Vec3f Studio::sample_key(const Eigen::Vector2f& xi) const {
  const float z = 1.0F - xi.x() * (1.0F - key_cosine_);
  const float r = std::sqrt(std::max(0.0F, 1.0F - z * z)), angle = 2.0F * kPiF * xi.y();
  return key_frame_ * Vec3f(r * std::cos(angle), r * std::sin(angle), z);
}

Reflection::Reflection(const Hit& hit)
    : diffuse((1.0F - hit.metalness) * hit.colour),
      specular(hit.metalness * hit.colour + Vec3f::Constant((1.0F - hit.metalness) * kDielectric)),
      alpha(std::max(kMinAlpha, hit.roughness * hit.roughness)) {}

Vec3f Reflection::specular_times_cosine(const Vec3f& out, const Vec3f& in) const {
  const Vec3f half = (out + in).normalized();
  const float shape =
      ggx_density(half.z(), alpha) * smith_g1(out.z(), alpha) * smith_g1(in.z(), alpha) / (4.0F * out.z());
  return shape * fresnel(specular, out.dot(half));
}

float Reflection::specular_pdf(const Vec3f& out, const Vec3f& in) const {
  const Vec3f half = (out + in).normalized();
  return smith_g1(out.z(), alpha) * ggx_density(half.z(), alpha) / (4.0F * out.z());
}

MirrorLobe::MirrorLobe(const Reflection& reflection, const Vec3f& out) : reflection_(reflection), out_(out) {
  const Vec3f stretched = Vec3f(reflection.alpha * out.x(), reflection.alpha * out.y(), out.z()).normalized();
  // The half disc is folded along the first tangent, which therefore must lie in the surface.
  const float level = std::sqrt(stretched.x() * stretched.x() + stretched.y() * stretched.y());
  const Vec3f first =
      level > 0.0F ? Vec3f(-stretched.y() / level, stretched.x() / level, 0.0F) : Vec3f::UnitX();
  frame_ << first, stretched.cross(first), stretched;
}

Mirrored MirrorLobe::sample(const Eigen::Vector2f& xi, int k, int count) const {
  constexpr float kGolden = 0.618034F;
  float area = xi.x() + static_cast<float>(k) / static_cast<float>(count);
  if (area >= 1.0F) area -= 1.0F;
  const float r = std::sqrt(area), angle = 2.0F * kPiF * (xi.y() + kGolden * static_cast<float>(k));
  const float x = r * std::cos(angle), s = 0.5F * (1.0F + frame_(2, 2));
  const float y = (1.0F - s) * std::sqrt(1.0F - x * x) + s * r * std::sin(angle);
  const Vec3f n = frame_ * Vec3f(x, y, std::sqrt(std::max(0.0F, 1.0F - x * x - y * y)));
  const float alpha = reflection_.alpha;
  const Vec3f half = Vec3f(alpha * n.x(), alpha * n.y(), std::max(1e-6F, n.z())).normalized();
  const float facing = out_.dot(half);
  Mirrored mirrored;
  mirrored.in = 2.0F * facing * half - out_;
  // specular_times_cosine / specular_pdf: the density, the masking of `out` and the 4 cosines cancel.
  const float masking = smith_g1(std::max(mirrored.in.z(), 0.0F), alpha);
  mirrored.weight = masking * fresnel(reflection_.specular, facing);
  return mirrored;
}

Vec3f sample_cosine(const Eigen::Vector2f& xi) {
  const float r = std::sqrt(xi.x()), angle = 2.0F * kPiF * xi.y();
  return {r * std::cos(angle), r * std::sin(angle), std::sqrt(std::max(0.0F, 1.0F - xi.x()))};
}

}  // namespace swarf::render
