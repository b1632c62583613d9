// One CL file on two machines under TCP, on the shipped program: the finished parts agree ray by ray.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "support/json_path.h"
#include "support/program_run.h"

namespace two_machines_test {
namespace {

namespace fs = std::filesystem;
using swarf::test::at_path;
using swarf::test::read_text;
using swarf::test::run_swarf;
using swarf::test::write_text;

const std::string kScenes = SWARF_SOURCE_DIR "/scenes/";
constexpr double kLimit_um = 0.2;

class TwoMachines : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    root_ = swarf::test::fresh_folder("two_machines");
    write_wider();
    ran_ = run(kScenes + "two_machines_ac", "ac") && run(kScenes + "two_machines_bc", "bc") &&
           run((root_ / "wider").string(), "wider_out") &&
           run(kScenes + "two_machines_bc", "coarse", "--set design.pitch_mm=4") &&
           run(kScenes + "nc_pocket", "pocket", "--set stock.voxel_mm=2");
  }
  static void TearDownTestSuite() { fs::remove_all(root_); }

  /// The scene with a cutter whose radius is 1 um larger.
  static void write_wider() {
    fs::create_directories(root_ / "wider");
    std::string scene = read_text(kScenes + "two_machines_bc/scene.toml");
    const auto put = [](std::string& text, const std::string& old, const std::string& now) {
      text.replace(text.find(old), old.size(), now);
    };
    put(scene, "../../assets", SWARF_SOURCE_DIR "/assets");
    put(scene, "../exact_cone_flank/path.cl", "path.cl");
    put(scene, "diameter_mm = 20", "diameter_mm = 20.002");
    write_text(root_ / "wider" / "scene.toml", scene);
    std::string path = read_text(kScenes + "exact_cone_flank/path.cl");
    put(path, "CUTTER/20,0", "CUTTER/20.002,0");
    write_text(root_ / "wider" / "path.cl", path);
  }
  /// Coarser rays than the scene's: the agreement does not hang on their number.
  static bool run(const std::string& folder, const std::string& out,
                  const std::string& options = "--set design.pitch_mm=2") {
    const auto done =
        run_swarf("run " + folder + "/scene.toml --no-render " + options + " -o " + (root_ / out).string());
    if (done.exit_code > 1) ADD_FAILURE() << done.output;
    return done.exit_code <= 1;
  }
  static swarf::test::ProgramRun compare(const std::string& a, const std::string& b,
                                         const std::string& options) {
    return run_swarf("compare " + (root_ / a).string() + " " + (root_ / b).string() + " " + options);
  }

  static fs::path root_;
  static bool ran_;
};
fs::path TwoMachines::root_;
bool TwoMachines::ran_ = false;

TEST_F(TwoMachines, CutTheSamePart) {
  ASSERT_TRUE(ran_);
  const auto same = compare("ac", "bc", "--json");
  ASSERT_EQ(same.exit_code, 0) << same.output;
  const auto found = nlohmann::json::parse(same.output);
  EXPECT_GT(at_path(found, "rays.compared").get<int>(), 1000);
  EXPECT_LE(at_path(found, "rays.difference_max_um").get<double>(), kLimit_um);
}

TEST_F(TwoMachines, AnotherCutterIsSeen) {
  ASSERT_TRUE(ran_);
  const auto other = compare("ac", "wider_out", "--json");
  EXPECT_EQ(other.exit_code, 1) << other.output;
  const auto found = nlohmann::json::parse(other.output);
  EXPECT_NEAR(at_path(found, "rays.difference_max_um").get<double>(), 1.0, 1e-3)
      << "the flank stands 1 um deeper everywhere";
  EXPECT_EQ(at_path(found, "rays.beyond_limit"), at_path(found, "rays.compared"));
  EXPECT_EQ(compare("ac", "wider_out", "--rays-um 1.01").exit_code, 0);
}

TEST_F(TwoMachines, OtherRaysAreRefused) {
  ASSERT_TRUE(ran_);
  const auto coarse = compare("ac", "coarse", "");
  EXPECT_EQ(coarse.exit_code, 2);
  EXPECT_NE(coarse.output.find("other-rays"), std::string::npos) << coarse.output;
  const auto none = compare("ac", "pocket", "");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.output.find("no-rays"), std::string::npos) << none.output;
  fs::create_directories(root_ / "empty");
  EXPECT_NE(compare("ac", "empty", "").output.find("not-a-run"), std::string::npos);
}

}  // namespace

}  // namespace two_machines_test
