#include "render/raster/raster_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <future>
#include <string>

#include "base/check.h"
#include "base/parallel.h"
#include "render/figures/colour.h"
#include "render/raster/depth_range.h"
#include "render/raster/gl_api.h"
#include "render/raster/gpu_mesh.h"
#include "render/raster/line_quads.h"
#include "render/raster/sample_resolver.h"
#include "render/raster/scene_view.h"
#include "render/raster/shaders.h"

namespace swarf::render {
namespace {

constexpr int kBandRows =
    48;  // px that are read and shaded before the next are read: what is read stays near

GLuint compile(const GlApi& gl, const ShaderSource& source, const std::string& define = "") {
  const GLuint program = gl.CreateProgram();
  const std::string fragment = kFragmentPrelude + define + source.fragment;
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
  void set(const char* name, int value) const { gl_.Uniform1i(at(name), value); }
  void set(const char* name, GLuint value) const { gl_.Uniform1ui(at(name), value); }

 private:
  GLint at(const char* name) const { return gl_.GetUniformLocation(program_, name); }
  const GlApi& gl_;
  GLuint program_;
};

/// As the shaders pack it.
GLuint packed_paint(const Rgb& linear, int kind) {
  const std::array<uint8_t, 4> c = srgb8_from_linear(linear);
  return c[0] | GLuint{c[1]} << 8 | GLuint{c[2]} << 16 | static_cast<GLuint>(kind) << 24;
}

}  // namespace

struct RasterRenderer::Impl {
  struct Drawn {
    const DrawItem* item;
    const GpuMesh* mesh;
    Vec3 centre;
    int material;  ///< in `materials`
  };
  /// Of meshes of one colour and of those with colours at their vertices.
  struct SurfacePrograms {
    GLuint plain = 0, coloured = 0;
  };

  Impl(int width_px, int height_px, int samples_per_px);
  void compile_programs();
  void make_line_array();
  void make_surfaces();
  void make_shadow_target();
  GLuint attach_buffer(GLenum attachment);
  void require_complete() const;
  /// Large enough for the map.
  void fit_shadow_target(const SceneView& view);
  void begin_frame();
  Box upload(const DrawList& list);
  int material_of(const Material& material);
  void draw_shadow(const SceneView& view, bool section);
  void draw_surfaces(const SceneView& view, const DrawList& list);
  void draw_items(const SceneView& view, const DrawList& list, bool sectioned);
  void draw_lines(const SceneView& view, const std::vector<DrawLine>& lines);
  void draw_triangles(const GpuMesh& mesh, bool enclosed_too, bool both_sides);
  void read_shadow(const SceneView& view);
  Image shade(const SceneView& view, const Camera& camera);

  OsmesaContext context;
  const GlApi& gl;
  GpuMeshCache meshes;
  int width, height, side;  ///< px; samples of a pixel each way
  GLuint surfaces = 0, shadow_target = 0, shadow_buffer = 0;
  std::array<int, 2> shadow_size{};  ///< texels of `shadow_buffer`
  SurfacePrograms surface_programs, section_programs;
  GLuint shadow_program, line_program;
  GLuint line_array = 0, line_buffer = 0;
  int frame = kDepthRanges - 1;     ///< the last
  DepthRange depths;                ///< of this frame, in both targets
  bool shadow_made = false;         ///< anew, for this frame
  std::array<SampleBand, 2> bands;  ///< one is read while the other is shaded
  ShadowMap shadow;
  std::vector<std::array<float, 2>> materials;  ///< metalness and roughness
  std::vector<Drawn> drawn;
};

RasterRenderer::Impl::Impl(int width_px, int height_px, int samples_per_px)
    : gl(context.gl()), meshes(gl), width(width_px), height(height_px), side(samples_per_px == 4 ? 2 : 1) {
  SWARF_CHECK(width > 0 && height > 0, "a picture needs pixels");
  SWARF_CHECK(side * side == samples_per_px, "1 or 4 samples per pixel");
  for (SampleBand& band : bands) {
    band.width = width;
    band.side = side;
  }
  make_surfaces();
  make_shadow_target();
  gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
  compile_programs();
  make_line_array();
}

void RasterRenderer::Impl::compile_programs() {
  surface_programs = {compile(gl, kSurfaceShader), compile(gl, kSurfaceShader, "#define COLOURS\n")};
  section_programs = {compile(gl, kSurfaceShader, "#define SECTION\n"),
                      compile(gl, kSurfaceShader, "#define SECTION\n#define COLOURS\n")};
  shadow_program = compile(gl, kShadowShader);
  line_program = compile(gl, kLineShader);
}

void RasterRenderer::Impl::make_line_array() {
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

GLuint RasterRenderer::Impl::attach_buffer(GLenum attachment) {
  GLuint buffer = 0;
  gl.GenRenderbuffers(1, &buffer);
  gl.BindRenderbuffer(GL_RENDERBUFFER, buffer);
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, buffer);
  return buffer;
}

/// Depths, and the words of what is seen, in the formats in which they are read: nothing is converted.
void RasterRenderer::Impl::make_surfaces() {
  gl.GenFramebuffers(1, &surfaces);
  gl.BindFramebuffer(GL_FRAMEBUFFER, surfaces);
  attach_buffer(GL_DEPTH_ATTACHMENT);
  gl.RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, side * width, side * height);
  attach_buffer(GL_COLOR_ATTACHMENT0);
  gl.RenderbufferStorage(GL_RENDERBUFFER, GL_RG32UI, side * width, side * height);
  require_complete();
}

void RasterRenderer::Impl::make_shadow_target() {
  gl.GenFramebuffers(1, &shadow_target);
  gl.BindFramebuffer(GL_FRAMEBUFFER, shadow_target);
  gl.DrawBuffer(GL_NONE);
  shadow_buffer = attach_buffer(GL_DEPTH_ATTACHMENT);
}

void RasterRenderer::Impl::require_complete() const {
  SWARF_CHECK(gl.CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE,
              "OSMesa refuses a framebuffer");
}

/// It is cleared whole, so it is no larger than what is drawn of the map by more than steps
/// that spare a moving camera a new one each frame.
void RasterRenderer::Impl::fit_shadow_target(const SceneView& view) {
  constexpr int kStep = 256;  // texels
  const auto stepped = [](int texels) { return (texels + kStep - 1) / kStep * kStep; };
  const std::array<int, 2> wanted{stepped(view.shadow_columns), stepped(view.shadow_rows)};
  if (wanted == shadow_size) return;
  shadow_size = wanted;
  gl.BindRenderbuffer(GL_RENDERBUFFER, shadow_buffer);
  gl.RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, wanted[0], wanted[1]);
  require_complete();
  shadow_made = true;
}

void RasterRenderer::Impl::begin_frame() {
  frame = (frame + 1) % kDepthRanges;
  depths = depth_range(frame);
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_LEQUAL);
  gl.DepthRange(depths.nearest, depths.farthest);
}

Box RasterRenderer::Impl::upload(const DrawList& list) {
  drawn.clear();
  materials.clear();
  Box bounds{Vec3::Constant(1e30), Vec3::Constant(-1e30)};
  for (const DrawItem& item : list.items) {
    SWARF_CHECK(item.mesh != nullptr, "an item without a mesh");
    if (item.mesh->triangles.empty()) continue;
    const GpuMesh& mesh = meshes.get(item);
    drawn.push_back({&item, &mesh, item.X_world * mesh.bounds.centre(), material_of(item.material)});
    extend(bounds, mesh.bounds, item.X_world);
  }
  meshes.collect();
  // Nearest first: with one sample a pixel, what is hidden by something in front is left out early.
  std::stable_sort(drawn.begin(), drawn.end(), [&](const Drawn& a, const Drawn& b) {
    return (a.centre - list.camera.eye).norm() < (b.centre - list.camera.eye).norm();
  });
  if (drawn.empty()) bounds = {list.camera.target, list.camera.target};
  return bounds;
}

/// The index of its metalness and roughness; where the table is full, of those that are nearest.
int RasterRenderer::Impl::material_of(const Material& material) {
  const std::array<float, 2> wanted{material.metalness, material.roughness};
  const auto found = std::find(materials.begin(), materials.end(), wanted);
  if (found != materials.end()) return static_cast<int>(found - materials.begin());
  if (materials.size() < static_cast<size_t>(kMaterialsMost)) {
    materials.push_back(wanted);
    return static_cast<int>(materials.size()) - 1;
  }
  const auto off = [&](const std::array<float, 2>& m) {
    return std::hypot(m[0] - wanted[0], m[1] - wanted[1]);
  };
  return static_cast<int>(std::min_element(materials.begin(), materials.end(),
                                           [&](const auto& a, const auto& b) { return off(a) < off(b); }) -
                          materials.begin());
}

/// Backs are dropped where they cannot be seen: half of the work.
void RasterRenderer::Impl::draw_triangles(const GpuMesh& mesh, bool enclosed_too, bool both_sides) {
  if (mesh.closed && !both_sides) {
    gl.Enable(GL_CULL_FACE);
  } else {
    gl.Disable(GL_CULL_FACE);
  }
  gl.BindVertexArray(mesh.vertex_array);
  gl.DrawElements(GL_TRIANGLES, enclosed_too ? mesh.index_count : mesh.outside_count, GL_UNSIGNED_INT,
                  nullptr);
}

/// What is cut open casts no shadow: its missing half would shade its own section.
void RasterRenderer::Impl::draw_shadow(const SceneView& view, bool section) {
  gl.BindFramebuffer(GL_FRAMEBUFFER, shadow_target);
  fit_shadow_target(view);
  gl.Viewport(0, 0, view.shadow_columns, view.shadow_rows);
  // Whole: where only a part is to be cleared llvmpipe draws a rectangle, which takes longer.
  if (frame == 0 || shadow_made) gl.Clear(GL_DEPTH_BUFFER_BIT);
  shadow_made = false;
  gl.Enable(GL_POLYGON_OFFSET_FILL);
  gl.PolygonOffset(1.5F, 4.0F);
  const Uniforms uniforms(gl, shadow_program);
  uniforms.set("clip_from_world", view.light_clip_from_world);
  for (const Drawn& one : drawn) {
    if (section && one.item->sectioned) continue;
    if (!may_lie_within(view.light_clip_from_world, one.mesh->bounds, one.item->X_world)) continue;
    uniforms.set("world_from_mesh", one.item->X_world.matrix());
    draw_triangles(*one.mesh, false, false);  // the light stands outside of everything
  }
  gl.Disable(GL_POLYGON_OFFSET_FILL);
}

/// The items that the section cuts open, or all others.
void RasterRenderer::Impl::draw_items(const SceneView& view, const DrawList& list, bool sectioned) {
  const SurfacePrograms& programs = sectioned ? section_programs : surface_programs;
  for (const GLuint program : {programs.plain, programs.coloured}) {
    const Uniforms uniforms(gl, program);
    uniforms.set("clip_from_world", view.clip_from_world);
    if (!sectioned) continue;
    const auto facing = static_cast<float>(0.8 + 0.2 * list.section->normal.dot(view.key));
    uniforms.set_plane("section", list.section->normal, list.section->point);
    uniforms.set("section_colour", Rgb{facing * kCutFace[0], facing * kCutFace[1], facing * kCutFace[2]});
  }
  for (const Drawn& one : drawn) {
    if ((list.section && one.item->sectioned) != sectioned) continue;
    if (!may_lie_within(view.clip_from_world, one.mesh->bounds, one.item->X_world)) continue;
    const Uniforms uniforms(gl, one.mesh->has_colours ? programs.coloured : programs.plain);
    uniforms.set("world_from_mesh", one.item->X_world.matrix());
    if (one.mesh->has_colours) {
      uniforms.set("material", kFirstMaterial + one.material);
    } else {
      uniforms.set("paint_word", packed_paint(one.item->material.colour, kFirstMaterial + one.material));
    }
    draw_triangles(*one.mesh, sectioned || is_looked_into(view, list.camera.eye, *one.item), sectioned);
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

void RasterRenderer::Impl::draw_surfaces(const SceneView& view, const DrawList& list) {
  gl.BindFramebuffer(GL_FRAMEBUFFER, surfaces);
  gl.Viewport(0, 0, side * width, side * height);
  if (frame == 0) gl.Clear(GL_DEPTH_BUFFER_BIT);
  draw_items(view, list, false);
  if (list.section) draw_items(view, list, true);
  draw_lines(view, list.lines);
}

void RasterRenderer::Impl::read_shadow(const SceneView& view) {
  shadow.width = view.shadow_columns;
  shadow.rows = view.shadow_rows;
  shadow.range = depths;
  shadow.depths.resize(static_cast<size_t>(shadow.width) * static_cast<size_t>(shadow.rows));
  gl.BindFramebuffer(GL_FRAMEBUFFER, shadow_target);
  gl.ReadPixels(0, 0, shadow.width, shadow.rows, GL_DEPTH_COMPONENT, GL_FLOAT, shadow.depths.data());
}

Image RasterRenderer::Impl::shade(const SceneView& view, const Camera& camera) {
  Image image{width, height,
              std::vector<uint8_t>(size_t{4} * static_cast<size_t>(width) * static_cast<size_t>(height))};
  read_shadow(view);
  const Lighting light = lighting(view, camera.eye, width, height, materials, shadow, depths);
  gl.BindFramebuffer(GL_FRAMEBUFFER, surfaces);
  const auto beside = thread_count() > 1 ? std::launch::async : std::launch::deferred;
  std::array<std::future<void>, 2> shading;
  for (int top = 0, turn = 0; top < height; top += kBandRows, turn = 1 - turn) {
    SampleBand& band = bands.at(static_cast<size_t>(turn));
    std::future<void>& busy = shading.at(static_cast<size_t>(turn));
    if (busy.valid()) busy.get();
    band.resize(std::min(kBandRows, height - top));
    band.farthest = depths.farthest;
    const int low = side * (height - top - band.rows);  // OpenGL counts rows from below
    gl.ReadPixels(0, low, side * width, side * band.rows, GL_RG_INTEGER, GL_UNSIGNED_INT, band.words.data());
    gl.ReadPixels(0, low, side * width, side * band.rows, GL_DEPTH_COMPONENT, GL_FLOAT, band.depths.data());
    busy = std::async(beside, [&, top] { resolve(band, light, top, image); });
  }
  for (std::future<void>& last : shading)
    if (last.valid()) last.get();
  SWARF_CHECK(gl.GetError() == GL_NO_ERROR, "OpenGL reports an error after a frame");
  return image;
}

RasterRenderer::RasterRenderer(int width, int height, int samples)
    : impl_(std::make_unique<Impl>(width, height, samples)) {}

RasterRenderer::~RasterRenderer() = default;

Image RasterRenderer::draw(const DrawList& list) {
  Impl& impl = *impl_;
  impl.context.make_current();
  const Box bounds = impl.upload(list);
  const SceneView view = scene_view(list.camera, bounds, static_cast<double>(impl.width) / impl.height);
  impl.begin_frame();
  impl.draw_shadow(view, list.section.has_value());
  impl.draw_surfaces(view, list);
  return impl.shade(view, list.camera);
}

}  // namespace swarf::render
