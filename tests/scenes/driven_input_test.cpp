// Bad input of [driven] scenes on the shipped program: exit 2 with the key or the place and what to do,
// before anything moves, and no output folder.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "support/program_run.h"

namespace driven_input_test {
namespace {

namespace fs = std::filesystem;
using swarf::test::run_swarf;

/// Overrides of scenes/kato_step, or of one guide over the same part.
struct BadDriven {
  const char* name;
  const char* set;
  const char* code;
  const char* told;  ///< must be printed
  bool guide = false;
};

void PrintTo(const BadDriven& bad, std::ostream* out) {
  *out << bad.name;
}

class DrivenInput : public testing::TestWithParam<BadDriven> {};

TEST_P(DrivenInput, IsRefusedBeforeAnythingMoves) {
  const BadDriven& bad = GetParam();
  const fs::path folder = swarf::test::fresh_folder(std::string("driven_") + bad.name);
  std::string scene = SWARF_SOURCE_DIR "/scenes/kato_step/scene.toml";
  if (bad.guide) {
    std::string text = swarf::test::read_text(scene);
    const std::string scan = "mode = \"scan\"\ninterval_mm = 3\n";
    const auto at = text.find(scan);
    ASSERT_NE(at, std::string::npos);
    text.replace(at, scan.size(), "mode = \"guide\"\nguide_mm = [[-20, 0], [20, 0]]\n");
    fs::copy(SWARF_SOURCE_DIR "/scenes/kato_step/step.nc", folder / "step.nc");
    scene = (folder / "scene.toml").string();
    swarf::test::write_text(scene, text);
  }
  const auto run = run_swarf("run " + scene + " --no-render -q -o " + (folder / "out").string() + " --set '" +
                             bad.set + "'");
  EXPECT_EQ(run.exit_code, 2) << run.output;
  EXPECT_NE(run.output.find(std::string("[") + bad.code + "]"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find(bad.told), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("fix: "), std::string::npos) << run.output;
  EXPECT_FALSE(fs::exists(folder / "out"));
  fs::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, DrivenInput,
    testing::Values(
        BadDriven{"feed", "driven.feed_mm_min=0", "out-of-range", "'driven.feed_mm_min' is 0"},
        BadDriven{"interval", "driven.interval_mm=0", "out-of-range", "'driven.interval_mm' is 0"},
        BadDriven{"period", "interpolator.period_ms=0", "out-of-range", "'interpolator.period_ms' is 0"},
        BadDriven{"tolerance", "driven.chord_tolerance_um=0", "out-of-range",
                  "'driven.chord_tolerance_um' is 0"},
        BadDriven{"two_parts", "driven.mesh=part.stl", "two-parts", "keep one of them"},
        BadDriven{"no_part", "driven.surface=none.nc", "file-not-found", "none.nc"},
        BadDriven{"mode", "driven.mode=spin", "unknown-choice", "scan, contour, spiral, guide"},
        BadDriven{"area_turned", "driven.area_mm=[[5,5],[0,0]]", "out-of-range", "'area_mm' is no rectangle"},
        BadDriven{"area_elsewhere", "driven.area_mm=[[200,200],[210,210]]", "guide-misses-part",
                  "(200.000, 200.000) mm"},
        BadDriven{"comparison", "driven.compare_cam_um=[10,-1]", "out-of-range", "a tolerance of -1 um"},
        BadDriven{"angle", "driven.angle_deg=500", "out-of-range", "from -180 to 180"},
        BadDriven{"axis_without_length", "driven.axis=[0,0,0]", "out-of-range", "'axis' has no length"},
        BadDriven{"lead", "driven.lead_deg=90", "out-of-range", "from -89 to 89"},
        BadDriven{"axis_too_low", "driven.tilt_deg=88", "axis-too-low", "lead_deg or tilt_deg"},
        BadDriven{"key", "driven.angel_deg=5", "unknown-key", "did you mean 'angle_deg'?"},
        BadDriven{"one_point", "driven.guide_mm=[[0,0]]", "area-too-small", "the points of guide_mm", true},
        BadDriven{"no_way", "driven.guide_mm=[[0,0],[0,0]]", "area-too-small", "the points of guide_mm",
                  true},
        BadDriven{"off_the_part", "driven.guide_mm=[[0,0],[100,0]]", "guide-misses-part", "pass 1", true}),
    [](const testing::TestParamInfo<BadDriven>& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace driven_input_test
