// The colours of what is seen: key light with its shadow map, fill and rim lights, a studio box reflected by
// roughness; the floor, which takes the shadow and fades into a vertical gradient. In linear light; written
// as sRGB.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/frames.h"
#include "render/raster/depth_range.h"
#include "render/raster/scene_view.h"
#include "render/raster/shaders.h"

namespace swarf::render {

/// The depth of what the key light reaches first, the lowest row first; beyond the range where it reaches
/// nothing.
struct ShadowMap {
  std::vector<float> depths;
  int width = 0, rows = 0;  ///< texels, at least 2
  DepthRange range{};
};

/// Everything but the places themselves that decides on their colours.
struct Lighting {
  using Vector = std::array<float, 3>;
  /// A place: eye + (forward + x right + y down) / nearness, x and y in px from the middle of the picture.
  Vector eye, forward, right, down;
  std::array<float, 2> nearness;   ///< 1/mm: of depth 0 in the buffer, and what depth 1 adds to it
  std::array<float, 3> floor;      ///< its nearness: x and y times the first two plus the third
  Vector key, softbox, fill, rim;  ///< unit vectors towards the lights; of the box between key and zenith
  std::array<Vector, 3> shadow_from_world;  ///< columns of the shadow map's place, 0..1
  Vector shadow_origin;
  float shadow_lift_mm;  ///< off a surface, before its shadow is looked up
  Vector centre;         ///< of the floor
  float radius;
  float height;  ///< of the picture, px
  std::array<float, kMaterialsMost> metalness, roughness;
  const ShadowMap* shadow;
};

/// `materials`: metalness and roughness, at most kMaterialsMost. `depths`: where the frame was drawn.
Lighting lighting(const SceneView& view, const Vec3& eye, int width, int height,
                  std::span<const std::array<float, 2>> materials, const ShadowMap& shadow,
                  const DepthRange& depths = {});

/// Two words as the surface shaders write them: normal and paint.
using SeenWords = std::array<uint32_t, 2>;

/// Places to be shaded and their colours; all arrays have one size, a multiple of kShadedAtOnce.
struct ShadeBatch {
  explicit ShadeBatch(size_t most);
  std::vector<float> x, y;                ///< px from the middle of the picture, y down
  std::vector<float> depth;               ///< in the buffer; of the floor and the backdrop not looked at
  std::vector<float> normal_u, normal_v;  ///< on the octahedron, 0..65535
  std::vector<uint32_t> paint;            ///< a sample's second word
  std::vector<float> red, green, blue;    ///< the result, sRGB 0..1
};
constexpr size_t kShadedAtOnce = 16;

/// Some of a row's pixels: what OSMesa found at `side` x `side` samples of each. Samples are read to a
/// multiple of kShadedAtOnce pixels.
struct SampleRow {
  const uint32_t* words;  ///< two a sample, of the first pixel's upper left one on
  const float* depths;    ///< likewise
  std::ptrdiff_t below;   ///< from a sample to that below it
  size_t count;           ///< px
  float farthest = 1.0F;  ///< depth from which on nothing was drawn, whatever the words say
};

/// One set of functions for each instruction set; all give the same bits.
struct ShadeKernel {
  const char* name;
  /// Fills depth, normal and paint of a batch's first places with the first sample of each pixel of the row,
  /// whose normal is the mean of all; `several` is not 0 where the samples see more than one surface.
  void (*first_surfaces)(const SampleRow& row, int side, ShadeBatch& batch, uint32_t* several);
  /// The colours of the batch's first `count` places; those after, to a multiple of kShadedAtOnce, are shaded
  /// along.
  void (*shade)(const Lighting& lighting, size_t count, ShadeBatch& batch);
  /// These colours as bytes: red, green, blue, 255.
  void (*write_bytes)(const ShadeBatch& batch, size_t count, uint8_t* rgba);
};

/// Those that this processor runs, fastest first.
std::span<const ShadeKernel> shade_kernels();

/// Samples are one surface where their materials and (nearly) paints are the same and their normals near.
bool one_surface(const SeenWords& a, const SeenWords& b);

/// Where nothing was drawn.
constexpr SeenWords kGroundWords{0x80008000U, uint32_t{kGroundKind} << 24};

}  // namespace swarf::render
