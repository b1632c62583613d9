// swarf check of NC programs as a user meets it.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "support/program_run.h"
#include "unit/program/nc_support.h"

namespace swarf::program {
namespace {

test::ProgramRun check(const std::string& name, const std::string& text, const std::string& options) {
  const auto folder = test::fresh_folder("nc_check");
  test::write_text(folder / name, text);
  test::write_text(folder / "tools.tbl", "T3 P3 Z75 D8 ; ball END8\n");
  const std::string tools =
      options.find("--tools") == std::string::npos ? "" : (folder / "tools.tbl").string();
  return test::run_swarf("check " + options + tools + " " + (folder / name).string());
}

void expect_lines(const test::ProgramRun& run, const std::vector<std::string>& lines) {
  for (const std::string& line : lines)
    EXPECT_NE(run.output.find(line), std::string::npos) << "'" << line << "' is missing in\n" << run.output;
}

/// A square of 100 mm with a half circle of 20 mm outwards: lengths, times and extents by hand.
TEST(NcCheck, TellsPathTimeToolsAndExtents) {
  const test::ProgramRun run = check("part.ngc",
                                     "T3 M6 G43\nS1000 M3\nM8\nG0 X0 Y0 Z10\nG1 Z0 F600\nG1 X100\nY30\n"
                                     "G3 X100 Y70 I0 J20\nG1 Y100\nX0\nY0\nG4 P2\nG0 Z10\nM2\n",
                                     "--home --tools ");
  EXPECT_EQ(run.exit_code, 0) << run.output;
  const double feed = 10.0 + 100.0 + 30.0 + 20.0 * kPi + 30.0 + 100.0 + 100.0;
  expect_lines(run,
               {"dialect   linuxcnc (recognised by the file's ending .ngc)", "read      14 lines",
                "moves     7 feed moves (1 arc), 2 rapids", fmt::format("path      feed {:.3f} mm", feed),
                fmt::format("time      feed {:.2f} s at the programmed feed, dwells 2.00 s", feed / 10.0),
                "tools     T3", "D 8 mm, length 75 mm", "X 0.000 to 120.000 mm", "Y 0.000 to 100.000 mm",
                "Z 0.000 to 10.000 mm, the tip in the work", "M8 (flood)"});
}

TEST(NcCheck, TellsProgramsTheSameAsPeople) {
  const test::ProgramRun run =
      check("part.ngc", "G21 T3 M6 G43\nG0 X0 Y0 Z10\nG1 Z0 F600\nG3 X0 Y40 J20\nM8\nM2\n",
            "--json --home --tools ");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const nlohmann::json all = nlohmann::json::parse(run.output);
  EXPECT_EQ(all["right"], true);
  const nlohmann::json& file = all["files"][0];
  EXPECT_EQ(file["kind"], "nc");
  EXPECT_EQ(file["dialect"], "linuxcnc");
  ASSERT_EQ(file["diagnostics"].size(), 1u) << file["diagnostics"];
  EXPECT_EQ(file["diagnostics"][0]["code"], "tool-shape-assumed");
  EXPECT_NEAR(file["feed_mm"].get<double>(), 10.0 + 20.0 * kPi, 1e-9);
  EXPECT_NEAR(file["feed_s"].get<double>(), 1.0 + 2.0 * kPi, 1e-9);
  EXPECT_TRUE(file["rapid_s"].is_null());
  EXPECT_EQ(file["tools"][0]["number"], 3);
  EXPECT_NEAR(file["cut_mm"]["x"][1].get<double>(), 20.0, 1e-9);
  EXPECT_EQ(file["no_effect"][0], "M8 (flood)");
}

TEST(NcCheck, TellsProgramsWhatIsWrong) {
  const test::ProgramRun run = check("part.ngc", "G21 G0 X0 Y0 Z10\nG1 X1\nM2\n", "--json --home");
  EXPECT_EQ(run.exit_code, 2);
  const nlohmann::json all = nlohmann::json::parse(run.output);
  EXPECT_EQ(all["right"], false);
  const nlohmann::json& file = all["files"][0];
  EXPECT_TRUE(file["kind"].is_null());
  ASSERT_EQ(file["diagnostics"].size(), 2u);
  EXPECT_EQ(file["diagnostics"][1]["code"], "dialect-taken");
  EXPECT_EQ(file["diagnostics"][0]["code"], "missing-feed");
  EXPECT_EQ(file["diagnostics"][0]["line"], 2);
  EXPECT_EQ(file["diagnostics"][0]["severity"], "error");
}

TEST(NcCheck, TimesRapidsOnAMachineAndFindsTravel) {
  const std::string machine =
      "--home --machine " + std::string(SWARF_SOURCE_DIR) + "/assets/machines/spinner_u5_620/machine.toml";
  const test::ProgramRun run = check("part.mpf", "SUPA G0 X0\nSUPA G0 X5000\nM30\n", machine);
  EXPECT_EQ(run.exit_code, 1) << run.output;
  expect_lines(run, {"dialect   siemens", "at the axes' rapid speeds",
                     "finding   X goes to 5000.000 mm in line 2 first; its travel is"});
}

TEST(NcCheck, RefusesWithPlaceAndAdvice) {
  const test::ProgramRun run = check("part.ngc", "G0 X0 Y0 Z0\nG1 X5\nM2\n", "");
  EXPECT_EQ(run.exit_code, 2);
  expect_lines(run, {"part.ngc:2:4: error: this feed move has no F", "fix: add the feed: F1000"});
  expect_lines(test::run_swarf("check --help"), {"--tools", "--dialect", "Examples:", "Exit codes:"});
}

/// A corner of 50 x 50 mm, the cutter on its left: the points are the part's, or the centre's.
constexpr const char* kCutcomFile =
    "TOOL PATH/A,TOOL,T1\nTLDATA/MILL,10.0,0.0,75.0,0.0,0.0\nUNITS/MM\nSPINDL/RPM,3000,CLW\nFEDRAT/500\n"
    "GOTO/0,-20,10\nGOTO/0,-20,-5\nCUTCOM/LEFT\nGOTO/0,0,-5\nGOTO/0,50,-5\nGOTO/50,50,-5\nCUTCOM/OFF\n"
    "GOTO/60,40,-5\n";

TEST(ClCheck, CutcomNeedsItsMeaning) {
  const auto run = [](const char* options) {
    const auto folder = test::fresh_folder("cl_check");
    test::write_text(folder / "part.cls", kCutcomFile);
    return test::run_swarf(std::string("check ") + options + " " + (folder / "part.cls").string());
  };
  const test::ProgramRun without = run("");
  EXPECT_EQ(without.exit_code, 2);
  expect_lines(without, {"part.cls:8:1: error:", "[cutcom-meaning]", "--cutcom"});
  expect_lines(run("--cutcom contour"),
               {"tips from (-5.000, -20.000, -5.000) to (60.000, 55.000, 10.000) mm"});
  expect_lines(run("--cutcom centre"), {"tips from (0.000, -20.000, -5.000) to (60.000, 50.000, 10.000) mm",
                                        "the wear offset of the control is taken as 0"});
}

TEST(ClCheck, TheSceneSaysWhatCutcomMeans) {
  const auto check_scene = [](const std::string& key) {
    const auto folder = test::fresh_folder("cl_scene_check");
    test::write_text(folder / "part.cls", kCutcomFile);
    test::write_text(folder / "scene.toml",
                     "machine = \"" SWARF_SOURCE_DIR
                     "/assets/machines/mill_3axis/machine.toml\"\ncl = \"part.cls\"\n" +
                         key +
                         "[cutter]\nnumber = 1\nshape = \"flat\"\ndiameter_mm = 10\nflute_length_mm = 20\n"
                         "length_mm = 75\n[stock]\nbox_mm = [[-10, -10, -10], [60, 60, 0]]\nvoxel_mm = 1\n"
                         "[design]\nkind = \"none\"\n");
    return test::run_swarf("check " + (folder / "scene.toml").string());
  };
  const test::ProgramRun without = check_scene("");
  EXPECT_EQ(without.exit_code, 2);
  expect_lines(without, {"part.cls:8:1: error:", "[cutcom-meaning]", "cutcom = \"centre\""});
  for (const char* meaning : {"centre", "contour"}) {
    const test::ProgramRun with = check_scene(std::string("cutcom = \"") + meaning + "\"\n");
    EXPECT_EQ(with.exit_code, 0) << with.output;
  }
}

}  // namespace
}  // namespace swarf::program
