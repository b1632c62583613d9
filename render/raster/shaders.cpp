#include "render/raster/shaders.h"

namespace swarf::render {

const char* const kFragmentPrelude = R"(#version 330 core
uniform sampler2DShadow shadow_map;
uniform mat4 light_from_world;

// t runs from the bottom (0) to the top (1) of the picture.
vec3 background(float t) {
  return mix(vec3(0.50, 0.53, 0.56), vec3(0.86, 0.89, 0.92), smoothstep(0.0, 1.0, t));
}

// Where a point lies in the shadow map, 0..1 in each coordinate inside it.
vec3 shadow_place(vec3 world) { return (light_from_world * vec4(world, 1.0)).xyz * 0.5 + 0.5; }

// Linear up to 0.7, then a shoulder that never reaches 1.
vec3 tone(vec3 c) {
  vec3 over = max(c - 0.7, 0.0);
  return min(c, 0.7) + over / (1.0 + over / 0.3);
}

// Linear to sRGB through square roots, fitted to the standard's curve (error below 0.003 above 0.002); once per
// pixel here instead of once per sample in the framebuffer.
vec4 srgb(vec3 c) {
  vec3 s = sqrt(max(c, 0.0));
  vec3 ss = sqrt(s);
  return vec4(clamp(0.585122381 * s + 0.783140355 * ss - 0.368262736 * sqrt(ss), 0.0, 1.0), 1.0);
}
)";

const ShaderSource kMeshShader = {
    R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 colour;
uniform mat4 world_from_mesh;
uniform mat4 clip_from_world;
uniform vec3 base_colour;
uniform int has_colours;
out vec3 world;
out vec3 world_normal;
out vec3 albedo;
void main() {
  vec4 p = world_from_mesh * vec4(position, 1.0);
  world = p.xyz;
  world_normal = mat3(world_from_mesh) * normal;
  vec3 c = colour.rgb;  // sRGB to linear, cubic fit, error below 0.004
  albedo = has_colours != 0 ? c * (c * (c * 0.305306011 + 0.682171111) + 0.012522878) : base_colour;
  gl_Position = clip_from_world * p;
})",
    R"(
in vec3 world;
in vec3 world_normal;
in vec3 albedo;
uniform int has_normals;
uniform vec3 eye;
uniform vec3 key;   // unit, towards the light
uniform vec3 softbox;  // unit, between the key light and the zenith
uniform vec3 fill;
uniform vec3 rim;
uniform float metalness;
uniform float roughness;
uniform float texel_mm;  // of the shadow map
uniform float texel;
out vec4 result;

// A studio as seen in a mirror: floor, walls, a wide soft box above.
vec3 studio(vec3 d, float blur) {
  float up = d.z;
  vec3 c = mix(vec3(0.20, 0.21, 0.22), vec3(0.62, 0.66, 0.70), smoothstep(-0.35 - blur, 0.35 + blur, up));
  float box = smoothstep(0.55 - 0.5 * blur, 0.80 + 0.3 * blur, dot(d, softbox));
  return c + vec3(1.0, 0.98, 0.95) * box * (1.0 - 0.6 * blur);
}

#ifdef SECTION  // a program of its own: where a pixel may be dropped, depth is not tested before shading
uniform vec4 section;  // what lies above the plane xyz . p = w is not drawn
#endif

void main() {
#ifdef SECTION
  // The back of a closed body seen through its section stands for the face of the cut: beyond the plane only
  // material hides it.
  if (dot(section.xyz, world) > section.w) discard;
  if (!gl_FrontFacing) {
    float facing = 0.5 + 0.5 * dot(section.xyz, key);
    result = srgb(vec3(0.62, 0.24, 0.10) * (0.6 + 0.4 * facing));
    return;
  }
#endif
  vec3 v = normalize(eye - world);
  vec3 n = has_normals != 0 ? normalize(world_normal) : normalize(cross(dFdx(world), dFdy(world)));
  if (dot(n, v) < 0.0) n = -n;
  float nv = max(dot(n, v), 0.02);
  float nl = dot(n, key);
  // Two filtered taps across the texel grid: eight texels weigh in. The map holds the whole scene.
  vec3 p = shadow_place(world + n * (1.5 * texel_mm));
  float lit = 0.5 * (texture(shadow_map, p + vec3(-0.6 * texel, -0.3 * texel, 0.0)) +
                     texture(shadow_map, p + vec3(0.6 * texel, 0.3 * texel, 0.0)));
  nl = max(nl, 0.0) * lit;

  vec3 diffuse = albedo * (1.0 - metalness);
  vec3 f0 = mix(vec3(0.04), albedo, metalness);
  vec3 sky = mix(vec3(0.17, 0.165, 0.16), vec3(0.36, 0.375, 0.40), 0.5 + 0.5 * n.z);
  vec3 light = sky + vec3(1.0, 0.975, 0.94) * (0.78 * nl) + vec3(0.80, 0.88, 1.0) * (0.22 * max(dot(n, fill), 0.0));

  // GGX lobe of the key light with the visibility term of a half vector (Karis's mobile approximation).
  float a = max(roughness * roughness, 0.02);
  vec3 h = normalize(v + key);
  float nh = max(dot(n, h), 0.0);
  float lh = max(dot(key, h), 0.1);
  float d = nh * nh * (a * a - 1.0) + 1.0;
  float lobe = a * a / (12.566 * d * d * lh * lh * (roughness + 0.5)) * nl;
  float edge = (1.0 - nv) * (1.0 - nv);
  edge *= edge * (1.0 - nv);
  vec3 mirror = f0 + (max(vec3(1.0 - roughness), f0) - f0) * edge;
  vec3 specular = f0 * min(lobe, 4.0) * 2.2 + mirror * studio(reflect(-v, n), roughness) * (1.0 - 0.45 * roughness);
  specular += vec3(0.9, 0.95, 1.0) * (0.25 * edge * max(dot(n, rim), 0.0));
  result = srgb(tone(diffuse * light + specular));
})"};

const ShaderSource kShadowShader = {
    R"(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 world_from_mesh;
uniform mat4 clip_from_world;
void main() { gl_Position = clip_from_world * (world_from_mesh * vec4(position, 1.0)); })",
    R"(
void main() {})"};

const ShaderSource kGroundShader = {
    R"(#version 330 core
uniform mat4 clip_from_world;
uniform vec3 centre;
uniform float radius;
out vec3 world;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  world = centre + vec3(corner * radius, 0.0);
  gl_Position = clip_from_world * vec4(world, 1.0);
})",
    R"(
in vec3 world;
uniform vec3 centre;
uniform float radius;
uniform float height_px;
out vec4 result;
void main() {
  float r = length(world.xy - centre.xy) / radius;
  float fade = 1.0 - smoothstep(0.25, 1.0, r);
  vec3 p = shadow_place(world);
  bool outside = any(lessThan(p, vec3(0.0))) || any(greaterThan(p, vec3(1.0)));
  float shade = outside ? 1.0 : mix(0.58, 1.0, texture(shadow_map, p));
  // Darker close to the scene, where its bulk hides part of the sky.
  shade *= mix(0.80, 1.0, smoothstep(0.08, 0.45, r));
  vec3 floor_colour = vec3(0.56, 0.58, 0.60) * shade;
  result = srgb(mix(background(gl_FragCoord.y / height_px), floor_colour, fade));
})"};

const ShaderSource kBackgroundShader = {
    R"(#version 330 core
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 1.0, 1.0); })",
    R"(
uniform float height_px;
out vec4 result;
void main() { result = srgb(background(gl_FragCoord.y / height_px)); })"};

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
out vec4 result;
void main() { result = srgb(paint); })"};

}  // namespace swarf::render
