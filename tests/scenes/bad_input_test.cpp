// Every bad input of the DOME job on the shipped program: exit 2, the place, the code, the remedy, and no
// output folder.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "support/program_run.h"

namespace bad_input_test {
namespace {

namespace fs = std::filesystem;
using swarf::test::read_text;
using swarf::test::run_swarf;
using swarf::test::write_text;

/// One change to a good job. `find` empty: the whole file becomes `replace`.
struct BadInput {
  const char* name;
  const char* file;  ///< scene.toml, dome.nc or machine/machine.toml
  std::string find, replace;
  const char* code;
  const char* place;  ///< "file:line:" or a prefix of it that must be printed
};

void PrintTo(const BadInput& bad, std::ostream* out) {
  *out << bad.name;
}

/// A copy of the DOME job that stands alone in `folder`.
void copy_job(const fs::path& folder) {
  const fs::path source(SWARF_SOURCE_DIR);
  fs::copy(source / "assets/machines/lin_koren_xyzab", folder / "machine", fs::copy_options::recursive);
  fs::copy(source / "scenes/lin_koren_dome/dome.nc", folder / "dome.nc");
  std::string scene = read_text(source / "scenes/lin_koren_dome/scene.toml");
  const std::string machine = "../../assets/machines/lin_koren_xyzab/machine.toml";
  scene.replace(scene.find(machine), machine.size(), "machine/machine.toml");
  write_text(folder / "scene.toml", scene);
}

class BadInputTest : public testing::TestWithParam<BadInput> {};

TEST_P(BadInputTest, IsRefusedWithItsPlaceAndNothingIsWritten) {
  const BadInput& bad = GetParam();
  const fs::path folder = swarf::test::fresh_folder(std::string("bad_") + bad.name);
  copy_job(folder);
  std::string text = read_text(folder / bad.file);
  if (bad.find.empty()) {
    text = bad.replace;
  } else {
    const auto at = text.find(bad.find);
    ASSERT_NE(at, std::string::npos) << "the good job no longer contains: " << bad.find;
    text.replace(at, bad.find.size(), bad.replace);
  }
  write_text(folder / bad.file, text);
  const auto run =
      run_swarf("run " + (folder / "scene.toml").string() + " --no-render -o " + (folder / "out").string());
  EXPECT_EQ(run.exit_code, 2) << run.output;
  EXPECT_NE(run.output.find(std::string("[") + bad.code + "]"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find(bad.place), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("fix: "), std::string::npos) << run.output;
  EXPECT_FALSE(fs::exists(folder / "out"));
  fs::remove_all(folder);
}

/// The keys of [cutter] that a profile stands for.
const char* const kPlainFlutes = "diameter_mm = 10\ncorner_radius_mm = 0\nflute_length_mm = 45";

std::vector<BadInput> bad_inputs() {
  return {
      {"misspelt_key", "scene.toml", "voxel_mm = 0.2", "voxle_mm = 0.2", "unknown-key", "scene.toml:18:"},
      {"misspelt_table", "scene.toml", "[interpolator]", "[interpolater]", "unknown-key", "scene.toml:28:"},
      {"unknown_planner", "scene.toml", "\"constant_scallop\"", "\"constant_scalop\"", "unknown-choice",
       "scene.toml:24:"},
      {"number_nan", "scene.toml", "voxel_mm = 0.2", "voxel_mm = nan", "out-of-range", "scene.toml:18:"},
      {"number_1e400", "scene.toml", "voxel_mm = 0.2", "voxel_mm = 1e400", "toml-syntax", "scene.toml:18:"},
      {"voxel_too_small", "scene.toml", "voxel_mm = 0.2", "voxel_mm = 0.0005", "out-of-memory", "scene.toml"},
      {"tool_thinner_than_voxel", "scene.toml", "voxel_mm = 0.2", "voxel_mm = 15", "out-of-range",
       "scene.toml:18:"},
      {"box_beyond_everything", "scene.toml", "[50, 40, 37]", "[1e308, 40, 37]", "out-of-range",
       "scene.toml:17:"},
      {"voxel_denormal", "scene.toml", "voxel_mm = 0.2", "voxel_mm = 5e-324", "out-of-memory", "scene.toml"},
      {"movie_voxel_tiny", "scene.toml", "[movie]", "[movie]\nvoxel_mm = 1e-5", "out-of-memory",
       "scene.toml"},
      {"rays_too_dense", "scene.toml", "pitch_mm = 0.2", "pitch_mm = 1e-320", "out-of-memory", "scene.toml"},
      {"box_upside_down", "scene.toml", "[50, 40, 37]", "[50, 40, -37]", "out-of-range", "scene.toml:17:"},
      {"design_misses_stock", "scene.toml", "[[-50, -40, -20], [50, 40, 37]]",
       "[[200, 200, -20], [300, 300, 37]]", "design-outside-stock", "scene.toml:20:"},
      {"program_not_found", "scene.toml", "\"dome.nc\"", "\"doom.nc\"", "file-not-found", "doom.nc"},
      {"machine_not_found", "scene.toml", "machine/machine.toml", "machine/machin.toml", "file-not-found",
       "machin.toml"},
      {"corner_above_radius", "scene.toml", "corner_radius_mm = 0", "corner_radius_mm = 6", "bad-cutter",
       "scene.toml:9:"},
      {"flat_with_corner", "scene.toml", "corner_radius_mm = 0", "corner_radius_mm = 1\nshape = \"flat\"",
       "bad-cutter", "scene.toml:9:"},
      {"unknown_shape", "scene.toml", "corner_radius_mm = 0", "shape = \"bal\"", "unknown-choice",
       "scene.toml:9:"},
      {"key_of_another_shape", "scene.toml", "corner_radius_mm = 0", "taper_deg = 5", "unknown-key",
       "scene.toml:9:"},
      {"planned_with_a_taper", "scene.toml", "corner_radius_mm = 0", "shape = \"taper\"\ntaper_deg = 5",
       "planner-cutter", "dome.nc:13:"},
      {"apt_centre_contradicts", "scene.toml", "corner_radius_mm = 0",
       "corner_radius_mm = 1\nshape = \"apt\"\ncorner_centre_mm = [4.5, 1]", "bad-cutter", "scene.toml:11:"},
      {"apt_flank_meets_axis", "scene.toml", "corner_radius_mm = 0", "shape = \"apt\"\nbeta_deg = -20",
       "bad-cutter", "scene.toml:10:"},
      {"profile_crosses_itself", "scene.toml", kPlainFlutes,
       "shape = \"profile\"\nprofile = [{to_mm=[0,0]}, {to_mm=[5,0]}, {to_mm=[2,10]}, {to_mm=[2,4]}, "
       "{to_mm=[6,8]}, {to_mm=[6,20]}]",
       "bad-cutter", "scene.toml:9:"},
      {"profile_off_the_axis", "scene.toml", kPlainFlutes,
       "shape = \"profile\"\nprofile = [{to_mm=[1,0]}, {to_mm=[5,0]}, {to_mm=[5,20]}]", "bad-cutter",
       "scene.toml:9:"},
      {"profile_missing", "scene.toml", kPlainFlutes, "shape = \"profile\"", "bad-cutter", "scene.toml:6:"},
      {"flutes_of_no_length", "scene.toml", "flute_length_mm = 45", "flute_length_mm = 0", "out-of-range",
       "scene.toml:10:"},
      {"flutes_longer_than_tool", "scene.toml", "flute_length_mm = 45", "flute_length_mm = 65", "bad-cutter",
       "scene.toml:10:"},
      {"neck_longer_than_tool", "scene.toml", "shank_diameter_mm = 10",
       "neck_length_mm = 20\nneck_diameter_mm = 9", "bad-cutter", "scene.toml:11:"},
      {"holder_described_twice", "scene.toml", "holder_diameter_mm = 40",
       "holder = [{ diameter_mm = 40, length_mm = 20 }]\nholder_diameter_mm = 40", "unknown-key",
       "scene.toml:14:"},
      {"scene_empty", "scene.toml", "", "", "empty-file", "scene.toml"},
      {"scene_not_text", "scene.toml", "", std::string("title = \"a\"\0b", 13), "not-text", "scene.toml"},
      {"tool_not_described", "dome.nc", "T1 M6", "T7 M6", "unknown-tool", "dome.nc:13:"},
      {"unknown_word", "dome.nc", "N110 G06.3 P1", "N110 G06.3 P1 W3", "unknown-word", "dome.nc:13:"},
      {"after_l79", "dome.nc", "N110", "N105 G10 L71 P1 I2 J2 Z1\nN110", "surface-closed", "dome.nc:13:"},
      {"unclosed", "dome.nc", "N100 G10 L79 P1 D1\n", "", "surface-not-closed", "dome.nc:12:"},
      {"unknown_surface", "dome.nc", "G06.3 P1", "G06.3 P2", "surface-unknown", "dome.nc:13:"},
      {"degenerate", "dome.nc", "X0 Y80 Z60", "X0 Y0 Z0", "surface-degenerate", "dome.nc:12:"},
      {"saddle", "dome.nc", "N70 G10 L71 P1 I2 J0 X0 Y0 Z-80", "N70 G10 L71 P1 I2 J0 X0 Y0 Z80",
       "saddle-or-concave", "dome.nc:13:"},
      {"beyond_cutter", "dome.nc", "E0.010", "E0.9", "interval-beyond-cutter", "dome.nc:13:"},
      {"negative_feed", "dome.nc", "F3000", "F-3000", "out-of-range", "dome.nc:13:"},
      {"missing_feed", "dome.nc", " F3000", "", "missing-feed", "dome.nc:13:"},
      {"scallop_zero", "dome.nc", "E0.010", "E0", "out-of-range", "dome.nc:13:"},
      {"no_tool", "dome.nc", "N20 T1 M6\n", "", "no-tool", "dome.nc:12:"},
      {"nan_coefficient", "dome.nc", "X-50", "XNAN", "bad-number", "dome.nc:7:"},
      {"huge_coefficient", "dome.nc", "X-50", "X1e400", "bad-number", "dome.nc:7:"},
      {"program_empty", "dome.nc", "", "", "empty-file", "dome.nc"},
      {"program_not_text", "dome.nc", "", std::string("G17\0\xff", 5), "not-text", "dome.nc"},
      {"machine_cycle", "machine/machine.toml", "name = \"x_slide\"\nparent = \"bed\"",
       "name = \"x_slide\"\nparent = \"cradle\"", "chain-cycle", "machine.toml:"},
      {"machine_missing_limit", "machine/machine.toml", "min_mm", "# min_mm", "missing-key", "machine.toml:"},
      {"machine_unknown_axis", "machine/machine.toml", "name = \"X\"", "name = \"Q\"", "unknown-axis",
       "machine.toml:"},
  };
}

INSTANTIATE_TEST_SUITE_P(Dome, BadInputTest, testing::ValuesIn(bad_inputs()),
                         [](const testing::TestParamInfo<BadInput>& one) {
                           return std::string(one.param.name);
                         });

TEST(OutputFolder, OfSomebodyElseIsNotReplaced) {
  const fs::path folder = swarf::test::fresh_folder("precious");
  write_text(folder / "thesis.txt", "years of work");
  const auto run = run_swarf("run " SWARF_SOURCE_DIR "/scenes/lin_koren_dome/scene.toml --no-render -o " +
                             folder.string());
  EXPECT_EQ(run.exit_code, 2) << run.output;
  EXPECT_EQ(read_text(folder / "thesis.txt"), "years of work");
  fs::remove_all(folder);
}

TEST(CommandLine, TeachesAndRefuses) {
  EXPECT_EQ(run_swarf("--help").exit_code, 0);
  EXPECT_NE(run_swarf("--help").output.find("Exit codes"), std::string::npos);
  for (const char* command : {"run", "check", "plan", "compare", "render", "export"}) {
    EXPECT_EQ(run_swarf(std::string(command) + " --help").exit_code, 0) << command;
  }
  EXPECT_EQ(run_swarf("").exit_code, 2);
  EXPECT_EQ(run_swarf("runn x").exit_code, 2);
  EXPECT_EQ(run_swarf("run does/not/exist.toml").exit_code, 2);
  EXPECT_EQ(run_swarf("render /tmp --still x.png").exit_code, 2);
}

}  // namespace

}  // namespace bad_input_test
