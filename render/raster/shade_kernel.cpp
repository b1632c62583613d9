#include "render/raster/shade_kernel.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/instruction_sets.h"

namespace swarf::render {
namespace {

constexpr int kAtOnce = static_cast<int>(kShadedAtOnce);
/// Bits of a paint that hardly show are not compared.
constexpr uint32_t kCompared = 0xfff0f0f0U;
/// Normals that differ by less, of 65535, belong to one surface: some 10 degrees.
constexpr int kNear = 4000;

/// Farther than this nothing is seen, 1/mm.
constexpr float kLeastNearness = 1e-9F;

SWARF_KERNEL_INLINE float least(float a, float b) {
  return a < b ? a : b;
}
SWARF_KERNEL_INLINE float most(float a, float b) {
  return a > b ? a : b;
}
SWARF_KERNEL_INLINE float mix(float a, float b, float share) {
  return a + share * (b - a);
}
SWARF_KERNEL_INLINE float within_one(float a) {
  return most(least(a, 1.0F), 0.0F);
}
/// 0 at `from` and 1 at `to`, flat at both.
SWARF_KERNEL_INLINE float smooth_between(float from, float to, float value) {
  const float t = within_one((value - from) * (1.0F / (to - from)));
  return t * t * (3.0F - 2.0F * t);
}

struct Vector {
  float x, y, z;
};
SWARF_KERNEL_INLINE Vector vector(const Lighting::Vector& v) {
  return {v[0], v[1], v[2]};
}
SWARF_KERNEL_INLINE Vector operator+(const Vector& a, const Vector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
SWARF_KERNEL_INLINE Vector operator-(const Vector& a, const Vector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
SWARF_KERNEL_INLINE Vector operator*(float s, const Vector& v) {
  return {s * v.x, s * v.y, s * v.z};
}
SWARF_KERNEL_INLINE Vector operator*(const Vector& a, const Vector& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
SWARF_KERNEL_INLINE float dot(const Vector& a, const Vector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
SWARF_KERNEL_INLINE Vector normalized(const Vector& v) {
  return (1.0F / std::sqrt(most(dot(v, v), 1e-30F))) * v;
}
SWARF_KERNEL_INLINE Vector mix(const Vector& a, const Vector& b, float share) {
  return a + share * (b - a);
}

/// The second where `second` is 1, the first where it is 0: exactly.
SWARF_KERNEL_INLINE float one_of(float a, float b, float second) {
  return (1.0F - second) * a + second * b;
}

/// Base-2 logarithm of what is above 0, by its exponent and a cubic of its mantissa: error below 9e-4.
SWARF_KERNEL_INLINE float log2_of(float x) {
  const int bits = std::bit_cast<int>(x);
  const float m = std::bit_cast<float>((bits & 0x7fffff) | 0x3f800000) - 1.0F;
  return static_cast<float>((bits >> 23) - 127) + m + m * (1.0F - m) * (0.422865005F - 0.159219632F * m);
}

/// 2 to what is above -64, likewise: relative error below 1.5e-4.
SWARF_KERNEL_INLINE float exp2_of(float x) {
  const float above = x + 64.0F;
  const int whole = static_cast<int>(above);
  const float part = above - static_cast<float>(whole);
  const float mantissa = 1.0F + part - part * (1.0F - part) * (0.304109874F + 0.079244907F * part);
  return std::bit_cast<float>(std::bit_cast<int>(mantissa) + (whole - 64) * (1 << 23));
}

/// Linear to sRGB, 0 to 1, within 0.0005. Without roots: they are what a vector unit is slowest at.
SWARF_KERNEL_INLINE float srgb_of(float c) {
  constexpr float kLinearTo = 0.0031308F;  // below it the standard's curve is a line
  const float curve = 1.055F * exp2_of((1.0F / 2.4F) * log2_of(most(c, kLinearTo))) - 0.055F;
  return within_one(curve + 12.92F * (least(c, kLinearTo) - kLinearTo));
}

/// Linear up to 0.7, then a shoulder that never reaches 1. One division for three.
SWARF_KERNEL_INLINE Vector shouldered(const Vector& c) {
  const Vector over{most(c.x - 0.7F, 0.0F), most(c.y - 0.7F, 0.0F), most(c.z - 0.7F, 0.0F)};
  const Vector under{0.3F + over.x, 0.3F + over.y, 0.3F + over.z};
  const float xy = under.x * under.y, inverse = 0.3F / (xy * under.z);
  return {least(c.x, 0.7F) + over.x * under.y * under.z * inverse,
          least(c.y, 0.7F) + over.y * under.x * under.z * inverse, least(c.z, 0.7F) + over.z * xy * inverse};
}

/// t runs from the bottom (0) to the top (1) of the picture.
SWARF_KERNEL_INLINE Vector background(float t) {
  return mix(Vector{0.50F, 0.53F, 0.56F}, Vector{0.86F, 0.89F, 0.92F}, smooth_between(0.0F, 1.0F, t));
}

/// A studio as seen in a mirror: floor, walls, a wide soft box above.
SWARF_KERNEL_INLINE Vector studio(const Vector& d, const Vector& softbox, float blur) {
  const Vector c = mix(Vector{0.20F, 0.21F, 0.22F}, Vector{0.62F, 0.66F, 0.70F},
                       smooth_between(-0.35F - blur, 0.35F + blur, d.z));
  const float box = smooth_between(0.55F - 0.5F * blur, 0.80F + 0.3F * blur, dot(d, softbox));
  return c + (box * (1.0F - 0.6F * blur)) * Vector{1.0F, 0.98F, 0.95F};
}

struct Finish {
  Vector albedo;
  float metalness, roughness;
};

struct Lights {
  Vector key, softbox, fill, rim;  ///< unit vectors towards them
};

SWARF_KERNEL_INLINE Vector surface(const Lights& l, const Vector& v, const Vector& n, const Finish& finish,
                                   float lit) {
  const Vector key = l.key;
  const float roughness = finish.roughness;
  const float nv = most(dot(n, v), 0.02F);
  const float nl = most(dot(n, key), 0.0F) * lit;
  const Vector diffuse = (1.0F - finish.metalness) * finish.albedo;
  const Vector f0 = mix(Vector{0.04F, 0.04F, 0.04F}, finish.albedo, finish.metalness);
  const Vector sky = mix(Vector{0.17F, 0.165F, 0.16F}, Vector{0.36F, 0.375F, 0.40F}, 0.5F + 0.5F * n.z);
  const Vector light = sky + (0.78F * nl) * Vector{1.0F, 0.975F, 0.94F} +
                       (0.22F * most(dot(n, l.fill), 0.0F)) * Vector{0.80F, 0.88F, 1.0F};

  // GGX lobe of the key light with the visibility term of a half vector (Karis's mobile approximation).
  const float a = most(roughness * roughness, 0.02F);
  const Vector h = v + key;
  const float per_square = 1.0F / most(dot(h, h), 1e-30F);
  const float above = most(dot(n, h), 0.0F), along = dot(key, h);
  const float nh_nh = above * above * per_square, lh_lh = most(along * along * per_square, 0.01F);
  const float d = nh_nh * (a * a - 1.0F) + 1.0F;
  const float lobe = a * a / (12.566F * d * d * lh_lh * (roughness + 0.5F)) * nl;
  float edge = (1.0F - nv) * (1.0F - nv);
  edge = edge * edge * (1.0F - nv);
  const float smooth = 1.0F - roughness;
  const Vector grazing{most(smooth, f0.x), most(smooth, f0.y), most(smooth, f0.z)};
  const Vector mirror = mix(f0, grazing, edge);
  const Vector reflected = (2.0F * dot(n, v)) * n - v;
  const Vector specular = (least(lobe, 4.0F) * 2.2F) * f0 +
                          (1.0F - 0.45F * roughness) * (mirror * studio(reflected, l.softbox, roughness)) +
                          (0.25F * edge * most(dot(n, l.rim), 0.0F)) * Vector{0.9F, 0.95F, 1.0F};
  const Vector seen = diffuse * light + specular;
  return shouldered(seen);
}

/// What the shadow map is asked by, its own so that writing colours cannot change it.
struct ShadowTexels {
  const float* depths;
  int width;
  float columns, rows, right_most, up_most;  ///< texels
  float nearest, size;                       ///< of the depths of what lies between the light's planes
};

SWARF_KERNEL_INLINE ShadowTexels texels_of(const ShadowMap& map) {
  // Texels' middles stand half a texel in; the last row and column have no neighbours.
  return {map.depths.data(),
          map.width,
          static_cast<float>(map.width),
          static_cast<float>(map.rows),
          static_cast<float>(map.width) - 1.001F,
          static_cast<float>(map.rows) - 1.001F,
          map.range.nearest,
          map.range.size()};
}

/// The share of four texels around the place that does not shade it, weighed by their distances.
SWARF_KERNEL_INLINE float lit_texels(const ShadowTexels& map, float x, float y, float depth) {
  const float px = most(least(x - 0.5F, map.right_most), 0.0F), py = most(least(y - 0.5F, map.up_most), 0.0F);
  const int column = static_cast<int>(px), row = static_cast<int>(py);
  const float right = px - static_cast<float>(column), up = py - static_cast<float>(row);
  const int at = row * map.width + column;
  const float a = depth <= map.depths[at] ? 1.0F : 0.0F;
  const float b = depth <= map.depths[at + 1] ? 1.0F : 0.0F;
  const float c = depth <= map.depths[at + map.width] ? 1.0F : 0.0F;
  const float d = depth <= map.depths[at + map.width + 1] ? 1.0F : 0.0F;
  return mix(mix(a, b, right), mix(c, d, right), up);
}

/// From its place on the octahedron.
SWARF_KERNEL_INLINE Vector normal_at(float u, float v) {
  const float x = u * (2.0F / 65535.0F) - 1.0F, y = v * (2.0F / 65535.0F) - 1.0F;
  const float z = 1.0F - std::abs(x) - std::abs(y);
  const float fold = most(-z, 0.0F);
  return normalized({x >= 0.0F ? x - fold : x + fold, y >= 0.0F ? y - fold : y + fold, z});
}

SWARF_KERNEL_INLINE float byte_of(uint32_t word, int byte) {
  return static_cast<float>(static_cast<int>(word >> (8 * byte) & 0xffU)) * (1.0F / 255.0F);
}
/// Error below 0.004.
SWARF_KERNEL_INLINE float linear_of(float encoded) {
  return encoded * (encoded * (encoded * 0.305306011F + 0.682171111F) + 0.012522878F);
}

/// What one sample sees.
struct SampleNormal {
  int u, v;
  uint32_t paint;
};
constexpr uint32_t kGroundNormal = kGroundWords[0], kGroundPaint = kGroundWords[1];

SWARF_KERNEL_INLINE SampleNormal sample_of(uint32_t normal, uint32_t paint, float depth, float farthest) {
  const uint32_t drawn = depth < farthest ? ~0U : 0U;
  const uint32_t n = (normal & drawn) | (kGroundNormal & ~drawn);
  return {static_cast<int>(n & 0xffffU), static_cast<int>(n >> 16),
          (paint & drawn) | (kGroundPaint & ~drawn)};
}

/// 0 where both are one surface.
SWARF_KERNEL_INLINE uint32_t differ(const SampleNormal& a, const SampleNormal& b) {
  const int u = a.u - b.u, v = a.v - b.v;
  const uint32_t far_u = u >= kNear || -u >= kNear ? 1U : 0U, far_v = v >= kNear || -v >= kNear ? 1U : 0U;
  return ((a.paint ^ b.paint) & kCompared) | far_u | far_v;
}

/// Of some pixels, apart from the batch: where nothing else can be meant by their names, the loops become
/// vectors.
struct FirstSurfaces {
  float u[kAtOnce], v[kAtOnce], depth[kAtOnce];
  uint32_t paint[kAtOnce], differs[kAtOnce];
};

SWARF_KERNEL_INLINE void first_of_one(const uint32_t* words, const float* seen, float farthest,
                                      FirstSurfaces& firsts) {
  for (int i = 0; i < kAtOnce; ++i) {
    const SampleNormal only = sample_of(words[2 * i], words[2 * i + 1], seen[i], farthest);
    firsts.u[i] = static_cast<float>(only.u);
    firsts.v[i] = static_cast<float>(only.v);
    firsts.depth[i] = seen[i];
    firsts.paint[i] = only.paint;
    firsts.differs[i] = 0;
  }
}

SWARF_KERNEL_INLINE void first_of_four(const uint32_t* above, const float* seen_above, std::ptrdiff_t stride,
                                       float farthest, FirstSurfaces& firsts) {
  const uint32_t* below = above + 2 * stride;
  const float* seen_below = seen_above + stride;
  for (int i = 0; i < kAtOnce; ++i) {
    const SampleNormal first = sample_of(above[4 * i], above[4 * i + 1], seen_above[2 * i], farthest),
                       right = sample_of(above[4 * i + 2], above[4 * i + 3], seen_above[2 * i + 1], farthest),
                       lower = sample_of(below[4 * i], below[4 * i + 1], seen_below[2 * i], farthest),
                       last = sample_of(below[4 * i + 2], below[4 * i + 3], seen_below[2 * i + 1], farthest);
    firsts.u[i] = 0.25F * static_cast<float>(first.u + right.u + lower.u + last.u);
    firsts.v[i] = 0.25F * static_cast<float>(first.v + right.v + lower.v + last.v);
    firsts.depth[i] = seen_above[2 * i];
    firsts.paint[i] = first.paint;
    firsts.differs[i] = differ(right, first) | differ(lower, first) | differ(last, first);
  }
}

SWARF_KERNEL_INLINE void first_surfaces(const SampleRow& row, int side, ShadeBatch& batch,
                                        uint32_t* several) {
  for (size_t at = 0; at < row.count; at += kShadedAtOnce) {
    FirstSurfaces firsts;
    const size_t sample = static_cast<size_t>(side) * at;
    if (side == 1) {
      first_of_one(row.words + 2 * sample, row.depths + sample, row.farthest, firsts);
    } else {
      first_of_four(row.words + 2 * sample, row.depths + sample, row.below, row.farthest, firsts);
    }
    std::copy_n(firsts.u, kAtOnce, &batch.normal_u[at]);
    std::copy_n(firsts.v, kAtOnce, &batch.normal_v[at]);
    std::copy_n(firsts.depth, kAtOnce, &batch.depth[at]);
    std::copy_n(firsts.paint, kAtOnce, &batch.paint[at]);
    std::copy_n(firsts.differs, kAtOnce, several + at);
  }
}

/// `Lighting` as the loops take it.
struct ShadeFrame {
  Vector eye, forward, right, down, centre;
  Vector shadow_x, shadow_y, shadow_z, shadow_origin;
  Lights lights;
  float per_radius, per_height, lift, near_start, near_rise;
  Vector floor_near;
  ShadowTexels map;
  const float *metalness, *roughness;
};

SWARF_KERNEL_INLINE ShadeFrame frame_of(const Lighting& l) {
  return {vector(l.eye),
          vector(l.forward),
          vector(l.right),
          vector(l.down),
          vector(l.centre),
          vector(l.shadow_from_world[0]),
          vector(l.shadow_from_world[1]),
          vector(l.shadow_from_world[2]),
          vector(l.shadow_origin),
          {vector(l.key), vector(l.softbox), vector(l.fill), vector(l.rim)},
          1.0F / l.radius,
          1.0F / l.height,
          l.shadow_lift_mm,
          l.nearness[0],
          l.nearness[1],
          vector(l.floor),
          texels_of(*l.shadow),
          l.metalness.data(),
          l.roughness.data()};
}

struct Lit {
  Vector place;  ///< in the shadow map, 0..1
  float share;
};

/// Two filtered taps across the texel grid: eight texels weigh in.
SWARF_KERNEL_INLINE Lit lit_at(const ShadeFrame& f, const Vector& world) {
  const Vector p = f.shadow_origin + world.x * f.shadow_x + world.y * f.shadow_y + world.z * f.shadow_z;
  const float x = p.x * f.map.columns, y = p.y * f.map.rows,
              depth = f.map.nearest + f.map.size * least(p.z, 1.0F);
  return {p, 0.5F * (lit_texels(f.map, x - 0.6F, y - 0.3F, depth) +
                     lit_texels(f.map, x + 0.6F, y + 0.3F, depth))};
}

/// Floor and background.
SWARF_KERNEL_INLINE Vector ground_seen(const ShadeFrame& f, float x, float y) {
  const float near = most(x * f.floor_near.x + y * f.floor_near.y + f.floor_near.z, kLeastNearness);
  const Vector world = f.eye + (1.0F / near) * (f.forward + x * f.right + y * f.down);
  const Lit lit = lit_at(f, world);
  // Darker close to the scene, where its bulk hides part of the sky.
  const float dx = world.x - f.centre.x, dy = world.y - f.centre.y;
  const float r = std::sqrt(dx * dx + dy * dy) * f.per_radius;
  const Vector& p = lit.place;
  const float beyond = most(most(most(p.x, p.y), p.z) - 1.0F, -least(least(p.x, p.y), p.z));
  const float unshaded = beyond > 0.0F ? 1.0F : 0.0F;
  const float floor_lit = mix(0.58F, 1.0F, most(lit.share, unshaded));
  const float floor = floor_lit * mix(0.80F, 1.0F, smooth_between(0.08F, 0.45F, r));
  const float fade = 1.0F - smooth_between(0.25F, 1.0F, r);  // beyond the horizon too: r is huge there
  return mix(background(0.5F - y * f.per_height), floor * Vector{0.56F, 0.58F, 0.60F}, fade);
}

/// What is drawn there.
SWARF_KERNEL_INLINE Vector body_seen(const ShadeFrame& f, float x, float y, float seen_depth,
                                     const Vector& towards, int material, const Vector& own) {
  const float near = most(f.near_start + f.near_rise * seen_depth, kLeastNearness);
  const Vector line = f.forward + x * f.right + y * f.down;
  const Vector v = normalized(Vector{} - line);
  const Vector n = (dot(towards, v) < 0.0F ? -1.0F : 1.0F) * towards;
  const Lit lit = lit_at(f, f.eye + (1.0F / near) * line + f.lift * n);
  return surface(
      f.lights, v, n,
      {{linear_of(own.x), linear_of(own.y), linear_of(own.z)}, f.metalness[material], f.roughness[material]},
      lit.share);
}

/// sRGB of some pixels, apart from the batch, as above.
struct Colours {
  float red[kAtOnce], green[kAtOnce], blue[kAtOnce];
};

SWARF_KERNEL_INLINE void shade_ground(const ShadeFrame& f, const float* xs, const float* ys, Colours& out) {
  for (int i = 0; i < kAtOnce; ++i) {
    const Vector seen = ground_seen(f, xs[i], ys[i]);
    out.red[i] = srgb_of(seen.x);
    out.green[i] = srgb_of(seen.y);
    out.blue[i] = srgb_of(seen.z);
  }
}

/// Of those that see the ground it makes nothing that is used.
SWARF_KERNEL_INLINE void shade_bodies(const ShadeFrame& f, size_t at, const ShadeBatch& batch, Colours& out) {
  const float *xs = &batch.x[at], *ys = &batch.y[at], *depths = &batch.depth[at];
  const float *us = &batch.normal_u[at], *vs = &batch.normal_v[at];
  const uint32_t* paints = &batch.paint[at];
  for (int i = 0; i < kAtOnce; ++i) {
    const uint32_t paint = paints[i];
    const int kind = static_cast<int>(paint >> 24);
    const Vector own{byte_of(paint, 0), byte_of(paint, 1), byte_of(paint, 2)};
    const Vector seen = body_seen(f, xs[i], ys[i], depths[i], normal_at(us[i], vs[i]),
                                  std::max(kind - kFirstMaterial, 0), own);
    // Shares instead of branches, which would keep the loop from vectors.
    const float painted = kind == kPaintKind ? 1.0F : 0.0F;
    out.red[i] = one_of(srgb_of(seen.x), own.x, painted);
    out.green[i] = one_of(srgb_of(seen.y), own.y, painted);
    out.blue[i] = one_of(srgb_of(seen.z), own.z, painted);
  }
}

SWARF_KERNEL_INLINE void shade(const Lighting& lighting, size_t count, ShadeBatch& batch) {
  const ShadeFrame frame = frame_of(lighting);
  for (size_t at = 0; at < count; at += kShadedAtOnce) {
    float is_ground[kAtOnce], grounds = 0.0F;
    for (int i = 0; i < kAtOnce; ++i) is_ground[i] = batch.paint[at + i] >> 24 == kGroundKind ? 1.0F : 0.0F;
    for (int i = 0; i < kAtOnce; ++i) grounds += is_ground[i];
    Colours seen, ground;
    if (grounds < kAtOnce) shade_bodies(frame, at, batch, seen);
    if (grounds > 0.0F) shade_ground(frame, &batch.x[at], &batch.y[at], grounds < kAtOnce ? ground : seen);
    if (grounds > 0.0F && grounds < kAtOnce) {
      for (int i = 0; i < kAtOnce; ++i) {
        seen.red[i] = one_of(seen.red[i], ground.red[i], is_ground[i]);
        seen.green[i] = one_of(seen.green[i], ground.green[i], is_ground[i]);
        seen.blue[i] = one_of(seen.blue[i], ground.blue[i], is_ground[i]);
      }
    }
    std::copy_n(seen.red, kAtOnce, &batch.red[at]);
    std::copy_n(seen.green, kAtOnce, &batch.green[at]);
    std::copy_n(seen.blue, kAtOnce, &batch.blue[at]);
  }
}

SWARF_KERNEL_INLINE void write_bytes(const ShadeBatch& batch, size_t count, uint8_t* rgba) {
  const float *red = batch.red.data(), *green = batch.green.data(), *blue = batch.blue.data();
  // Of 0 to 1, and in vectors, as std::lround() is not.
  const auto byte = [](float share) {
    return static_cast<uint8_t>(
        static_cast<int>(share * 255.0F + 0.5F));  // NOLINT(bugprone-incorrect-roundings)
  };
  for (int i = 0; i < static_cast<int>(count); ++i) {
    rgba[4 * i] = byte(red[i]);
    rgba[4 * i + 1] = byte(green[i]);
    rgba[4 * i + 2] = byte(blue[i]);
    rgba[4 * i + 3] = 255;
  }
}

void first_baseline(const SampleRow& row, int side, ShadeBatch& batch, uint32_t* several) {
  first_surfaces(row, side, batch, several);
}
SWARF_X86_64_V3 void first_v3(const SampleRow& row, int side, ShadeBatch& batch, uint32_t* several) {
  first_surfaces(row, side, batch, several);
}
SWARF_X86_64_V4_WIDE void first_v4(const SampleRow& row, int side, ShadeBatch& batch, uint32_t* several) {
  first_surfaces(row, side, batch, several);
}
void write_baseline(const ShadeBatch& batch, size_t count, uint8_t* rgba) {
  write_bytes(batch, count, rgba);
}
void shade_baseline(const Lighting& lighting, size_t count, ShadeBatch& batch) {
  shade(lighting, count, batch);
}
SWARF_X86_64_V3 void write_v3(const ShadeBatch& batch, size_t count, uint8_t* rgba) {
  write_bytes(batch, count, rgba);
}
SWARF_X86_64_V3 void shade_v3(const Lighting& lighting, size_t count, ShadeBatch& batch) {
  shade(lighting, count, batch);
}
SWARF_X86_64_V4_WIDE void write_v4(const ShadeBatch& batch, size_t count, uint8_t* rgba) {
  write_bytes(batch, count, rgba);
}
SWARF_X86_64_V4_WIDE void shade_v4(const Lighting& lighting, size_t count, ShadeBatch& batch) {
  shade(lighting, count, batch);
}

Lighting::Vector single(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

}  // namespace

ShadeBatch::ShadeBatch(size_t most)
    : x(most),
      y(most),
      depth(most),
      normal_u(most),
      normal_v(most),
      paint(most),
      red(most),
      green(most),
      blue(most) {}

bool one_surface(const SeenWords& a, const SeenWords& b) {
  const int u = static_cast<int>(a[0] & 0xffffU) - static_cast<int>(b[0] & 0xffffU);
  const int v = static_cast<int>(a[0] >> 16) - static_cast<int>(b[0] >> 16);
  return ((a[1] ^ b[1]) & kCompared) == 0 && std::abs(u) < kNear && std::abs(v) < kNear;
}

Lighting lighting(const SceneView& view, const Vec3& eye, int width, int height,
                  std::span<const std::array<float, 2>> materials, const ShadowMap& shadow,
                  const DepthRange& depths) {
  Lighting l{};
  l.eye = single(eye);
  l.forward = single(view.forward);
  l.right = single(2.0 / width * view.right);
  l.down = single(-2.0 / height * view.up);
  const double rise = (1.0 / view.far - 1.0 / view.near) / depths.size();
  l.nearness = {static_cast<float>(1.0 / view.near - rise * depths.nearest), static_cast<float>(rise)};
  const Vec3 floor = nearness_of_level(view, eye, view.ground_centre.z());
  l.floor = single({2.0 / width * floor.x(), -2.0 / height * floor.y(), floor.z()});
  l.key = single(view.key);
  l.softbox = single((view.key + Vec3(0.0, 0.0, 0.5)).normalized());
  l.fill = single(view.fill);
  l.rim = single(view.rim);
  // From -1..1 to 0..1.
  const Eigen::Matrix<double, 3, 4> half = 0.5 * view.light_clip_from_world.topRows<3>();
  for (int k = 0; k < 3; ++k) l.shadow_from_world[static_cast<size_t>(k)] = single(half.col(k));
  l.shadow_origin = single(half.col(3) + Vec3::Constant(0.5));
  l.shadow_lift_mm = static_cast<float>(1.5 * view.shadow_texel_mm);
  l.centre = single(view.ground_centre);
  l.radius = static_cast<float>(view.ground_radius);
  l.height = static_cast<float>(height);
  for (size_t i = 0; i < materials.size(); ++i) {
    l.metalness[i] = materials[i][0];
    l.roughness[i] = materials[i][1];
  }
  l.shadow = &shadow;
  return l;
}

std::span<const ShadeKernel> shade_kernels() {
  static const std::vector<ShadeKernel> kernels = runnable<ShadeKernel>(
      {"x86-64-v4", first_v4, shade_v4, write_v4}, {"x86-64-v3", first_v3, shade_v3, write_v3},
      {"baseline", first_baseline, shade_baseline, write_baseline});
  return kernels;
}

}  // namespace swarf::render
