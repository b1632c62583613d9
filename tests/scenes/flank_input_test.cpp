// What is wrong with a [flank] scene is told before anything moves, by the shipped program.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "support/program_run.h"

namespace flank_input_test {
namespace {

namespace fs = std::filesystem;
using swarf::test::run_swarf;

struct BadFlank {
  const char* name;
  const char* set;  ///< over the keys of the scene, several parted by ';'
  const char* code;
  const char* told;
  const char* scene = "chu_f1";
};

/// "--set 'a=1' --set 'b=2'".
std::string overrides(const std::string& set) {
  std::string words;
  for (size_t from = 0; from <= set.size();) {
    const size_t end = std::min(set.find(';', from), set.size());
    words += " --set '" + set.substr(from, end - from) + "'";
    from = end + 1;
  }
  return words;
}

void PrintTo(const BadFlank& bad, std::ostream* out) {
  *out << bad.name;
}

class FlankInput : public testing::TestWithParam<BadFlank> {};

TEST_P(FlankInput, IsRefusedBeforeAnythingMoves) {
  const BadFlank& bad = GetParam();
  const fs::path folder = swarf::test::fresh_folder(std::string("flank_") + bad.name);
  const auto run =
      run_swarf(std::string("run " SWARF_SOURCE_DIR "/scenes/") + bad.scene +
                "/scene.toml --no-render -q -o " + (folder / "out").string() + overrides(bad.set));
  EXPECT_EQ(run.exit_code, 2) << run.output;
  EXPECT_NE(run.output.find(std::string("[") + bad.code + "]"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find(bad.told), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("fix: "), std::string::npos) << run.output;
  EXPECT_FALSE(fs::exists(folder / "out"));
  fs::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, FlankInput,
    testing::Values(
        BadFlank{"limit_below_the_placement", "flank.placement=published", "limit-unreachable",
                 "the published placement alone errs by -103.373 um"},
        BadFlank{"limit_below_the_best", "flank.limit_um=0.5", "limit-unreachable", "errs by 0.718 um"},
        BadFlank{"short_flutes", "cutter.flute_length_mm=30", "cutter-too-short", "flutes"},
        BadFlank{"ball_at_the_guide", "cutter.shape=ball", "flank-above-guide",
                 "the flank begins 8.000 mm above the tip"},
        BadFlank{"no_design",
                 "design={kind=\"sphere\",centre_mm=[0,0,0],radius_mm=10,side=\"convex\",polar_deg=[40,90]}",
                 "flank-needs-ruled", "the design is none"},
        BadFlank{"opposed", "design.guide1_mm=[[60,0,30],[-120,10,0]]", "guides-opposed",
                 "the surface turns over along its ruling"},
        BadFlank{"standing_guide", "design.guide0_mm=[[0,0,0]]", "out-of-range", "without a normal"},
        BadFlank{"hollow", "design.guide0_mm=[[0,-60,0],[60,240,0],[0,-240,0]]", "cutter-too-large",
                 "radius below"},
        BadFlank{"two_programs", "cl=path.cl", "two-programs", "[flank]"},
        BadFlank{"placement", "flank.placement=best", "unknown-choice", "published, balanced, minimax"},
        BadFlank{"feed", "flank.feed_mm_min=0", "out-of-range", "'flank.feed_mm_min' is 0"},
        BadFlank{"blocks_without_end", "flank.chord_um=0.0000000001", "too-many-blocks", "flank.chord_um"},
        BadFlank{"curve_without_end", "flank.chord_um=0.0000001", "too-many-blocks", "more than 4096 pieces",
                 "chu_jcde"},
        BadFlank{"path", "flank.path=spiral", "unknown-choice", "blocks, curve"},
        BadFlank{"limit_with_the_blocks", "flank.limit_um=0.73", "limit-unreachable",
                 "blocks may stray by 0.02 um"},
        BadFlank{"no_tool_fits", "flank.tool=best;cutter.flute_length_mm=30", "no-tool-fits",
                 "T1: the flank reaches 30.000 mm"},
        BadFlank{"several_tools", "flank.tool=only", "planner-needs-one-tool", "has 4", "chu_corner"},
        BadFlank{"no_obstacle", "flank.clearance_mm=0.5", "no-obstacle", "the scene has none"},
        BadFlank{"too_near", "flank.clearance_mm=6", "flank-too-near", "flutes", "chu_channel"},
        BadFlank{"sphere_face", "design={kind=\"ruled_faces\",step=\"faces.stp\",face=[{number=4}]}",
                 "face-not-ruled", "face 4 is not ruled", "chu_step"},
        BadFlank{"no_such_face", "design={kind=\"ruled_faces\",step=\"faces.stp\",face=[{number=99}]}",
                 "cad-no-face", "has no face 99", "chu_step"},
        BadFlank{"round_plane", "design={kind=\"ruled_faces\",step=\"faces.stp\",face=[{number=2}]}",
                 "face-trimmed", "face 2 is ruled", "chu_step"},
        BadFlank{"feed_of_a_program", "flank.feed_mm_min=100", "unknown-key", "feed_mm_min", "chu_g065"},
        BadFlank{"program_of_the_end", "program=../lin_koren_dome/dome.nc", "flank-needs-g065",
                 "mills with the end of the tool", "chu_g065"},
        BadFlank{"program_not_ruled", "program=../../tests/data/programs/bad/flank_pass.nc",
                 "flank-needs-ruled", "has degree 2 in v", "chu_g065"},
        BadFlank{"tool_of_a_program", "cutter.number=4", "unknown-tool", "T1", "chu_g065"}),
    [](const testing::TestParamInfo<BadFlank>& one) { return std::string(one.param.name); });

TEST(FlankLimit, WhatStaysAtTheEndsFailsTheLimit) {
  const fs::path folder = swarf::test::fresh_folder("flank_limit");
  const auto run =
      run_swarf("run " SWARF_SOURCE_DIR "/scenes/chu_f1/scene.toml --no-render -q -o " +
                (folder / "out").string() + " --set flank.overrun_mm=0.01 --set design.pitch_mm=2");
  EXPECT_EQ(run.exit_code, 1) << run.output;
  EXPECT_NE(run.output.find("[flank-limit]"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("the flank leaves 23.6"), std::string::npos) << run.output;
  fs::remove_all(folder);
}

}  // namespace
}  // namespace flank_input_test
