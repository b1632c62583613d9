#include "render/raster/raster_renderer.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>

#include "base/check.h"
#include "render/raster/gl_api.h"
#include "render/raster/gpu_mesh.h"
#include "render/raster/line_quads.h"
#include "render/raster/scene_view.h"
#include "render/raster/shaders.h"

namespace swarf::render {
namespace {

constexpr int kShadowSize = 2048;  // pixels of the shadow map, both ways

GLuint compile(const GlApi& gl, const ShaderSource& source, const char* define = "") {
  const GLuint program = gl.CreateProgram();
  const std::string fragment = std::string(kFragmentPrelude) + define + source.fragment;
  const char* texts[] = {source.vertex, fragment.c_str()};
  const GLenum kinds[] = {GL_VERTEX_SHADER, GL_FRAGMENT_SHADER};
  for (int i = 0; i < 2; ++i) {
    const GLuint shader = gl.CreateShader(kinds[i]);
    gl.ShaderSource(shader, 1, &texts[i], nullptr);
    gl.CompileShader(shader);
    gl.AttachShader(program, shader);
    gl.DeleteShader(shader);
  }
  gl.LinkProgram(program);
  GLint linked = 0;
  gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
  char log[1024] = "";
  if (linked == 0) gl.GetProgramInfoLog(program, sizeof log, nullptr, log);
  SWARF_CHECK(linked != 0, log);
  return program;
}

/// A program in use and its uniforms by name.
class Uniforms {
 public:
  Uniforms(const GlApi& gl, GLuint program) : gl_(gl), program_(program) { gl.UseProgram(program); }
  void set(const char* name, const Eigen::Matrix4d& value) const {
    const Eigen::Matrix4f single = value.cast<float>();
    gl_.UniformMatrix4fv(at(name), 1, GL_FALSE, single.data());
  }
  void set(const char* name, const Vec3& v) const {
    gl_.Uniform3f(at(name), static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()));
  }
  void set(const char* name, const Rgb& c) const { gl_.Uniform3f(at(name), c[0], c[1], c[2]); }
  void set_plane(const char* name, const Vec3& normal, const Vec3& point) const {
    gl_.Uniform4f(at(name), static_cast<float>(normal.x()), static_cast<float>(normal.y()),
                  static_cast<float>(normal.z()), static_cast<float>(normal.dot(point)));
  }
  void set(const char* name, double value) const { gl_.Uniform1f(at(name), static_cast<float>(value)); }
  void set(const char* name, int value) const { gl_.Uniform1i(at(name), value); }

 private:
  GLint at(const char* name) const { return gl_.GetUniformLocation(program_, name); }
  const GlApi& gl_;
  GLuint program_;
};

}  // namespace

struct RasterRenderer::Impl {
  struct Drawn {
    const DrawItem* item;
    const GpuMesh* mesh;
    Vec3 centre;
  };

  Impl(int width_px, int height_px, int samples);
  GLuint make_target(int samples);
  void make_shadow_map();
  Box upload(const DrawList& list);
  void draw_shadow(const SceneView& view, bool section);
  void draw_backdrop(const SceneView& view);
  void draw_items(const SceneView& view, const DrawList& list, bool sectioned);
  void draw_lines(const SceneView& view, const std::vector<DrawLine>& lines);
  void draw_triangles(const GpuMesh& mesh, bool both_sides = false);
  Image read();

  OsmesaContext context;
  const GlApi& gl;
  GpuMeshCache meshes;
  int width, height;
  GLuint target = 0, resolved = 0, shadow_target = 0, shadow_texture = 0;
  GLuint mesh_program, section_program, shadow_program, ground_program, background_program, line_program;
  GLuint empty_array = 0, line_array = 0, line_buffer = 0;
  std::vector<Drawn> drawn;
};

RasterRenderer::Impl::Impl(int width_px, int height_px, int samples)
    : gl(context.gl()), meshes(gl), width(width_px), height(height_px) {
  GLint most = 0;
  gl.GetIntegerv(GL_MAX_SAMPLES, &most);
  SWARF_CHECK(width > 0 && height > 0, "a picture needs pixels");
  SWARF_CHECK(samples >= 1 && samples <= most, "samples per pixel outside 1.." + std::to_string(most));
  target = make_target(samples == 1 ? 0 : samples);
  resolved = make_target(0);
  make_shadow_map();
  mesh_program = compile(gl, kMeshShader);
  section_program = compile(gl, kMeshShader, "#define SECTION\n");
  shadow_program = compile(gl, kShadowShader);
  ground_program = compile(gl, kGroundShader);
  background_program = compile(gl, kBackgroundShader);
  line_program = compile(gl, kLineShader);
  gl.GenVertexArrays(1, &empty_array);
  gl.GenVertexArrays(1, &line_array);
  gl.GenBuffers(1, &line_buffer);
  gl.BindVertexArray(line_array);
  gl.BindBuffer(GL_ARRAY_BUFFER, line_buffer);
  gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(LineVertex), nullptr);
  // With a buffer bound, OpenGL takes the pointer as an offset into it.
  // NOLINTNEXTLINE(performance-no-int-to-ptr)
  const auto* colour_offset = reinterpret_cast<const void*>(offsetof(LineVertex, colour));
  gl.VertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(LineVertex), colour_offset);
  gl.EnableVertexAttribArray(0);
  gl.EnableVertexAttribArray(1);
}

GLuint RasterRenderer::Impl::make_target(int samples) {
  GLuint framebuffer = 0;
  GLuint buffers[2] = {};
  gl.GenFramebuffers(1, &framebuffer);
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  gl.GenRenderbuffers(2, buffers);
  const GLenum formats[] = {GL_RGBA8, GL_DEPTH_COMPONENT24};
  const GLenum attachments[] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_ATTACHMENT};
  for (int i = 0; i < 2; ++i) {
    gl.BindRenderbuffer(GL_RENDERBUFFER, buffers[i]);
    gl.RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, formats[i], width, height);
    gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, attachments[i], GL_RENDERBUFFER, buffers[i]);
  }
  SWARF_CHECK(gl.CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE,
              "OSMesa refuses the picture's framebuffer");
  return framebuffer;
}

void RasterRenderer::Impl::make_shadow_map() {
  gl.GenTextures(1, &shadow_texture);
  gl.BindTexture(GL_TEXTURE_2D, shadow_texture);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, kShadowSize, kShadowSize, 0, GL_DEPTH_COMPONENT,
                GL_UNSIGNED_INT, nullptr);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  gl.GenFramebuffers(1, &shadow_target);
  gl.BindFramebuffer(GL_FRAMEBUFFER, shadow_target);
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, shadow_texture, 0);
  gl.DrawBuffer(GL_NONE);
  SWARF_CHECK(gl.CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE,
              "OSMesa refuses the shadow map");
}

Box RasterRenderer::Impl::upload(const DrawList& list) {
  drawn.clear();
  Box bounds{Vec3::Constant(1e30), Vec3::Constant(-1e30)};
  for (const DrawItem& item : list.items) {
    SWARF_CHECK(item.mesh != nullptr, "an item without a mesh");
    if (item.mesh->triangles.empty()) continue;
    const GpuMesh& mesh = meshes.get(item);
    drawn.push_back({&item, &mesh, item.X_world * mesh.bounds.centre()});
    extend(bounds, mesh.bounds, item.X_world);
  }
  meshes.collect();
  // Nearest first: a pixel hidden by something in front is not shaded.
  std::stable_sort(drawn.begin(), drawn.end(), [&](const Drawn& a, const Drawn& b) {
    return (a.centre - list.camera.eye).norm() < (b.centre - list.camera.eye).norm();
  });
  if (drawn.empty()) bounds = {list.camera.target, list.camera.target};
  return bounds;
}

/// Backs are dropped where they cannot be seen: half of the work.
void RasterRenderer::Impl::draw_triangles(const GpuMesh& mesh, bool both_sides) {
  if (mesh.closed && !both_sides) {
    gl.Enable(GL_CULL_FACE);
  } else {
    gl.Disable(GL_CULL_FACE);
  }
  gl.BindVertexArray(mesh.vertex_array);
  gl.DrawElements(GL_TRIANGLES, mesh.index_count, GL_UNSIGNED_INT, nullptr);
}

/// What is cut open casts none: its missing half would shade its own section.
void RasterRenderer::Impl::draw_shadow(const SceneView& view, bool section) {
  gl.BindFramebuffer(GL_FRAMEBUFFER, shadow_target);
  gl.Viewport(0, 0, kShadowSize, kShadowSize);
  gl.Clear(GL_DEPTH_BUFFER_BIT);
  gl.Enable(GL_POLYGON_OFFSET_FILL);
  gl.PolygonOffset(1.5F, 4.0F);
  const Uniforms uniforms(gl, shadow_program);
  uniforms.set("clip_from_world", view.light_clip_from_world);
  for (const Drawn& one : drawn) {
    if (section && one.item->sectioned) continue;
    uniforms.set("world_from_mesh", one.item->X_world.matrix());
    draw_triangles(*one.mesh);
  }
  gl.Disable(GL_POLYGON_OFFSET_FILL);
}

void RasterRenderer::Impl::draw_backdrop(const SceneView& view) {
  gl.Disable(GL_CULL_FACE);
  // Drawn last, where nothing else is: software pays for every pixel it shades.
  gl.BindVertexArray(empty_array);
  const Uniforms ground(gl, ground_program);
  ground.set("height_px", static_cast<double>(height));
  ground.set("clip_from_world", view.clip_from_world);
  ground.set("light_from_world", view.light_clip_from_world);
  ground.set("centre", view.ground_centre);
  ground.set("radius", view.ground_radius);
  gl.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  const Uniforms background(gl, background_program);
  background.set("height_px", static_cast<double>(height));
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
}

/// The items that the section cuts open, or all others.
void RasterRenderer::Impl::draw_items(const SceneView& view, const DrawList& list, bool sectioned) {
  const Uniforms uniforms(gl, sectioned ? section_program : mesh_program);
  if (sectioned) uniforms.set_plane("section", list.section->normal, list.section->point);
  uniforms.set("clip_from_world", view.clip_from_world);
  uniforms.set("light_from_world", view.light_clip_from_world);
  uniforms.set("eye", list.camera.eye);
  uniforms.set("key", view.key);
  uniforms.set("softbox", (view.key + Vec3(0.0, 0.0, 0.5)).normalized());
  uniforms.set("fill", view.fill);
  uniforms.set("rim", view.rim);
  uniforms.set("texel", 1.0 / kShadowSize);
  uniforms.set("texel_mm", view.light_extent_mm / kShadowSize);
  for (const Drawn& one : drawn) {
    if ((list.section && one.item->sectioned) != sectioned) continue;
    const Material& material = one.item->material;
    uniforms.set("world_from_mesh", one.item->X_world.matrix());
    uniforms.set("base_colour", material.colour);
    uniforms.set("metalness", static_cast<double>(material.metalness));
    uniforms.set("roughness", static_cast<double>(material.roughness));
    uniforms.set("has_normals", one.mesh->has_normals ? 1 : 0);
    uniforms.set("has_colours", one.mesh->has_colours ? 1 : 0);
    draw_triangles(*one.mesh, sectioned);
  }
}

void RasterRenderer::Impl::draw_lines(const SceneView& view, const std::vector<DrawLine>& lines) {
  const std::vector<LineVertex> quads = line_quads(lines, view.clip_from_world, width, height);
  if (quads.empty()) return;
  gl.Disable(GL_CULL_FACE);
  gl.UseProgram(line_program);
  gl.BindVertexArray(line_array);
  gl.BindBuffer(GL_ARRAY_BUFFER, line_buffer);
  gl.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(quads.size() * sizeof quads[0]), quads.data(),
                GL_STREAM_DRAW);
  gl.DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(quads.size()));
}

Image RasterRenderer::Impl::read() {
  gl.BindFramebuffer(GL_READ_FRAMEBUFFER, target);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved);
  gl.BlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  gl.BindFramebuffer(GL_READ_FRAMEBUFFER, resolved);
  const size_t row = size_t{4} * static_cast<size_t>(width);
  std::vector<uint8_t> bottom_up(row * static_cast<size_t>(height));
  gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl.ReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, bottom_up.data());
  Image image{width, height, std::vector<uint8_t>(bottom_up.size())};
  for (size_t y = 0; y < static_cast<size_t>(height); ++y) {
    std::memcpy(&image.rgba[y * row], &bottom_up[(static_cast<size_t>(height) - 1 - y) * row], row);
  }
  SWARF_CHECK(gl.GetError() == GL_NO_ERROR, "OpenGL reports an error after a frame");
  return image;
}

RasterRenderer::RasterRenderer(int width, int height, int samples)
    : impl_(std::make_unique<Impl>(width, height, samples)) {}

RasterRenderer::~RasterRenderer() = default;

Image RasterRenderer::draw(const DrawList& list) {
  Impl& impl = *impl_;
  const GlApi& gl = impl.gl;
  impl.context.make_current();
  const Box bounds = impl.upload(list);
  const SceneView view = scene_view(list.camera, bounds, static_cast<double>(impl.width) / impl.height);
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_LEQUAL);  // the background lies exactly on the far plane
  impl.draw_shadow(view, list.section.has_value());
  gl.BindFramebuffer(GL_FRAMEBUFFER, impl.target);
  gl.Viewport(0, 0, impl.width, impl.height);
  gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  gl.BindTexture(GL_TEXTURE_2D, impl.shadow_texture);
  impl.draw_items(view, list, false);
  if (list.section) impl.draw_items(view, list, true);
  impl.draw_lines(view, list.lines);
  impl.draw_backdrop(view);
  return impl.read();
}

}  // namespace swarf::render
