// The glTF writer: what comes back from the file, and the Khronos validator's word.
#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>
#include <tuple>

#include "base/diagnostics.h"
#include "base/rng.h"
#include "base/units.h"
#include "render/figures/colour.h"
#include "render/figures/figure_mesh.h"
#include "render/figures/tool_mesh.h"
#include "render/gltf/gltf_writer.h"
#include "support/full_disk.h"
#include "support/scratch.h"

namespace swarf::render {
namespace {

std::filesystem::path scratch(const std::string& name) {
  const auto folder = test::scratch_folder() / "swarf_gltf_test";
  std::filesystem::create_directories(folder);
  return folder / name;
}

tinygltf::Model read(const std::filesystem::path& path) {
  tinygltf::TinyGLTF gltf;
  tinygltf::Model model;
  std::string error, warning;
  EXPECT_TRUE(gltf.LoadBinaryFromFile(&model, &error, &warning, path.string())) << error;
  EXPECT_EQ(warning, "");
  return model;
}

const float* floats(const tinygltf::Model& model, int accessor) {
  const tinygltf::BufferView& view = model.bufferViews[model.accessors[accessor].bufferView];
  return reinterpret_cast<const float*>(model.buffers[0].data.data() + view.byteOffset);
}

/// A table that slides and turns, a part on it with deviations, a holder, and three lines of two names.
struct Sample {
  TriMesh table = cylinder_mesh(60, 10, 1), part = cylinder_mesh(30, 20, 1), holder = holder_mesh(40, 50);
  GltfScene scene;

  Sample() {
    for (size_t i = 0; i < part.positions.size(); ++i)
      part.deviation_um.push_back(static_cast<float>(i % 21) - 10);
    colour_by_deviation(part, 10);
    GltfNode moving{"table", &table, {}, -1, {}, {}};
    for (int i = 0; i <= 2000; ++i) {
      const double t = 1e-3 * i;
      moving.times_s.push_back(t);
      Pose pose = Pose::Identity();
      pose.translation() = Vec3(50 * std::sin(3 * t), 20 * t, 0);
      pose.linear() = Eigen::AngleAxisd(8 * t, Vec3::UnitZ()).toRotationMatrix();  // past two half turns
      moving.poses.push_back(pose);
    }
    scene.nodes.push_back(moving);
    Pose up = Pose::Identity();
    up.translation() = Vec3(0, 0, 10);
    scene.nodes.push_back({"part", &part, {}, 0, {}, {up}});
    scene.nodes.push_back({"holder", &holder, {{0.3F, 0.3F, 0.3F}, 1.0F, 0.4F}, -1, {}, {}});
    scene.lines = {{{{0, 0, 0}, {10, 0, 0}, {10, 10, 5}}},
                   {{{0, 0, 1}, {5, 5, 5}}},
                   {{{0, 0, 0}, {0, 0, 9}}, {0, 0, 1}, 1.5F, "axes"}};
    scene.extras = {{"program", "dome.nc"}};
  }
};

TEST(GltfWriter, KhronosValidatorFindsNoErrors) {
  const Sample sample;
  const auto machine = scratch("machine.glb"), still = scratch("part.glb"), lines = scratch("lines.glb");
  write_glb(machine, sample.scene);
  GltfScene part;
  part.nodes.push_back({"part", &sample.part, {}, -1, {}, {}});
  write_glb(still, part);
  GltfScene only_lines;
  only_lines.lines = sample.scene.lines;
  write_glb(lines, only_lines);
  const std::string command = std::string(SWARF_SOURCE_DIR) + "/tests/gltf/validate.sh '" + machine.string() +
                              "' '" + still.string() + "' '" + lines.string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
}

TEST(GltfWriter, ValidatorScriptRejectsADamagedFile) {
  const Sample sample;
  const auto path = scratch("damaged.glb");
  write_glb(path, sample.scene);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  const std::string command =
      std::string(SWARF_SOURCE_DIR) + "/tests/gltf/validate.sh '" + path.string() + "' >/dev/null 2>&1";
  EXPECT_NE(std::system(command.c_str()), 0);
}

TEST(GltfWriter, TreeUnitsAndMetadataComeBack) {
  const Sample sample;
  const auto path = scratch("tree.glb");
  write_glb(path, sample.scene);
  const tinygltf::Model model = read(path);
  ASSERT_EQ(model.nodes.size(), 6U);
  const tinygltf::Node& root = model.nodes[0];
  EXPECT_EQ(root.scale, std::vector<double>(3, 1e-3));
  const Eigen::Quaterniond q(root.rotation[3], root.rotation[0], root.rotation[1], root.rotation[2]);
  EXPECT_LT((q * Vec3::UnitZ() - Vec3::UnitY()).norm(), 1e-12) << "Z up becomes Y up";
  EXPECT_EQ(root.children, (std::vector<int>{1, 3, 4, 5}));
  EXPECT_EQ(model.nodes[1].children, std::vector<int>{2});
  EXPECT_EQ(model.nodes[2].name, "part");
  EXPECT_EQ(model.nodes[2].translation, (std::vector<double>{0, 0, 10}));
  EXPECT_EQ(model.asset.extras.Get("program").Get<std::string>(), "dome.nc");
  {
    const test::FullDisk disk(std::filesystem::file_size(path) / 2);
    EXPECT_THROW(write_glb(path, sample.scene), InputError);
  }
  EXPECT_EQ(read(path).nodes.size(), 6U) << "the old file stays";
}

TEST(GltfWriter, VertexDataComesBack) {
  const Sample sample;
  const auto path = scratch("vertices.glb");
  write_glb(path, sample.scene);
  const tinygltf::Model model = read(path);
  const tinygltf::Primitive& part = model.meshes[model.nodes[2].mesh].primitives[0];
  const float* deviation = floats(model, part.attributes.at("_DEVIATION_UM"));
  const float* position = floats(model, part.attributes.at("POSITION"));
  for (size_t v = 0; v < sample.part.positions.size(); ++v) {
    ASSERT_EQ(deviation[v], sample.part.deviation_um[v]);
    ASSERT_EQ(position[3 * v + 2], sample.part.positions[v][2]);
  }
  const tinygltf::Accessor& colour = model.accessors[part.attributes.at("COLOR_0")];
  EXPECT_TRUE(colour.normalized);
  EXPECT_EQ(colour.componentType, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE);
  EXPECT_EQ(model.accessors[part.indices].componentType, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
  EXPECT_EQ(model.accessors[part.attributes.at("POSITION")].maxValues[2], 20.0);
  for (const auto& [node, name, segments] : {std::tuple{4, "axes", 1}, {5, "lines", 3}}) {
    const tinygltf::Mesh& lines = model.meshes[model.nodes[node].mesh];
    EXPECT_EQ(model.nodes[node].name, name) << "lines are told apart by what they show";
    ASSERT_EQ(lines.primitives.size(), 1U) << name;
    EXPECT_EQ(model.accessors[lines.primitives[0].indices].count, 2U * segments) << name;
  }
}

TEST(GltfWriter, AnimationHasTheKeysAndTurnsTheShortWay) {
  const Sample sample;
  const auto path = scratch("animation.glb");
  write_glb(path, sample.scene);
  const tinygltf::Model model = read(path);
  ASSERT_EQ(model.animations.size(), 1U);
  ASSERT_EQ(model.animations[0].channels.size(), 2U);
  for (const tinygltf::AnimationSampler& sampler : model.animations[0].samplers) {
    EXPECT_EQ(model.accessors[sampler.input].count, 2001U);
    EXPECT_EQ(model.accessors[sampler.input].minValues[0], 0.0);
    EXPECT_EQ(model.accessors[sampler.input].maxValues[0], 2.0);
    const tinygltf::Accessor& values = model.accessors[sampler.output];
    if (values.type != TINYGLTF_TYPE_VEC4) continue;
    const float* q = floats(model, sampler.output);
    for (size_t i = 1; i < values.count; ++i) {
      double dot = 0;
      for (size_t k = 0; k < 4; ++k) dot += q[4 * i + k] * q[4 * i - 4 + k];
      ASSERT_GT(dot, 0.0) << "key " << i;
    }
  }
}

TEST(GltfWriter, StandingNodesAreNotAnimated) {
  Sample sample;
  for (Pose& pose : sample.scene.nodes[0].poses) pose = Pose::Identity();
  const auto path = scratch("standing.glb");
  write_glb(path, sample.scene);
  EXPECT_TRUE(read(path).animations.empty());
}

TEST(GltfWriter, PathThatCannotBeWrittenIsAnInputErrorAndLeavesNothing) {
  const auto path = scratch("no_such_folder") / "x.glb";
  try {
    write_glb(path, Sample().scene);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics.list()[0].code, "cannot-write-file");
  }
  EXPECT_FALSE(std::filesystem::exists(path.parent_path()));
}

}  // namespace
}  // namespace swarf::render
