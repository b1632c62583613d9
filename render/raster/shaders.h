// The GLSL programs of the rasteriser: what is seen is found first, at each sample of a pixel, and shaded
// later
// (`shade_kernel.h`), once where the samples of a pixel see one surface.
//
//   surface     normal, paint and material of what is seen
//   line        screen-space quads of paint
//   shadow      depth of the scene seen from the key light
//
// A sample is two words: its normal on an octahedron, 16 bits each way; its paint as sRGB bytes under its
// kind.
#pragma once

namespace swarf::render {

struct ShaderSource {
  const char* vertex;
  const char* fragment;
};

extern const ShaderSource kSurfaceShader;
extern const ShaderSource kShadowShader;
extern const ShaderSource kLineShader;

/// Prepended to every fragment shader.
extern const char* const kFragmentPrelude;

/// In the highest byte of a sample's second word; materials of the list follow these.
constexpr int kGroundKind = 1, kPaintKind = 2, kFirstMaterial = 3, kMaterialsMost = 128;

}  // namespace swarf::render
