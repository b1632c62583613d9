// Quantised and compressed glTF: what comes back, and by how much it is off.
#include <gtest/gtest.h>
#include <meshoptimizer.h>
#include <tiny_gltf.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "base/rng.h"
#include "render/figures/colour.h"
#include "render/figures/figure_mesh.h"
#include "render/gltf/gltf_writer.h"
#include "render/gltf/quantise.h"
#include "support/scratch.h"

namespace swarf::render::encoding_test {
namespace {

using Json = nlohmann::json;

Box box(const Vec3& lower, const Vec3& upper) {
  return {lower, upper};
}

TEST(Quantise, NoPositionMovesFartherThanStated) {
  Rng rng(7);
  for (const double extent : {1e-3, 0.5, 60.0, 2500.0, 65534.0}) {
    const Vec3 lower(-0.3 * extent - 17.0, 1e4, -extent);
    const PositionGrid grid(box(lower, lower + Vec3(extent, 0.5 * extent, 0.1 * extent)));
    EXPECT_LE(grid.step_mm(), 2.0 * extent / 65534.0) << "a power of two, no more than twice what is needed";
    double farthest = 0.0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3 p = lower + Vec3(rng.uniform(), 0.5 * rng.uniform(), 0.1 * rng.uniform()) * extent;
      const Eigen::Vector3f f = p.cast<float>();
      const auto steps = grid.at({f.x(), f.y(), f.z()});
      const Vec3 back = grid.origin() + grid.step_mm() * Vec3(steps[0], steps[1], steps[2]);
      farthest = std::max(farthest, (back - f.cast<double>()).norm());
    }
    EXPECT_LE(farthest, grid.error_mm() + 1e-3) << extent;  // floats at 1e4 mm
    if (extent < 1.0) continue;
    EXPECT_LE(farthest, grid.error_mm() * 1.01) << extent;
    EXPECT_GT(farthest, 0.5 * grid.error_mm()) << "the bound is no guess";
  }
}

TEST(Quantise, PointsAndFlatBoxesHaveAGrid) {
  const PositionGrid point(box({3, 3, 3}, {3, 3, 3}));
  const auto at = point.at({3, 3, 3});
  EXPECT_NEAR((point.origin() + point.step_mm() * Vec3(at[0], at[1], at[2]) - Vec3(3, 3, 3)).norm(), 0.0,
              1e-6);
}

TEST(Quantise, ScalarsKeepWithinTheirLimitOrStayFloats) {
  const std::vector<float> small{-0.006F, 10.005F, 0.0F}, large{-2000.0F, 2047.0F}, huge{-3000.0F, 5.0F};
  for (const auto& values : {small, large}) {
    const std::optional<double> step = scalar_step(values);
    ASSERT_TRUE(step);
    EXPECT_LE(0.5 * *step, kScalarErrorUm);
    for (const float value : values) EXPECT_LE(std::abs(std::lround(value / *step)), 32767);
  }
  EXPECT_FALSE(scalar_step(huge)) << "half a step would be .0625 um";
  EXPECT_TRUE(scalar_step(std::vector<float>{0.0F, 0.0F}));
}

struct Glb {
  Json json;
  std::string binary;
};

Glb parse(const std::string& bytes) {
  uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, 4);
  const size_t data = 28 + size_t{length};  // of a scene without any there is none
  return {Json::parse(bytes.substr(20, length)), data < bytes.size() ? bytes.substr(data) : ""};
}

/// Three meshes of one grid, a moving node, lines, and a path.
struct Sample {
  TriMesh part = cylinder_mesh(30, 20, 1), table = cylinder_mesh(60, 10, 1);
  GltfScene scene;
  Sample() {
    Rng rng(3);
    for (size_t i = 0; i < part.positions.size(); ++i)
      part.deviation_um.push_back(static_cast<float>(20.0 * rng.uniform() - 10.0));
    colour_by_deviation(part, 10);
    GltfNode moving{"table", &table,          {},
                    -1,      {0.0, 0.5, 1.0}, {Pose::Identity(), Pose::Identity(), Pose::Identity()}};
    moving.poses[1].translation() = Vec3(5, 0, 0);
    moving.shown = {1, 0, 1};
    moving.extras = {{"role", "machine"}};
    scene.nodes = {moving, {"part", &part, {}, 0, {}, {}}};
    scene.lines = {{{{0, 0, 0}, {10, 0, 0}, {10, 10, 5}}}};
    scene.paths = {{"path",
                    {{0, 0, 0}, {1, 0, 0}, {1, 2, 0}},
                    {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}},
                    {{"_TIME_S", {0.0F, 1.0F, 2.5F}}, {"_LINE", {1.0F, 16777215.0F, 3.0F}}}}};
    scene.cameras = {{"camera", {}}};
    scene.extras = {{"scene", "sample"}, {"number", 1.5}};
  }
};

TEST(GltfEncoding, KhronosValidatorFindsNothingWrong) {
  const Sample sample;
  std::string files;
  for (const auto& [encoding, name] : {std::pair{GltfEncoding::kFloat, "float.glb"},
                                       {GltfEncoding::kQuantised, "quantised.glb"},
                                       {GltfEncoding::kMeshopt, "meshopt.glb"}}) {
    const auto path = test::scratch_folder() / name;
    write_glb(path, sample.scene, encoding);
    files += " '" + path.string() + "'";
  }
  const std::string command = std::string(SWARF_SOURCE_DIR) + "/tests/gltf/validate.sh" + files;
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
}

TEST(GltfEncoding, QuantisedNumbersAreWithinWhatTheFileStates) {
  const Sample sample;
  const Glb glb = parse(glb_bytes(sample.scene, GltfEncoding::kQuantised));
  const double error_mm = glb.json.at("asset").at("extras").at("position_error_um").get<double>() / 1000.0;
  EXPECT_GT(error_mm, 0.0);
  EXPECT_LT(error_mm, 0.002) << "60 mm in 16 bits";
  const Json& primitive = glb.json.at("meshes").at(1).at("primitives").at(0);
  const auto& accessors = glb.json.at("accessors");
  const auto& views = glb.json.at("bufferViews");
  const auto offset = [&](const char* name) {
    const Json& accessor = accessors.at(primitive.at("attributes").at(name).get<size_t>());
    return views.at(accessor.at("bufferView").get<size_t>()).value("byteOffset", size_t{0});
  };
  const double unit = primitive.at("extras").at("deviation_um_per_unit");
  // Vertices have another order: each must be one of the sample's, with its own deviation.
  const Json& child = *std::find_if(glb.json.at("nodes").begin(), glb.json.at("nodes").end(),
                                    [](const Json& node) { return node.value("mesh", -1) == 1; });
  const double step = child.at("scale").at(0);
  size_t matched = 0;
  const size_t count = accessors.at(primitive.at("attributes").at("POSITION").get<size_t>()).at("count");
  ASSERT_EQ(count, sample.part.positions.size());
  for (size_t v = 0; v < count; ++v) {
    uint16_t steps[3];
    int16_t deviation = 0;
    std::memcpy(steps, glb.binary.data() + offset("POSITION") + 8 * v, sizeof steps);
    std::memcpy(&deviation, glb.binary.data() + offset("_DEVIATION") + 4 * v, sizeof deviation);
    Vec3 at;
    for (int k = 0; k < 3; ++k)
      at[k] = child.at("translation").at(static_cast<size_t>(k)).get<double>() + step * steps[k];
    for (size_t i = 0; i < count; ++i) {
      const auto& p = sample.part.positions[i];
      if ((at - Vec3(p[0], p[1], p[2])).norm() > error_mm) continue;
      if (std::abs(unit * deviation - sample.part.deviation_um[i]) > kScalarErrorUm) continue;
      ++matched;
      break;
    }
  }
  EXPECT_EQ(matched, count);
}

/// The encoded views decoded again by meshoptimizer.
std::string decoded(const Glb& glb, const Json& view) {
  const Json& told = view.at("extensions").at("EXT_meshopt_compression");
  const size_t count = told.at("count"), stride = told.at("byteStride"), length = told.at("byteLength");
  const auto* from =
      reinterpret_cast<const unsigned char*>(glb.binary.data()) + told.at("byteOffset").get<size_t>();
  std::string out(count * stride, '\0');
  const std::string mode = told.at("mode");
  const int failed =
      mode == "ATTRIBUTES"  ? meshopt_decodeVertexBuffer(out.data(), count, stride, from, length)
      : mode == "TRIANGLES" ? meshopt_decodeIndexBuffer(out.data(), count, stride, from, length)
                            : meshopt_decodeIndexSequence(out.data(), count, stride, from, length);
  EXPECT_EQ(failed, 0) << mode;
  if (told.contains("filter")) meshopt_decodeFilterOct(out.data(), count, stride);
  return out;
}

/// Corners of the triangles, each turned to its least index: what may differ is where a triangle begins.
std::set<std::array<uint32_t, 3>> triangles_of(const std::string& bytes, size_t count) {
  std::set<std::array<uint32_t, 3>> out;
  const size_t size = bytes.size() / count;
  for (size_t i = 0; i + 2 < count; i += 3) {
    std::array<uint32_t, 3> corners{};
    for (size_t k = 0; k < 3; ++k) std::memcpy(&corners[k], bytes.data() + (i + k) * size, size);
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    out.insert(corners);
  }
  return out;
}

TEST(GltfEncoding, CompressedViewsComeBack) {
  const Sample sample;
  const std::string plain = glb_bytes(sample.scene, GltfEncoding::kQuantised);
  const Glb quantised = parse(plain), packed = parse(glb_bytes(sample.scene, GltfEncoding::kMeshopt));
  EXPECT_LT(packed.binary.size(), quantised.binary.size() / 2);
  const Json& required = packed.json.at("extensionsRequired");
  EXPECT_NE(std::find(required.begin(), required.end(), "EXT_meshopt_compression"), required.end());
  size_t filtered = 0, triangles = 0;
  for (size_t i = 0; i < packed.json.at("bufferViews").size(); ++i) {
    const Json& view = packed.json.at("bufferViews").at(i);
    const Json& old = quantised.json.at("bufferViews").at(i);
    const std::string raw = quantised.binary.substr(old.value("byteOffset", size_t{0}), old.at("byteLength"));
    const std::string back = decoded(packed, view);
    const Json& told = view.at("extensions").at("EXT_meshopt_compression");
    ASSERT_EQ(back.size(), raw.size());
    if (told.at("mode") == "TRIANGLES") {
      ++triangles;
      EXPECT_EQ(triangles_of(back, told.at("count")), triangles_of(raw, told.at("count")));
    } else if (told.contains("filter")) {
      ++filtered;
      for (size_t v = 0; v < raw.size() / 8; ++v) {
        int16_t a[3], b[3];
        std::memcpy(a, raw.data() + 8 * v, sizeof a);
        std::memcpy(b, back.data() + 8 * v, sizeof b);
        const double dot = Vec3(a[0], a[1], a[2]).normalized().dot(Vec3(b[0], b[1], b[2]).normalized());
        ASSERT_LT(std::acos(std::min(1.0, dot)), 0.07 * 3.141592653589793 / 180.0);
      }
    } else {
      EXPECT_EQ(back, raw) << "to the bit: view " << i;
    }
  }
  EXPECT_EQ(filtered, 2U);
  EXPECT_EQ(triangles, 2U);
}

TEST(GltfEncoding, EmptySceneIsAFile) {
  const Glb glb = parse(glb_bytes({}, GltfEncoding::kMeshopt));
  EXPECT_EQ(glb.json.at("nodes").size(), 1U);
}

}  // namespace
}  // namespace swarf::render::encoding_test
