#include "render/raster/shaders.h"

namespace swarf::render {

const char* const kFragmentPrelude = R"(#version 330 core
const uint kPaint = 2u;

// Linear to sRGB through square roots, fitted to the standard's curve (error below 0.003 above 0.002).
vec3 srgb(vec3 c) {
  vec3 s = sqrt(max(c, 0.0));
  vec3 ss = sqrt(s);
  return clamp(0.585122381 * s + 0.783140355 * ss - 0.368262736 * sqrt(ss), 0.0, 1.0);
}

// A sample in two words: the normal on an octahedron, 16 bits each way; paint as sRGB bytes under the kind.
uint packed_normal(vec3 n) {
  vec2 e = n.xy / max(abs(n.x) + abs(n.y) + abs(n.z), 1e-20);
  vec2 folded = (1.0 - abs(e.yx)) * vec2(e.x >= 0.0 ? 1.0 : -1.0, e.y >= 0.0 ? 1.0 : -1.0);
  uvec2 place = uvec2((n.z >= 0.0 ? e : folded) * 32767.5 + 32768.0);
  return place.x | (place.y << 16);
}
uint packed_paint(vec3 paint, uint kind) {
  uvec3 c = uvec3(paint * 255.0 + 0.5);
  return c.r | (c.g << 8) | (c.b << 16) | (kind << 24);
}
)";

const ShaderSource kSurfaceShader = {
    R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 colour;
uniform mat4 world_from_mesh;
uniform mat4 clip_from_world;
out vec3 world;
out vec3 world_normal;
out vec3 paint;
void main() {
  vec4 p = world_from_mesh * vec4(position, 1.0);
  world = p.xyz;
  world_normal = mat3(world_from_mesh) * normal;
  paint = colour.rgb;
  gl_Position = clip_from_world * p;
})",
    R"(
in vec3 world;
in vec3 world_normal;
out uvec2 result;

// Few items have colours of their own at each vertex: all others are spared them.
#ifdef COLOURS
in vec3 paint;
uniform int material;
uint painted() { return packed_paint(paint, uint(material)); }
#else
uniform uint paint_word;
uint painted() { return paint_word; }
#endif

#ifdef SECTION  // a program of its own: where a pixel may be dropped, depth is not tested before it is made
uniform vec4 section;  // what lies above the plane xyz . p = w is not drawn
uniform vec3 section_colour;
#endif

void main() {
#ifdef SECTION
  // The back of a closed body seen through its section stands for the face of the cut: beyond the plane only
  // material hides it.
  if (dot(section.xyz, world) > section.w) discard;
  if (!gl_FrontFacing) {
    result = uvec2(0u, packed_paint(srgb(section_colour), kPaint));
    return;
  }
#endif
  result = uvec2(packed_normal(world_normal), painted());
})"};

const ShaderSource kShadowShader = {
    R"(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 world_from_mesh;
uniform mat4 clip_from_world;
void main() { gl_Position = clip_from_world * (world_from_mesh * vec4(position, 1.0)); })",
    R"(
void main() {})"};

const ShaderSource kLineShader = {
    R"(#version 330 core
layout(location = 0) in vec3 ndc;
layout(location = 1) in vec3 colour;
out vec3 paint;
void main() {
  paint = colour;
  gl_Position = vec4(ndc, 1.0);
})",
    R"(
in vec3 paint;
out uvec2 result;
void main() { result = uvec2(0u, packed_paint(srgb(paint), kPaint)); })"};

}  // namespace swarf::render
