#include "render/gltf/gltf_writer.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <sstream>

#include "base/check.h"
#include "base/file.h"
#include "base/units.h"
#include "render/gltf/gltf_buffer.h"
#include "render/gltf/gltf_mesh.h"
#include "render/gltf/meshopt_glb.h"

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
  Writer(const GltfScene& scene, GltfEncoding encoding)
      : scene_(scene), buffer_(model_), meshes_(model_, buffer_, encoding != GltfEncoding::kFloat) {}
  tinygltf::Model build();

 private:
  void add_node(const GltfNode& node);
  /// The mesh at the node; quantised, at a child that turns steps into mm.
  void place(int node, const GltfMeshes::Placed& placed);
  /// A node below the root.
  int add_plain_node(const std::string& name);
  void animate(const GltfNode& node, int index);
  void add_translation(const GltfNode& node, int index);
  void add_rotation(const GltfNode& node, int index);
  void add_visibility(const GltfNode& node, int index);
  void add_channel(int node, const std::string& path, int times, int values,
                   const char* interpolation = "LINEAR");
  int key_times(const GltfNode& node, const std::vector<size_t>& keys);
  void add_lines();
  void add_camera(const GltfCamera& camera);
  void name_extensions(const GltfExtras& extras);

  const GltfScene& scene_;
  tinygltf::Model model_;
  GltfBuffer buffer_;
  GltfMeshes meshes_;
  tinygltf::Animation animation_;
  std::vector<std::pair<int, GltfMeshes::Placed>> quantised_;  ///< node and mesh; children come last
};

void Writer::add_node(const GltfNode& node) {
  SWARF_CHECK(node.times_s.empty() ? node.poses.size() <= 1 : node.poses.size() == node.times_s.size(),
              "poses and times of node " + node.name);
  const auto index = static_cast<int>(model_.nodes.size());
  SWARF_CHECK(node.parent >= -1 && node.parent + 1 < index,
              "parent of node " + node.name + " must come earlier");
  tinygltf::Node out;
  out.name = node.name;
  if (!node.extras.empty()) out.extras = extras_value(node.extras);
  if (!node.poses.empty()) {
    const Vec3 p = node.poses.front().translation();
    const Eigen::Quaterniond q = continuous_rotations(node.poses).front();
    out.translation = {p.x(), p.y(), p.z()};
    out.rotation = {q.x(), q.y(), q.z(), q.w()};
  }
  model_.nodes.push_back(std::move(out));
  model_.nodes[node.parent + 1].children.push_back(index);  // the root stands before the scene's nodes
  place(index, meshes_.of_node(node));
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

void Writer::place(int node, const GltfMeshes::Placed& placed) {
  if (placed.mesh < 0) return;
  if (placed.grid) {
    quantised_.emplace_back(node, placed);
  } else {
    model_.nodes[static_cast<size_t>(node)].mesh = placed.mesh;
  }
}

int Writer::add_plain_node(const std::string& name) {
  tinygltf::Node node;
  node.name = name;
  const auto index = static_cast<int>(model_.nodes.size());
  model_.nodes.front().children.push_back(index);
  model_.nodes.push_back(std::move(node));
  return index;
}

/// One node for each name and colour: a fan has hundreds of lines, and each primitive costs a viewer a draw
/// call.
void Writer::add_lines() {
  std::map<std::pair<std::string, Rgb>, GltfMeshes::LineGroup> groups;
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
  for (const auto& [key, group] : groups)
    place(add_plain_node(key.first), meshes_.of_lines(key.first, key.second, group));
}

/// glTF's cameras look along -Z with Y up; `camera` is given in the scene's frame.
void Writer::add_camera(const GltfCamera& one) {
  tinygltf::Camera camera;
  camera.name = one.name;
  camera.type = "perspective";
  camera.perspective.yfov = one.camera.vertical_fov_rad;
  const double distance = (one.camera.eye - one.camera.target).norm() * kMetresPerMm;
  camera.perspective.znear = 0.01 * distance;
  camera.perspective.zfar = 100.0 * distance;
  const Vec3 z = (one.camera.eye - one.camera.target).normalized();
  const Vec3 x = one.camera.up.cross(z).normalized();
  Eigen::Matrix3d axes;
  axes << x, z.cross(x), z;
  const Eigen::Quaterniond q(axes);
  tinygltf::Node& node = model_.nodes[static_cast<size_t>(add_plain_node(one.name))];
  node.translation = {one.camera.eye.x(), one.camera.eye.y(), one.camera.eye.z()};
  node.rotation = {q.x(), q.y(), q.z(), q.w()};
  // The root's scale must not reach a camera: its planes are in metres.
  node.scale = {1.0 / kMetresPerMm, 1.0 / kMetresPerMm, 1.0 / kMetresPerMm};
  node.camera = static_cast<int>(model_.cameras.size());
  model_.cameras.push_back(std::move(camera));
}

void Writer::name_extensions(const GltfExtras& extras) {
  const bool unlit = std::any_of(model_.materials.begin(), model_.materials.end(), [](const auto& material) {
    return material.extensions.count("KHR_materials_unlit") > 0;
  });
  if (unlit) model_.extensionsUsed.emplace_back("KHR_materials_unlit");
  GltfExtras all = extras;
  if (meshes_.position_error_mm() > 0.0) {
    model_.extensionsUsed.emplace_back("KHR_mesh_quantization");
    model_.extensionsRequired.emplace_back("KHR_mesh_quantization");
    all["position_error_um"] = um_from_mm(meshes_.position_error_mm());
  }
  if (!all.empty()) model_.asset.extras = extras_value(all);
}

tinygltf::Model Writer::build() {
  model_.asset.version = "2.0";
  model_.asset.generator = "Swarf";
  tinygltf::Node root;
  root.name = "millimetres, Z up";
  const double half_turn = std::sin(-kPi / 4.0);
  root.rotation = {half_turn, 0.0, 0.0, std::cos(-kPi / 4.0)};  // -90 degrees about X: Z becomes Y
  root.scale = {kMetresPerMm, kMetresPerMm, kMetresPerMm};
  model_.nodes.push_back(std::move(root));
  for (const GltfNode& node : scene_.nodes) add_node(node);
  add_lines();
  for (const GltfPath& path : scene_.paths)
    if (path.points.size() > 1) place(add_plain_node(path.name), meshes_.of_path(path));
  for (const GltfCamera& camera : scene_.cameras) add_camera(camera);
  for (const auto& [node, placed] : quantised_) {
    tinygltf::Node child;
    const Vec3& origin = placed.grid->origin();
    const double step = placed.grid->step_mm();
    child.translation = {origin.x(), origin.y(), origin.z()};
    child.scale = {step, step, step};
    child.mesh = placed.mesh;
    model_.nodes[static_cast<size_t>(node)].children.push_back(static_cast<int>(model_.nodes.size()));
    model_.nodes.push_back(std::move(child));
  }
  name_extensions(scene_.extras);
  animation_.name = scene_.clip;
  if (!animation_.channels.empty()) model_.animations.push_back(std::move(animation_));
  if (model_.buffers[0].data.empty()) model_.buffers.clear();  // a buffer of no bytes is not allowed
  tinygltf::Scene scene;
  scene.nodes = {0};
  model_.scenes.push_back(std::move(scene));
  model_.defaultScene = 0;
  return std::move(model_);
}

}  // namespace

std::string glb_bytes(const GltfScene& scene, GltfEncoding encoding) {
  tinygltf::Model model = Writer(scene, encoding).build();
  // Through memory: writing to a file, tinygltf does not say when a full disk has taken its end.
  std::ostringstream bytes;
  const bool written = tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, bytes, false, true);
  SWARF_CHECK(written, "tinygltf refuses a scene that we made");
  return encoding == GltfEncoding::kMeshopt ? meshopt_compressed(bytes.str()) : bytes.str();
}

void write_glb(const std::filesystem::path& path, const GltfScene& scene, GltfEncoding encoding) {
  replace_file(path.string(), glb_bytes(scene, encoding),
               {"cannot-write-file", "the glTF file cannot be written"});
}

}  // namespace swarf::render
