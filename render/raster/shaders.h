// The GLSL programs of the rasteriser.
//
//   mesh        key light with a shadow map, fill and rim lights, a studio box reflected by roughness
//   shadow      depth of the scene seen from the key light
//   ground      a floor under the scene that fades into the background and takes the shadow
//   background  vertical gradient
//   line        screen-space quads
//
// Shaders compute in linear light and write sRGB; samples are averaged as stored.
#pragma once

namespace swarf::render {

struct ShaderSource {
  const char* vertex;
  const char* fragment;
};

extern const ShaderSource kMeshShader;
extern const ShaderSource kShadowShader;
extern const ShaderSource kGroundShader;
extern const ShaderSource kBackgroundShader;
extern const ShaderSource kLineShader;

/// Prepended to every fragment shader: version, background gradient, shadow map, tone curve.
extern const char* const kFragmentPrelude;

}  // namespace swarf::render
