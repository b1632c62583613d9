#include "render/gltf/gltf_writer.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <sstream>
#include <tuple>

#include "base/check.h"
#include "base/file.h"
#include "base/units.h"
#include "render/figures/colour.h"
#include "render/gltf/gltf_buffer.h"

namespace swarf::render {
namespace {

constexpr double kMetresPerMm = 1e-3;
/// Motion smaller than this is no animation: it is the rounding of the poses themselves.
constexpr double kStillMm = 1e-9, kStillRad = 1e-9;

using Floats3 = std::vector<std::array<float, 3>>;

std::vector<size_t> all_keys(const GltfNode& node) {
  std::vector<size_t> keys(node.times_s.size());
  std::iota(keys.begin(), keys.end(), size_t{0});
  return keys;
}

/// Rotations of the poses as quaternions whose signs follow each other, so that a viewer turns the short way.
std::vector<Eigen::Quaterniond> continuous_rotations(const std::vector<Pose>& poses) {
  std::vector<Eigen::Quaterniond> rotations;
  rotations.reserve(poses.size());
  for (const Pose& pose : poses) {
    Eigen::Quaterniond q(pose.linear());
    q.normalize();
    if (!rotations.empty() && rotations.back().dot(q) < 0.0) q.coeffs() = -q.coeffs();
    rotations.push_back(q);
  }
  return rotations;
}

class Writer {
 public:
  explicit Writer(const GltfScene& scene) : scene_(scene), buffer_(model_) {}
  tinygltf::Model build();

 private:
  int mesh_of(const GltfNode& node);
  int material_of(const Material& material, bool vertex_colours);
  tinygltf::Primitive triangles(const TriMesh& mesh);
  void add_node(const GltfNode& node);
  void animate(const GltfNode& node, int index);
  void add_translation(const GltfNode& node, int index);
  void add_rotation(const GltfNode& node, int index);
  void add_visibility(const GltfNode& node, int index);
  void add_channel(int node, const std::string& path, int times, int values,
                   const char* interpolation = "LINEAR");
  int key_times(const GltfNode& node, const std::vector<size_t>& keys);
  struct LineGroup {
    Floats3 points;
    std::vector<uint32_t> segments;
  };
  void add_lines();
  void add_line_group(const std::string& name, const Rgb& colour, const LineGroup& group);
  int unlit_material(const Rgb& colour);

  const GltfScene& scene_;
  tinygltf::Model model_;
  GltfBuffer buffer_;
  tinygltf::Animation animation_;
  std::map<std::tuple<const TriMesh*, Rgb, float, float>, int> meshes_;
};

/// The normals at unit length, as the format demands; interpolation and float rounding leave them near it.
Floats3 unit_normals(const Floats3& normals) {
  Floats3 out(normals.size());
  for (size_t i = 0; i < out.size(); ++i) {
    const Vec3 n(normals[i][0], normals[i][1], normals[i][2]);
    const Vec3 unit = n.squaredNorm() > 0.0 ? Vec3(n.normalized()) : Vec3::UnitZ();
    for (int k = 0; k < 3; ++k) out[i][k] = static_cast<float>(unit[k]);
  }
  return out;
}

/// sRGB bytes to linear bytes.
std::vector<std::array<uint8_t, 4>> linear_colours(const std::vector<std::array<uint8_t, 4>>& colours) {
  std::vector<std::array<uint8_t, 4>> out(colours.size());
  for (size_t i = 0; i < out.size(); ++i) {
    const Rgb linear = linear_from_srgb8(colours[i]);
    for (size_t k = 0; k < 3; ++k) out[i][k] = static_cast<uint8_t>(std::lround(255.0F * linear[k]));
    out[i][3] = colours[i][3];
  }
  return out;
}

tinygltf::Primitive Writer::triangles(const TriMesh& mesh) {
  constexpr int kVertices = TINYGLTF_TARGET_ARRAY_BUFFER;
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.attributes["POSITION"] = buffer_.floats<3>(mesh.positions, true, kVertices);
  if (!mesh.normals.empty()) {
    primitive.attributes["NORMAL"] = buffer_.floats<3>(unit_normals(mesh.normals), false, kVertices);
  }
  if (!mesh.colours.empty()) primitive.attributes["COLOR_0"] = buffer_.colours(linear_colours(mesh.colours));
  if (!mesh.deviation_um.empty()) {
    const auto* scalars = reinterpret_cast<const std::array<float, 1>*>(mesh.deviation_um.data());
    primitive.attributes["_DEVIATION_UM"] =
        buffer_.floats<1>(std::span(scalars, mesh.deviation_um.size()), false, kVertices);
  }
  const std::span indices(mesh.triangles.front().data(), 3 * mesh.triangles.size());
  primitive.indices = buffer_.indices(indices, mesh.positions.size());
  return primitive;
}

int Writer::material_of(const Material& material, bool vertex_colours) {
  tinygltf::Material out;
  const Rgb base = vertex_colours ? Rgb{1.0F, 1.0F, 1.0F} : material.colour;
  out.pbrMetallicRoughness.baseColorFactor = {base[0], base[1], base[2], 1.0};
  out.pbrMetallicRoughness.metallicFactor = material.metalness;
  out.pbrMetallicRoughness.roughnessFactor = material.roughness;
  out.doubleSided = true;  // an open surface is seen from behind too
  model_.materials.push_back(std::move(out));
  return static_cast<int>(model_.materials.size()) - 1;
}

int Writer::mesh_of(const GltfNode& node) {
  if (node.mesh == nullptr || node.mesh->triangles.empty()) return -1;
  const Material& m = node.material;
  const auto [place, is_new] = meshes_.try_emplace({node.mesh, m.colour, m.metalness, m.roughness}, 0);
  if (is_new) {
    tinygltf::Mesh mesh;
    mesh.name = node.name;
    mesh.primitives.push_back(triangles(*node.mesh));
    mesh.primitives.back().material = material_of(m, !node.mesh->colours.empty());
    place->second = static_cast<int>(model_.meshes.size());
    model_.meshes.push_back(std::move(mesh));
  }
  return place->second;
}

void Writer::add_node(const GltfNode& node) {
  SWARF_CHECK(node.times_s.empty() ? node.poses.size() <= 1 : node.poses.size() == node.times_s.size(),
              "poses and times of node " + node.name);
  const auto index = static_cast<int>(model_.nodes.size());
  SWARF_CHECK(node.parent >= -1 && node.parent + 1 < index,
              "parent of node " + node.name + " must come earlier");
  tinygltf::Node out;
  out.name = node.name;
  out.mesh = mesh_of(node);
  if (!node.poses.empty()) {
    const Vec3 p = node.poses.front().translation();
    const Eigen::Quaterniond q = continuous_rotations(node.poses).front();
    out.translation = {p.x(), p.y(), p.z()};
    out.rotation = {q.x(), q.y(), q.z(), q.w()};
  }
  model_.nodes.push_back(std::move(out));
  model_.nodes[node.parent + 1].children.push_back(index);  // the root stands before the scene's nodes
  if (!node.times_s.empty()) animate(node, index);
}

void Writer::animate(const GltfNode& node, int index) {
  for (size_t i = 1; i < node.times_s.size(); ++i) {
    SWARF_CHECK(static_cast<float>(node.times_s[i - 1]) < static_cast<float>(node.times_s[i]),
                "times of node " + node.name + " must ascend in single precision");
  }
  add_translation(node, index);
  add_rotation(node, index);
  add_visibility(node, index);
}

void Writer::add_visibility(const GltfNode& node, int index) {
  if (std::find(node.shown.begin(), node.shown.end(), 0) == node.shown.end()) return;
  SWARF_CHECK(node.shown.size() == node.times_s.size(), "times and visibility of node " + node.name);
  std::vector<size_t> keys{0};
  for (size_t k = 1; k < node.shown.size(); ++k) {
    if (node.shown[k] != node.shown[k - 1]) keys.push_back(k);
  }
  Floats3 values;
  for (const size_t k : keys) {
    const float scale = node.shown[k] != 0 ? 1.0F : 0.0F;
    values.push_back({scale, scale, scale});
  }
  if (keys.size() == 1) {
    model_.nodes[static_cast<size_t>(index)].scale = {0.0, 0.0, 0.0};
    return;
  }
  add_channel(index, "scale", key_times(node, keys), buffer_.floats<3>(values, false, 0), "STEP");
}

void Writer::add_translation(const GltfNode& node, int index) {
  const auto moves = [&](const Pose& p) {
    return (p.translation() - node.poses.front().translation()).norm() > kStillMm;
  };
  if (std::none_of(node.poses.begin(), node.poses.end(), moves)) return;
  Floats3 values;
  for (const Pose& pose : node.poses) {
    const Eigen::Vector3f p = pose.translation().cast<float>();
    values.push_back({p.x(), p.y(), p.z()});
  }
  add_channel(index, "translation", key_times(node, all_keys(node)), buffer_.floats<3>(values, false, 0));
}

void Writer::add_rotation(const GltfNode& node, int index) {
  const auto rotations = continuous_rotations(node.poses);
  const auto turns = [&](const Eigen::Quaterniond& q) {
    return q.angularDistance(rotations.front()) > kStillRad;
  };
  if (std::none_of(rotations.begin(), rotations.end(), turns)) return;
  std::vector<std::array<float, 4>> values;
  for (const Eigen::Quaterniond& rotation : rotations) {
    const Eigen::Vector4f q = rotation.coeffs().cast<float>();  // x, y, z, w as in glTF
    values.push_back({q[0], q[1], q[2], q[3]});
  }
  add_channel(index, "rotation", key_times(node, all_keys(node)), buffer_.floats<4>(values, false, 0));
}

int Writer::key_times(const GltfNode& node, const std::vector<size_t>& keys) {
  std::vector<std::array<float, 1>> times;
  times.reserve(keys.size());
  for (const size_t k : keys) times.push_back({static_cast<float>(node.times_s[k])});
  return buffer_.floats<1>(times, true, 0);
}

void Writer::add_channel(int node, const std::string& path, int times, int values,
                         const char* interpolation) {
  tinygltf::AnimationSampler sampler;
  sampler.input = times;
  sampler.output = values;
  sampler.interpolation = interpolation;
  tinygltf::AnimationChannel channel;
  channel.sampler = static_cast<int>(animation_.samplers.size());
  channel.target_node = node;
  channel.target_path = path;
  animation_.samplers.push_back(std::move(sampler));
  animation_.channels.push_back(std::move(channel));
}

int Writer::unlit_material(const Rgb& colour) {
  tinygltf::Material material;
  material.pbrMetallicRoughness.baseColorFactor = {colour[0], colour[1], colour[2], 1.0};
  material.extensions["KHR_materials_unlit"] = tinygltf::Value(tinygltf::Value::Object());
  model_.materials.push_back(std::move(material));
  model_.extensionsUsed = {"KHR_materials_unlit"};
  return static_cast<int>(model_.materials.size()) - 1;
}

/// One node for each name and colour: a fan has hundreds of lines, and each primitive costs a viewer a draw
/// call.
void Writer::add_lines() {
  std::map<std::pair<std::string, Rgb>, LineGroup> groups;
  for (const DrawLine& line : scene_.lines) {
    if (line.points.size() < 2) continue;
    auto& [points, segments] = groups[{line.name, line.colour}];
    for (size_t i = 0; i < line.points.size(); ++i) {
      const auto index = static_cast<uint32_t>(points.size());
      if (i > 0) segments.insert(segments.end(), {index - 1, index});
      const Eigen::Vector3f p = line.points[i].cast<float>();
      points.push_back({p.x(), p.y(), p.z()});
    }
  }
  for (const auto& [key, group] : groups) add_line_group(key.first, key.second, group);
}

void Writer::add_line_group(const std::string& name, const Rgb& colour, const LineGroup& group) {
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_LINE;
  primitive.attributes["POSITION"] = buffer_.floats<3>(group.points, true, TINYGLTF_TARGET_ARRAY_BUFFER);
  primitive.indices = buffer_.indices(group.segments, group.points.size());
  primitive.material = unlit_material(colour);
  tinygltf::Mesh mesh;
  mesh.name = name;
  mesh.primitives.push_back(std::move(primitive));
  tinygltf::Node node;
  node.name = name;
  node.mesh = static_cast<int>(model_.meshes.size());
  model_.meshes.push_back(std::move(mesh));
  model_.nodes.front().children.push_back(static_cast<int>(model_.nodes.size()));
  model_.nodes.push_back(std::move(node));
}

tinygltf::Model Writer::build() {
  model_.asset.version = "2.0";
  model_.asset.generator = "Swarf";
  if (!scene_.extras.empty()) {
    tinygltf::Value::Object extras;
    for (const auto& [key, value] : scene_.extras) extras[key] = tinygltf::Value(value);
    model_.asset.extras = tinygltf::Value(extras);
  }
  tinygltf::Node root;
  root.name = "millimetres, Z up";
  const double half_turn = std::sin(-kPi / 4.0);
  root.rotation = {half_turn, 0.0, 0.0, std::cos(-kPi / 4.0)};  // -90 degrees about X: Z becomes Y
  root.scale = {kMetresPerMm, kMetresPerMm, kMetresPerMm};
  model_.nodes.push_back(std::move(root));
  for (const GltfNode& node : scene_.nodes) add_node(node);
  add_lines();
  if (!animation_.channels.empty()) model_.animations.push_back(std::move(animation_));
  if (model_.buffers[0].data.empty()) model_.buffers.clear();  // a buffer of no bytes is not allowed
  tinygltf::Scene scene;
  scene.nodes = {0};
  model_.scenes.push_back(std::move(scene));
  model_.defaultScene = 0;
  return std::move(model_);
}

}  // namespace

void write_glb(const std::filesystem::path& path, const GltfScene& scene) {
  tinygltf::Model model = Writer(scene).build();
  // Through memory: writing to a file, tinygltf does not say when a full disk has taken its end.
  std::ostringstream bytes;
  const bool written = tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, bytes, false, true);
  SWARF_CHECK(written, "tinygltf refuses a scene that we made");
  replace_file(path.string(), bytes.str(), {"cannot-write-file", "the glTF file cannot be written"});
}

}  // namespace swarf::render
