// What the page and the glTF files of a run say of the part is what metrics.json says, and a finding leads to
// its place.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "render/image_io.h"
#include "support/program_run.h"

namespace page_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using swarf::test::read_text;
using swarf::test::run_command;
using swarf::test::run_swarf;

constexpr double kReadLimitUm = 0.1;
constexpr int kNoChromium = 77;

struct Glb {
  json model;
  std::string binary;
};

Glb read_glb(const fs::path& path) {
  const std::string bytes = read_text(path);
  uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, sizeof length);
  return {json::parse(bytes.substr(20, length)), bytes.substr(28 + length)};
}

/// Least and greatest of an attribute of floats over all meshes.
std::pair<float, float> range_of(const Glb& glb, const char* attribute) {
  std::pair range{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};
  for (const json& mesh : glb.model.at("meshes")) {
    const json& attributes = mesh.at("primitives").at(0).at("attributes");
    if (!attributes.contains(attribute)) continue;
    const json& accessor = glb.model.at("accessors").at(attributes.at(attribute).get<size_t>());
    const json& view = glb.model.at("bufferViews").at(accessor.at("bufferView").get<size_t>());
    for (size_t i = 0; i < accessor.at("count").get<size_t>(); ++i) {
      float value = 0.0F;
      std::memcpy(&value, glb.binary.data() + view.value("byteOffset", size_t{0}) + 4 * i, sizeof value);
      range = {std::min(range.first, value), std::max(range.second, value)};
    }
  }
  return range;
}

/// Planted gouges of 20, 5 and 1 um below a plane with scallops.
class GougedPage : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = swarf::test::fresh_folder("gouged_page");
    const auto run = run_swarf("run " SWARF_SOURCE_DIR
                               "/scenes/exact_gouges/scene.toml --set movie.seconds=1 "
                               "--set \"stills.kinds=[]\" -o " +
                               run_folder());
    ASSERT_EQ(run.exit_code, 1) << run.output;
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }
  static std::string run_folder() { return (folder_ / "run").string(); }
  inline static fs::path folder_;
};

TEST_F(GougedPage, DeviationInTheGltfIsThatOfTheMetrics) {
  const json surface = json::parse(read_text(folder_ / "run/metrics.json")).at("surface");
  const auto [low, high] = range_of(read_glb(folder_ / "run/part.glb"), "_DEVIATION_UM");
  EXPECT_NEAR(low, -surface.at("gouge_max_um").get<double>(), kReadLimitUm);
  EXPECT_NEAR(high, surface.at("excess_max_um").get<double>(), kReadLimitUm);
}

/// What is exported later says the same, with the pins of the findings.
TEST_F(GougedPage, AnExportedPartSaysTheSame) {
  const fs::path part = folder_ / "exported.glb";
  const auto run = run_swarf("export " + run_folder() + " --gltf " + part.string());
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const json surface = json::parse(read_text(folder_ / "run/metrics.json")).at("surface");
  const Glb glb = read_glb(part);
  EXPECT_NEAR(range_of(glb, "_DEVIATION_UM").first, -surface.at("gouge_max_um").get<double>(), kReadLimitUm);
  size_t pins = 0;
  for (const json& node : glb.model.at("nodes"))
    if (node.contains("extras") && node.at("extras").value("role", "") == "finding") ++pins;
  EXPECT_EQ(pins, 3U);
}

TEST_F(GougedPage, FindingsStandInTheGltfWithTheirNumbers) {
  const json findings = json::parse(read_text(folder_ / "run/findings.json"));
  const Glb glb = read_glb(folder_ / "run/part.glb");
  ASSERT_EQ(findings.size(), 3U);
  for (const json& finding : findings) {
    const json* pin = nullptr;
    for (const json& node : glb.model.at("nodes"))
      if (node.contains("extras") &&
          node.at("extras").value("finding", 0.0) == finding.at("number").get<double>())
        pin = &node;
    ASSERT_NE(pin, nullptr) << finding.dump();
    const json& extras = pin->at("extras");
    EXPECT_EQ(extras.at("line"), finding.at("line"));
    EXPECT_EQ(extras.at("text"), finding.at("text"));
    for (size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(pin->at("translation").at(k).get<double>(), finding.at("place_mm").at(k).get<double>(),
                  1e-9);
      EXPECT_EQ(extras.at(std::array{"x_mm", "y_mm", "z_mm"}.at(k)), finding.at("place_mm").at(k));
    }
    EXPECT_GT(extras.at("amount_mm").get<double>(), 0.0009);
  }
}

TEST_F(GougedPage, EveryEncodingIsRightForTheValidator) {
  std::string files = (folder_ / "run/part.glb").string() + " " + (folder_ / "run/machine.glb").string();
  size_t before = fs::file_size(folder_ / "run/part.glb") + 1;
  for (const std::string encoding : {"float", "quantized", "meshopt"}) {
    const fs::path part = folder_ / ("part_" + encoding + ".glb"),
                   machine = folder_ / ("machine_" + encoding + ".glb");
    const auto run = run_swarf("export " + run_folder() + " --gltf " + part.string() + " --machine-gltf " +
                               machine.string() + " --encoding " + encoding);
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_LT(fs::file_size(part), before) << encoding << " is smaller than the one before";
    before = fs::file_size(part);
    files += " " + part.string() + " " + machine.string();
  }
  const auto valid = run_command(SWARF_SOURCE_DIR "/tests/gltf/validate.sh " + files);
  EXPECT_EQ(valid.exit_code, 0) << valid.output;
  const auto unknown = run_swarf("export " + run_folder() + " --gltf x.glb --encoding draco");
  EXPECT_EQ(unknown.exit_code, 2) << unknown.output;
}

TEST_F(GougedPage, StockIsCutInStagesAndAxesAreAChain) {
  const Glb glb = read_glb(folder_ / "run/machine.glb");
  size_t stages = 0, axes = 0;
  for (const json& node : glb.model.at("nodes")) {
    if (node.at("name").get<std::string>().starts_with("stock ")) ++stages;
    if (node.contains("extras") && node.at("extras").value("role", "") == "axis") {
      ++axes;
      EXPECT_TRUE(node.contains("children")) << "what it moves hangs on it";
    }
  }
  EXPECT_EQ(stages, 9U);
  EXPECT_GE(axes, 3U);
  EXPECT_EQ(glb.model.at("animations").at(0).at("name"), "exact_gouges");
  for (const json& material : glb.model.at("materials")) EXPECT_TRUE(material.contains("name"));
}

/// As many triangles as the STL has, all of them in millimetres; the reader's side is held by unit_mesh.
TEST_F(GougedPage, ObjIsThePart) {
  const fs::path obj = folder_ / "part.obj", stl = folder_ / "part.stl";
  const auto run = run_swarf("export " + run_folder() + " --obj " + obj.string() + " --stl " + stl.string());
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const std::string text = read_text(obj), bytes = read_text(stl);
  uint32_t triangles = 0;
  std::memcpy(&triangles, bytes.data() + 80, sizeof triangles);
  size_t faces = 0;
  for (size_t at = text.find("\nf "); at != std::string::npos; at = text.find("\nf ", at + 1)) ++faces;
  EXPECT_EQ(faces, triangles);
  EXPECT_TRUE(text.starts_with("# millimetres\nv "));
}

/// The labels stand on the picture that there is without them.
TEST_F(GougedPage, AStillHasAScaleBarAndLeadersWhereTheyAreAskedFor) {
  const std::string plain = (folder_ / "plain.png").string(), labelled = (folder_ / "labelled.png").string();
  const std::string render =
      "render " + run_folder() + " --kind deviation --size 480 270 --samples 1 --still ";
  ASSERT_EQ(run_swarf(render + plain).exit_code, 0);
  const auto run = run_swarf(render + labelled + " --labels");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const swarf::render::Image before = swarf::render::load_png(plain),
                             after = swarf::render::load_png(labelled);
  size_t changed = 0, corner = 0;
  for (int y = 0; y < 270; ++y)
    for (int x = 0; x < 480; ++x) {
      const size_t at = size_t{4} * (480 * y + x);
      if (std::equal(&before.rgba[at], &before.rgba[at + 4], &after.rgba[at])) continue;
      ++changed;
      if (x < 180 && y > 220) ++corner;
    }
  EXPECT_GT(corner, 300U) << "the scale bar";
  EXPECT_GT(changed - corner, 2000U) << "two plates with their lines";
  EXPECT_LT(changed, 480U * 270U / 5) << "nothing else";
}

/// They are what `render --labels` draws of the same run, and not what it draws without.
TEST_F(GougedPage, TheRunsOwnStillsAreLabelled) {
  const fs::path job = folder_ / "stills";
  const std::string look = "'stills.size=[480,270]' --set stills.samples=1";
  const auto run = run_swarf("run " SWARF_SOURCE_DIR
                             "/scenes/exact_gouges/scene.toml --set movie.seconds=0 --set "
                             "'stills.kinds=[\"part\",\"deviation\"]' --set " +
                             look + " -o " + job.string());
  ASSERT_EQ(run.exit_code, 1) << run.output;
  for (const std::string kind : {"part", "deviation"}) {
    const std::string file = (folder_ / "again.png").string();
    const std::string render = "render " + job.string() + " --kind " + kind + " --still " + file;
    const std::string own = read_text(job / ("still_" + kind + ".png"));
    ASSERT_EQ(run_swarf(render + " --labels").exit_code, 0);
    EXPECT_EQ(own, read_text(file)) << kind;
    ASSERT_EQ(run_swarf(render).exit_code, 0);
    EXPECT_NE(own, read_text(file)) << kind;
  }
}

TEST_F(GougedPage, LeadsFromAFindingToItsPlaceLineAndMovie) {
  const auto page = run_command(SWARF_SOURCE_DIR "/tests/page/page.sh " + run_folder() + "/report.html");
  if (page.exit_code == kNoChromium) GTEST_SKIP() << page.output;
  EXPECT_EQ(page.exit_code, 0) << page.output;
}

}  // namespace
}  // namespace page_test
