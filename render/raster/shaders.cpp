#include "render/raster/shaders.h"

namespace swarf::render {

const char* const kFragmentPrelude = R"(#version 330 core
const uint kGround = 1u, kPaint = 2u, kFirstMaterial = 3u;

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

const ShaderSource kGroundShader = {
    R"(#version 330 core
uniform vec3 depths;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;
  gl_Position = vec4(corner, dot(depths, vec3(corner, 1.0)), 1.0);
})",
    R"(
out uvec2 result;
void main() { result = uvec2(0u, packed_paint(vec3(0.0), kGround)); })"};

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

const ShaderSource kShadeShader = {
    R"(#version 330 core
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); })",
    R"(
#if SAMPLES > 1
uniform usampler2DMS surfaces;
uniform sampler2DMS depths;
#else
uniform usampler2D surfaces;
uniform sampler2D depths;
#endif
uniform vec2 sample_place[SAMPLES];  // in the pixel, 0..1
uniform vec2 materials[MATERIALS];   // metalness, roughness
uniform sampler2DShadow shadow_map;
uniform mat4 light_from_world;
uniform vec2 size_px;
uniform vec3 eye;
uniform vec3 right, up, forward;  // of the picture; at distance 1 right and up reach its edges
uniform vec2 near_far;
uniform vec3 key;      // unit, towards the light
uniform vec3 softbox;  // unit, between the key light and the zenith
uniform vec3 fill;
uniform vec3 rim;
uniform float texel_mm;  // of the shadow map
uniform float texel;
uniform vec3 centre;  // of the floor
uniform float radius;
out vec4 result;

vec2 unpacked_place(uint word) { return vec2(float(word & 0xffffu), float(word >> 16)); }
vec3 normal_at(vec2 place) {
  vec2 e = place * (2.0 / 65535.0) - 1.0;
  vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
  float fold = max(-n.z, 0.0);
  n.xy += vec2(n.x >= 0.0 ? -fold : fold, n.y >= 0.0 ? -fold : fold);
  return normalize(n);
}
vec3 unpacked_paint(uint word) {
  return vec3(float(word & 0xffu), float((word >> 8) & 0xffu), float((word >> 16) & 0xffu)) * (1.0 / 255.0);
}

// t runs from the bottom (0) to the top (1) of the picture.
vec3 background(float t) {
  return mix(vec3(0.50, 0.53, 0.56), vec3(0.86, 0.89, 0.92), smoothstep(0.0, 1.0, t));
}

// Linear up to 0.7, then a shoulder that never reaches 1.
vec3 tone(vec3 c) {
  vec3 over = max(c - 0.7, 0.0);
  return min(c, 0.7) + over / (1.0 + over / 0.3);
}

// A studio as seen in a mirror: floor, walls, a wide soft box above.
vec3 studio(vec3 d, float blur) {
  float height = d.z;
  vec3 c = mix(vec3(0.20, 0.21, 0.22), vec3(0.62, 0.66, 0.70), smoothstep(-0.35 - blur, 0.35 + blur, height));
  float box = smoothstep(0.55 - 0.5 * blur, 0.80 + 0.3 * blur, dot(d, softbox));
  return c + vec3(1.0, 0.98, 0.95) * box * (1.0 - 0.6 * blur);
}

vec3 surface(vec3 v, vec3 n, vec3 albedo, float metalness, float roughness, float lit) {
  float nv = max(dot(n, v), 0.02);
  float nl = max(dot(n, key), 0.0) * lit;
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
  return tone(diffuse * light + specular);
}

// The sRGB colour of one kind of sample; `place`: x and y in the picture -1..1, and the depth 0..1.
vec3 shaded(uint kind, vec3 paint, vec3 n, vec3 place) {
  float distance = near_far.x * near_far.y / (near_far.y - place.z * (near_far.y - near_far.x));
  vec3 world = eye + distance * (forward + place.x * right + place.y * up);
  vec3 v = normalize(eye - world);
  bool ground = kind == kGround;
  n = dot(n, v) < 0.0 ? -n : n;
  // Two filtered taps across the texel grid: eight texels weigh in. The map holds the whole scene.
  vec3 p = (light_from_world * vec4(ground ? world : world + n * (1.5 * texel_mm), 1.0)).xyz * 0.5 + 0.5;
  float lit = 0.5 * (texture(shadow_map, p + vec3(-0.6 * texel, -0.3 * texel, 0.0)) +
                     texture(shadow_map, p + vec3(0.6 * texel, 0.3 * texel, 0.0)));
  vec3 albedo = paint * (paint * (paint * 0.305306011 + 0.682171111) + 0.012522878);  // error below 0.004
  vec2 m = materials[int(max(kind, kFirstMaterial) - kFirstMaterial)];
  vec3 seen = surface(v, n, albedo, m.x, m.y, lit);

  // Darker close to the scene, where its bulk hides part of the sky.
  float r = length(world.xy - centre.xy) / radius;
  bool outside = any(lessThan(p, vec3(0.0))) || any(greaterThan(p, vec3(1.0)));
  float shade = (outside ? 1.0 : mix(0.58, 1.0, lit)) * mix(0.80, 1.0, smoothstep(0.08, 0.45, r));
  float fade = ground && place.z < 1.0 ? 1.0 - smoothstep(0.25, 1.0, r) : 0.0;
  vec3 behind = mix(background((size_px.y - gl_FragCoord.y) / size_px.y), vec3(0.56, 0.58, 0.60) * shade, fade);
  return kind == kPaint ? paint : srgb(kind >= kFirstMaterial ? seen : behind);
}

// Samples of one material and paint whose normals are near are one surface and shaded once, at the first of them;
// each turn takes one surface, and nearly everywhere there is but one. Bits of a paint that hardly show are not
// compared.
void main() {
  const uint kCompared = 0xfff0f0f0u;
  const float kNear = 4000.0;  // of 65535: some 10 degrees
  ivec2 at = ivec2(gl_FragCoord.x, size_px.y - gl_FragCoord.y);  // an image's rows begin at the top
  vec2 normals[SAMPLES];
  uint paints[SAMPLES];
  float left[SAMPLES];
  for (int s = 0; s < SAMPLES; ++s) {
    uvec2 words = texelFetch(surfaces, at, s).xy;
    normals[s] = unpacked_place(words.x);
    paints[s] = words.y;
    left[s] = 1.0;
  }
  vec3 sum = vec3(0.0);
  float done = 0.0;
  do {
    int first = 0;
    vec2 normal = normals[0], place = sample_place[0];
    uint paint = paints[0];
    for (int s = SAMPLES - 1; s >= 0; --s) {
      bool here = left[s] > 0.0;
      normal = here ? normals[s] : normal;
      paint = here ? paints[s] : paint;
      place = here ? sample_place[s] : place;
      first = here ? s : first;
    }
    float count = 0.0;
    vec2 normal_sum = vec2(0.0);
    for (int s = 0; s < SAMPLES; ++s) {
      vec2 off = abs(normals[s] - normal);
      bool same = ((paints[s] ^ paint) & kCompared) == 0u && max(off.x, off.y) < kNear;
      float weight = same ? left[s] : 0.0;
      normal_sum += weight * normals[s];
      count += weight;
      left[s] -= weight;
    }
    vec2 ndc = (vec2(at) + place) / size_px * 2.0 - 1.0;
    sum += count * shaded(paint >> 24, unpacked_paint(paint), normal_at(normal_sum / count),
                          vec3(ndc, texelFetch(depths, at, first).x));
    done += count;
  } while (done < float(SAMPLES) - 0.5);
  result = vec4(sum / float(SAMPLES), 1.0);
})"};

}  // namespace swarf::render
