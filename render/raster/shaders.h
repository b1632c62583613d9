// The GLSL programs of the rasteriser, which shades late: what is seen is found first, at all samples of a
// pixel, and then shaded once where the samples of a pixel see one surface.
//
//   surface     normal, paint and material of what is seen
//   line        screen-space quads of paint
//   ground      the floor under the scene, or what is behind everything: one triangle over the whole picture,
//   so
//               that nothing need be cleared
//   shadow      depth of the scene seen from the key light
//   shade       key light with its shadow map, fill and rim lights, a studio box reflected by roughness; the
//   floor,
//               which takes the shadow and fades into a vertical gradient
//
// Shaders compute in linear light and write sRGB; samples are averaged as stored.
#pragma once

namespace swarf::render {

struct ShaderSource {
  const char* vertex;
  const char* fragment;
};

extern const ShaderSource kSurfaceShader;
extern const ShaderSource kShadowShader;
extern const ShaderSource kGroundShader;
extern const ShaderSource kLineShader;
extern const ShaderSource kShadeShader;

/// Prepended to every fragment shader.
extern const char* const kFragmentPrelude;

/// In the highest byte of a sample's second word; materials of the list follow these.
constexpr int kGroundKind = 1, kPaintKind = 2, kFirstMaterial = 3, kMaterialsMost = 128;

}  // namespace swarf::render
