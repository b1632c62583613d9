// Options of the command line that no other test runs: what each changes is seen from outside.
// tests/lint/options.py holds that every option has a test.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/program_run.h"

namespace options_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using swarf::test::fresh_folder;
using swarf::test::ProgramRun;
using swarf::test::run_swarf;

const std::string kMachines = SWARF_SOURCE_DIR "/assets/machines/";

std::string written(const fs::path& folder, const char* name, const std::string& text) {
  swarf::test::write_text(folder / name, text);
  return (folder / name).string();
}

bool says(const ProgramRun& run, const std::string& words) {
  return run.output.find(words) != std::string::npos;
}

class Options : public testing::Test {
 protected:
  Options() : folder_(fresh_folder("options")) {}
  ~Options() override { fs::remove_all(folder_); }
  std::string file(const char* name, const std::string& text) const { return written(folder_, name, text); }

  fs::path folder_;
};

TEST_F(Options, VersionIsPrinted) {
  const ProgramRun run = run_swarf("--version");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.output.find_first_of("0123456789"), 0u) << run.output;
  EXPECT_TRUE(says(run, "commit ")) << run.output;
  EXPECT_TRUE(says(run, "OpenVDB 1")) << run.output;
}

TEST_F(Options, HowMuchIsSaidIsAsked) {
  const std::string scene = SWARF_SOURCE_DIR "/scenes/exact_gouges/scene.toml";
  const auto run = [&](const std::string& options) {
    return run_swarf("run " + scene + " --no-render -o " + (folder_ / "run").string() + " " + options);
  };
  const ProgramRun usual = run(""), quiet = run("--quiet"), plain = run("--no-progress"),
                   all = run("--verbose");
  EXPECT_TRUE(says(usual, "cut measuring rays"));
  EXPECT_TRUE(says(usual, "removed"));
  EXPECT_FALSE(says(plain, "cut measuring rays")) << plain.output;
  EXPECT_TRUE(says(plain, "removed"));
  EXPECT_FALSE(says(quiet, "removed")) << quiet.output;
  EXPECT_TRUE(says(quiet, "FINDINGS")) << quiet.output;
  EXPECT_TRUE(says(quiet, "finding: ")) << quiet.output;
  EXPECT_FALSE(says(all, " more of ")) << all.output;
  for (const ProgramRun& one : {usual, quiet, plain, all}) {
    EXPECT_EQ(one.exit_code, 1);
    EXPECT_EQ(one.output.find('\033'), std::string::npos) << "colour without a terminal";
  }
}

/// A terminal shows severities in colour, unless NO_COLOR is set.
TEST_F(Options, ATerminalShowsColourUnlessItIsRefused) {
  const std::string wrong = file("wrong.ngc", "G21 G90\nG1 X10 F100 Q%\nM2\n");
  const std::string command =
      "script -qec '" + std::string(SWARF_PROGRAM) + " check " + wrong + "' /dev/null";
  EXPECT_TRUE(says(swarf::test::run_command("env -u NO_COLOR " + command), "\033[1;31m"));
  EXPECT_FALSE(says(swarf::test::run_command("NO_COLOR=1 " + command), "\033[1;31m"));
}

TEST_F(Options, CheckTakesTheToolThatIsInTheSpindle) {
  const std::string program = file("part.ngc", "G21 G90 G17\nS1000 M3\nG0 X0 Y0 Z0\nG1 X10 F100\nM2\n");
  const std::string tools = file("tools.tbl", "T1 P1 D6 Z50\nT2 P2 D8 Z50\n");
  const std::string check = "check " + program + " --tools " + tools;
  EXPECT_FALSE(says(run_swarf(check), "T2 (D 8 mm"));
  const ProgramRun with = run_swarf(check + " --start-tool 2");
  EXPECT_EQ(with.exit_code, 0) << with.output;
  EXPECT_TRUE(says(with, "T2 (D 8 mm")) << with.output;
}

TEST_F(Options, CheckTakesATThatChangesTheToolAtOnce) {
  const std::string program = file("part.ngc", "G21 G90 G17\nT1\nS1000 M3\nG0 X0 Y0 Z0\nG1 X10 F100\nM2\n");
  const std::string tools = file("tools.tbl", "T1 P1 D6 Z50\nT2 P2 D8 Z50\n");
  const std::string check = "check " + program + " --tools " + tools;
  EXPECT_FALSE(says(run_swarf(check), "T1 (D 6 mm"));
  const ProgramRun with = run_swarf(check + " --t-changes-tool");
  EXPECT_TRUE(says(with, "T1 (D 6 mm")) << with.output;
}

/// Where the radius of slots on a circle ends is said by the user, and moves the slots.
TEST_F(Options, SlotEndsAreSaidToCheckAndRun) {
  const std::string program = file("slot.mpf",
                                   "G17 G90 G54 G710\nT1 M6\nS1000 M3 F500\nG0 X0 Y0 Z20\n"
                                   "LONGHOLE(5,0,1,-4,,1,30,0,0,20,0,0,100,320,2)\nG0 Z20\nM30\n");
  const std::string tools = file("tools.tbl", "T1 P1 D6 Z50\n");
  const std::string check = "check " + program + " --tools " + tools;
  EXPECT_TRUE(says(run_swarf(check), "slot-ends"));
  const ProgramRun edge = run_swarf(check + " --slot-ends edge"),
                   centre = run_swarf(check + " --slot-ends centre");
  EXPECT_EQ(edge.exit_code, 0) << edge.output;
  EXPECT_EQ(centre.exit_code, 0) << centre.output;
  EXPECT_NE(edge.output, centre.output);
  const ProgramRun init =
      run_swarf("init " + program + " --tool 6 --slot-ends centre -o " + (folder_ / "job").string());
  EXPECT_EQ(init.exit_code, 0) << init.output;
  EXPECT_TRUE(swarf::test::read_text(folder_ / "job" / "scene.toml").find("slot_ends = \"centre\"") !=
              std::string::npos);
}

/// Whether the matrix of TRACUT still turns the positions is said by the user, and moves the path.
TEST_F(Options, TracutIsSaidToCheckInitAndPost) {
  const std::string program = file("turned.cls",
                                   "UNITS/MM\nLOADTL/1\nSPINDL/RPM,1000,CLW\nFEDRAT/500,MMPM\n"
                                   "TRACUT/0,-1,0,100,1,0,0,0,0,0,1,0\nGOTO/0,0,5\nGOTO/40,0,5\n"
                                   "TRACUT/NOMORE\nFINI\n");
  const ProgramRun without = run_swarf("check " + program);
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_TRUE(says(without, "turned.cls:5:1: error:") && says(without, "--tracut") &&
              says(without, "tracut = \"applied\""))
      << without.output;
  const ProgramRun apply = run_swarf("check --tracut apply " + program),
                   applied = run_swarf("check --tracut applied " + program);
  EXPECT_TRUE(says(apply, "tips from (100.000, 0.000, 5.000) to (100.000, 40.000, 5.000) mm"))
      << apply.output;
  EXPECT_TRUE(says(applied, "tips from (0.000, 0.000, 5.000) to (40.000, 0.000, 5.000) mm"))
      << applied.output;
  const std::string job = (folder_ / "job").string();
  const ProgramRun init = run_swarf("init " + program + " --tool 6 --tracut apply -o " + job);
  EXPECT_EQ(init.exit_code, 0) << init.output;
  EXPECT_NE(swarf::test::read_text(folder_ / "job" / "scene.toml").find("tracut = \"apply\""),
            std::string::npos);
  EXPECT_EQ(run_swarf("check " + job + "/scene.toml").exit_code, 0);
  const ProgramRun post =
      run_swarf("post " + program + " --machine maho_600c --work-origin 0 0 300 --tracut apply -o -");
  EXPECT_EQ(post.exit_code, 0) << post.output;
  EXPECT_TRUE(says(post, "Y40")) << post.output;
}

/// Inches in a file that does not say so: 25.4 times as large, and never taken in silence.
TEST_F(Options, UnitsOfClDataThatSayNone) {
  const std::string text = "LOADTL/1\nSPINDL/RPM,1000,CLW\nFEDRAT/500,MMPM\nGOTO/0,0,1\nGOTO/2,0,1\n";
  const std::string none = file("none.cls", text + "FINI\n");
  const std::string said = file("said.cls", "UNITS/MM\n" + text + "FINI\n");
  const ProgramRun mm = run_swarf("check " + none), inch = run_swarf("check --units inch " + none);
  EXPECT_TRUE(says(mm, "to (2.000, 0.000, 1.000) mm") && says(mm, "the file has no UNITS")) << mm.output;
  EXPECT_TRUE(says(inch, "to (50.800, 0.000, 25.400) mm") && !says(inch, "no UNITS")) << inch.output;
  const std::string at = " --machine maho_600c --work-origin 0 0 200 -o -";
  const ProgramRun posted = run_swarf("post " + none + at),
                   posted_inch = run_swarf("post " + none + " --cl-units inch" + at);
  EXPECT_TRUE(says(posted, "units-assumed") && says(posted, "X2.")) << posted.output;
  EXPECT_TRUE(!says(posted_inch, "units-assumed") && says(posted_inch, "X50.8")) << posted_inch.output;
  // What the file says is so.
  const ProgramRun both = run_swarf("check --units inch " + said);
  EXPECT_TRUE(says(both, "to (2.000, 0.000, 1.000) mm") && !says(both, "no UNITS")) << both.output;
  const std::string out = (folder_ / "units").string();
  const ProgramRun run = run_swarf("run " + none + " --tool 6 --no-render -o " + out);
  EXPECT_TRUE(says(run, "the file has no UNITS") && says(run, "--units; setup.units")) << run.output;
  const ProgramRun run_inch = run_swarf("run " + none + " --tool 6 --units inch --no-render -o " + out);
  EXPECT_TRUE(!says(run_inch, "no UNITS") && says(run_inch, "X -5.000 to 55.800")) << run_inch.output;
}

/// A flag that the program's kind does not take would be believed to have been followed.
TEST_F(Options, FlagsOfTheOtherKindAreRefused) {
  const std::string cl = file("a.cls", "UNITS/MM\nLOADTL/1\nFEDRAT/500,MMPM\nGOTO/0,0,1\nGOTO/2,0,1\nFINI\n");
  const std::string nc = file("a.nc", "G21 G90 G17\nT1 M6\nS1000 M3\nG0 X0 Y0 Z1\nG1 X2 F100\nM30\n");
  for (const std::string& words :
       {"run " + nc + " --tool 6 --tracut apply", "run " + cl + " --tool 6 --dialect fanuc",
        "run " + cl + " --tool 6 --start-tool 1", "run " + cl + " --tool 6 --t-changes-tool",
        "run " + cl + " --tool 6 --slot-ends edge", "check " + nc + " --tracut apply",
        "check " + nc + " --cutcom centre", "check " + nc + " --circle clockwise", "check " + cl + " --home",
        "check " + cl + " --dialect fanuc"}) {
    const ProgramRun refused =
        run_swarf(words + (words.starts_with("run") ? " --no-render -o " + (folder_ / "no").string() : ""));
    EXPECT_EQ(refused.exit_code, 2) << words << "\n" << refused.output;
    EXPECT_TRUE(says(refused, "flag-of-other-kind") || says(refused, "and none is among the files") ||
                says(refused, "leave open"))
        << words << "\n"
        << refused.output;
  }
  // One file of the list takes it.
  EXPECT_EQ(run_swarf("check --tracut apply " + cl + " " + nc).exit_code, 0);
}

/// A Z from a parameter that the program reads and does not set: check and run take it, a scene holds it.
TEST_F(Options, ParametersHoldAValueBeforeTheProgramStarts) {
  const std::string program = file(
      "part.nc", "O0001\nG21 G90 G17\nT1 M6\nS1000 M3\nG0 X0. Y0. Z5.\nG1 Z-#500 F100.\nX10.\nG0 Z5.\nM30\n");
  const ProgramRun without = run_swarf("check " + program);
  EXPECT_TRUE(says(without, "vacant-word")) << without.output;
  const ProgramRun with = run_swarf("check " + program + " --set-parameter '#500=3.5' --json");
  EXPECT_EQ(with.exit_code, 0) << with.output;
  EXPECT_TRUE(says(with, "-3.5")) << with.output;
  EXPECT_FALSE(says(with, "vacant-word")) << with.output;
  const ProgramRun wrong = run_swarf("check " + program + " --set-parameter 500=deep");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_TRUE(says(wrong, "write --set-parameter 500=3.5")) << wrong.output;
  for (const char* command : {"check ", "run "}) {
    const ProgramRun twice = run_swarf(command + program + " --set-parameter 500=1 --set-parameter '#500=2'");
    EXPECT_EQ(twice.exit_code, 2);
    EXPECT_TRUE(says(twice, "given-twice")) << twice.output;
    const ProgramRun hex = run_swarf(command + program + " --set-parameter 500=0x10");
    EXPECT_TRUE(says(hex, "bad-option")) << hex.output;
  }
  const ProgramRun other = run_swarf("check " + program + " --set-parameter R1=2");
  EXPECT_TRUE(says(other, "bad-preset")) << other.output;

  // The slot of a flat end D 6: 10 x 6 and a circle, 3.5 and 2 deep.
  const double area = 60.0 + 9.0 * std::acos(-1.0);
  const auto removed = [&](const std::string& job) {
    const fs::path out = folder_ / "out";
    fs::remove_all(out);
    const ProgramRun run = run_swarf("run " + job + " --no-render -o " + out.string());
    EXPECT_EQ(run.exit_code, 0) << run.output;
    return json::parse(swarf::test::read_text(out / "metrics.json"))["stock"]["volume_removed_mm3"]
        .get<double>();
  };
  const std::string flags = " --tool 6 --stock=-5,-5,-6,15,5,0 --voxel 0.25";
  EXPECT_NEAR(removed(program + flags + " --set-parameter 500=3.5"), 3.5 * area, 0.02 * 3.5 * area);

  // `init` writes the value into its scene, which cuts as deep; `show` draws it.
  const std::string job = (folder_ / "job").string();
  ASSERT_EQ(run_swarf("init " + program + flags + " --set-parameter 500=3 -o " + job).exit_code, 0);
  EXPECT_NEAR(removed(job + "/scene.toml"), 3.0 * area, 0.02 * 3.0 * area);
  const std::string drawn =
      "show " + program + flags + " --set-parameter 500=3 -o " + (folder_ / "path.png").string();
  EXPECT_EQ(run_swarf(drawn).exit_code, 0);

  // The same in inches, as a scene with the parameter in it; the option goes before it.
  const std::string scene = file("scene.toml",
                                 "nc = \"part.nc\"\ntools = \"6\"\n[parameters]\n500 = 3.5\n[setup]\n"
                                 "work_origin_mm = \"on_table\"\nwithout_length = \"tip\"\n[stock]\n"
                                 "box_in = [[-0.2, -0.2, -0.25], [0.6, 0.2, 0]]\nvoxel_in = 0.01\n");
  EXPECT_EQ(run_swarf("check " + scene).exit_code, 0);
  EXPECT_NEAR(removed(scene), 3.5 * area, 0.02 * 3.5 * area);
  EXPECT_NEAR(removed(scene + " --set-parameter 500=2"), 2.0 * area, 0.02 * 2.0 * area);
  const ProgramRun both = run_swarf("check " + file("both.toml",
                                                    "nc = \"part.nc\"\ntools = \"6\"\n[stock]\n"
                                                    "voxel_mm = 0.25\nvoxel_in = 0.01\n"));
  EXPECT_TRUE(says(both, "'stock.voxel_mm' and 'stock.voxel_in'")) << both.output;
}

TEST_F(Options, CheckTakesTheUnitOfProgramsThatNameNone) {
  const std::string program = file("part.ngc", "G90 G17\nS1000 M3\nG0 X0 Y0 Z0\nG1 X1 F10\nM2\n");
  const ProgramRun inch = run_swarf("check " + program + " --units inch --json");
  const ProgramRun mm = run_swarf("check " + program + " --units mm --json");
  EXPECT_EQ(inch.exit_code, 0) << inch.output;
  EXPECT_EQ(mm.exit_code, 0) << mm.output;
  EXPECT_TRUE(says(inch, "25.4")) << inch.output;
  EXPECT_FALSE(says(mm, "25.4")) << mm.output;
}

TEST_F(Options, CheckTakesABuildersWord) {
  const std::string program = file("part.nc", "O0001\nG21 G90\nM168\nG0 X0 Y0 Z0\nG1 X10 F100\nM30\n%\n");
  EXPECT_EQ(run_swarf("check " + program + " --dialect fanuc").exit_code, 2);
  const ProgramRun with = run_swarf("check " + program + " --dialect fanuc --builder-word \"M168=clamp C\"");
  EXPECT_EQ(with.exit_code, 0) << with.output;
  EXPECT_TRUE(says(with, "clamp C")) << with.output;
}

TEST_F(Options, CheckTakesWhatSwitchesTheKinematics) {
  const std::string program = file("part.ngc", "G21 G90\nM428\nG0 X0 Y0 Z0 A0 B0\nG1 X10 F100\nM2\n");
  const std::string check = "check " + program + " --machine " + kMachines + "lin_koren_xyzab/machine.toml";
  EXPECT_TRUE(says(run_swarf(check), "kinematics-assumed"));
  const ProgramRun with = run_swarf(check + " --kinematics m428=identity");
  EXPECT_FALSE(says(with, "kinematics-assumed")) << with.output;
}

TEST_F(Options, CheckTakesAMachineByNameAsRunDoes) {
  const std::string program = file("part.ngc", "G21 G90 G17\nG0 X0 Y0 Z0 A0 B0\nG1 X10 F100\nM2\n");
  const ProgramRun named = run_swarf("check -q " + program + " --machine lin_koren_xyzab --json");
  const ProgramRun by_file =
      run_swarf("check -q " + program + " --machine " + kMachines + "lin_koren_xyzab/machine.toml --json");
  EXPECT_EQ(named.exit_code, by_file.exit_code);
  EXPECT_EQ(named.output, by_file.output);
  EXPECT_TRUE(says(run_swarf("check " + program + " --machine lin_koren"), "unknown-machine"));
}

TEST_F(Options, CheckTakesTheSenseOfACircle) {
  const std::string program = file("part.cls",
                                   "UNITS/MM\nLOADTL/1\nFEDRAT/100\nGOTO/10,0,0,0,0,1\n"
                                   "CIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0,0,0,1\nFINI\n");
  const auto length = [&](const std::string& circle) {
    const ProgramRun run = run_swarf("check " + program + " " + circle + " --json");
    EXPECT_EQ(run.exit_code, 0) << run.output;
    return run.output;
  };
  EXPECT_NE(length("--circle clockwise"), length("--circle counter_clockwise"));
}

TEST_F(Options, CheckTriesSoManyPoses) {
  const ProgramRun run = run_swarf("check --poses 1234 " + kMachines + "lin_koren_xyzab/machine.toml");
  EXPECT_EQ(run.exit_code, 0) << run.output;
  EXPECT_TRUE(says(run, "1234 random poses")) << run.output;
}

/// What is printed goes to a full disk: neither command may say that all is well.
TEST_F(Options, OutputThatDoesNotArriveIsAFault) {
  const std::string program =
      file("part.ngc", "G21 G90 G17 G94\nT1 M6\nM3 S1000\nG0 X0 Y0 Z5\nG1 Z-1 F100\nX10\nM2\n");
  const std::string run = "run " + program + " --tool 6 --stock=-5,-5,-6,15,5,0 --voxel 0.5 --no-render -o " +
                          (folder_ / "out").string();
  for (const std::string& words : {"check " + program + " --json", run, run + " --json"}) {
    const ProgramRun full = run_swarf(words + " >/dev/full");
    EXPECT_EQ(full.exit_code, 2) << words;
    EXPECT_TRUE(says(full, "cannot-write")) << full.output;
  }
}

/// JUnit of a run that is stopped, and what an earlier one has left of a run that never comes to its end.
TEST_F(Options, PipelineFilesOfAnUnfinishedRunAreNotGreen) {
  const std::string junit = (folder_ / "out.xml").string();
  std::string lines = "G21 G90 G17 G94\nT1 M6\nM3 S1000\nG0 X0 Y0 Z5\nG1 Z-1 F100\n";
  for (int i = 0; i < 40000; ++i) lines += i % 2 == 0 ? "X40\n" : "X0\n";
  const std::string program = file("long.ngc", lines + "M2\n");
  const std::string words = SWARF_PROGRAM " -q run " + program +
                            " --tool 6 --stock=-5,-5,-6,45,5,0 --voxel 0.1 --no-render -o " +
                            (folder_ / "out").string() + " --junit " + junit;
  for (const std::string signal : {"INT", "KILL"}) {
    fs::remove(junit);
    const auto stopped = swarf::test::run_command("timeout -s " + signal + " 1 " + words);
    EXPECT_NE(stopped.exit_code, 0);
    const std::string text = swarf::test::read_text(junit);
    EXPECT_NE(text.find("errors=\"1\""), std::string::npos) << signal << "\n" << text;
  }
}

TEST_F(Options, CheckAndRunTellBuildServers) {
  const std::string sarif = (folder_ / "out.sarif").string(), junit = (folder_ / "out.xml").string();
  const std::string wrong = file("wrong.ngc", "G21 G90\nG1 X10 F100 Q%\nM2\n");
  const auto files = " --sarif " + sarif + " --junit " + junit;
  EXPECT_EQ(run_swarf("check " + wrong + files).exit_code, 2);
  const json log = json::parse(swarf::test::read_text(sarif));
  const json& place = log.at("runs").at(0).at("results").at(0).at("locations").at(0).at("physicalLocation");
  EXPECT_EQ(place.at("region").at("startLine"), 2);
  EXPECT_NE(swarf::test::read_text(junit).find("<failure"), std::string::npos);
  const std::string scene = SWARF_SOURCE_DIR "/scenes/exact_gouges/scene.toml";
  EXPECT_EQ(run_swarf("run " + scene + " --no-render -o " + (folder_ / "run").string() + files).exit_code, 1);
  const json found = json::parse(swarf::test::read_text(sarif));
  EXPECT_EQ(found.at("runs").at(0).at("invocations").at(0).at("exitCode"), 1);
  EXPECT_NE(swarf::test::read_text(sarif).find("\"check/gouge\""), std::string::npos);
  EXPECT_EQ(run_swarf("run no_such.toml" + files).exit_code, 2);
  EXPECT_EQ(
      json::parse(swarf::test::read_text(sarif)).at("runs").at(0).at("invocations").at(0).at("exitCode"), 2);
  EXPECT_EQ(run_swarf("check " + wrong + " --sarif " + folder_.string()).exit_code, 2);
}

TEST_F(Options, CheckReadsAProgramFromAPipe) {
  const std::string right = file("right.ngc", "G21 G90\nG0 X0 Y0 Z5\nG1 Z-1 F100\nM2\n");
  const std::string wrong = file("wrong.ngc", "G21 G90\nG0 X0 Y0 Z5\nG1 X10 F100 Q%\nM2\n");
  const std::string check = std::string(" | TMPDIR=") + folder_.string() + " " + SWARF_PROGRAM + " check -";
  const ProgramRun good = swarf::test::run_command("cat " + right + check + " --json");
  EXPECT_EQ(good.exit_code, 0) << good.output;
  const json from_file = json::parse(run_swarf("check " + right + " --json").output).at("files").at(0);
  json from_pipe = json::parse(good.output).at("files").at(0);
  EXPECT_EQ(from_pipe.at("file"), "-");
  for (const char* key : {"lines", "feed_mm", "kind"}) EXPECT_EQ(from_pipe.at(key), from_file.at(key)) << key;
  const ProgramRun bad = swarf::test::run_command("cat " + wrong + check + " --dialect linuxcnc");
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_TRUE(says(bad, "stdin:3:14: error: ")) << bad.output;
  const ProgramRun nothing = swarf::test::run_command("true" + check);
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_TRUE(says(nothing, "[empty-file]")) << nothing.output;
  for (const auto& entry : fs::directory_iterator(folder_))
    EXPECT_FALSE(entry.is_directory()) << "left behind: " << entry.path();
}

TEST_F(Options, ThePageIsShownWhereSomethingShowsIt) {
  const std::string shown = (folder_ / "shown").string();
  const std::string opener = file("xdg-open", "#!/bin/sh\necho \"$1\" > " + shown + "\n");
  fs::permissions(opener, fs::perms::owner_all);
  const std::string run = std::string(SWARF_PROGRAM) +
                          " run " SWARF_SOURCE_DIR "/scenes/exact_shank/scene.toml --no-render -o '" +
                          (folder_ / "a b").string() + "'";
  const std::string path = "PATH=" + folder_.string() + ":/usr/bin:/bin ";
  EXPECT_EQ(swarf::test::run_command(path + run + " --report --open").exit_code, 1);
  for (int i = 0; i < 100 && !fs::exists(shown); ++i) swarf::test::run_command("sleep 0.05");
  EXPECT_EQ(swarf::test::read_text(shown), (folder_ / "a b/report.html").string() + "\n");
  const ProgramRun no_page = swarf::test::run_command(path + run + " --open");
  EXPECT_EQ(no_page.exit_code, 2);
  EXPECT_TRUE(says(no_page, "[no-page]")) << no_page.output;
  // A folder with the shell and nothing else.
  fs::create_directory(folder_ / "bin");
  fs::create_symlink("/bin/sh", folder_ / "bin/sh");
  const ProgramRun none =
      swarf::test::run_command("PATH=" + (folder_ / "bin").string() + " " + run + " --report --open");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_TRUE(says(none, "[no-opener]")) << none.output;
}

TEST_F(Options, TheManualHasEveryCommandAndOption) {
  const ProgramRun man = run_swarf("manual man");
  EXPECT_EQ(man.exit_code, 0);
  EXPECT_EQ(man.output.rfind(".TH SWARF 1", 0), 0u);
  const ProgramRun bash = run_swarf("manual bash");
  for (const char* command : {"run", "check", "compare", "render", "export"}) {
    EXPECT_TRUE(says(man, std::string(".SS swarf ") + command)) << command;
    EXPECT_TRUE(says(bash, std::string("    ") + command + ") words=")) << command;
  }
  EXPECT_TRUE(says(bash, "--no-render"));
  const ProgramRun completed = swarf::test::run_command(
      "bash -c 'source <(" + std::string(SWARF_PROGRAM) +
      " manual bash); COMP_WORDS=(swarf run --no-r); COMP_CWORD=2; _swarf; echo ${COMPREPLY[0]}'");
  EXPECT_EQ(completed.output, "--no-render\n");
  // groff says what it does not take on stderr alone.
  const ProgramRun read = swarf::test::run_command(
      std::string(SWARF_PROGRAM) + " manual man | groff -man -Tascii -ww 3>&1 1>/dev/null 2>&3");
  EXPECT_EQ(read.output, "");
}

/// A prism over a convex polygon, counter-clockwise, as the facets of an ASCII STL.
std::string prism(const std::vector<std::array<double, 2>>& base, double top) {
  std::string text;
  const auto facet = [&](std::initializer_list<std::array<double, 3>> corners) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const auto& p : corners) text += fmt::format("vertex {} {} {}\n", p[0], p[1], p[2]);
    text += "endloop\nendfacet\n";
  };
  const auto at = [&](size_t i, double z) { return std::array<double, 3>{base[i][0], base[i][1], z}; };
  for (size_t i = 0; i < base.size(); ++i) {
    const size_t next = (i + 1) % base.size();
    facet({at(i, 0), at(next, 0), at(next, top)});
    facet({at(i, 0), at(next, top), at(i, top)});
    if (i < 2) continue;
    facet({at(0, 0), at(i, 0), at(i - 1, 0)});
    facet({at(0, top), at(i - 1, top), at(i, top)});
  }
  return text;
}

std::string box(double x, double size, double top) {
  return prism({{x, 0}, {x + size, 0}, {x + size, size}, {x, size}}, top);
}

std::string solid(const std::string& facets) {
  return "solid s\n" + facets + "endsolid s\n";
}

/// They were answered with the 309 digits of the largest number.
TEST_F(Options, NumbersOutOfTheirRangeAreToldInAFewWords) {
  for (const auto& [words, answer] :
       {std::pair("render x --seconds 0", "--seconds: 0 is not a number above 0\n"),
        std::pair("render x --seconds inf", "inf is not a number above 0\n"),
        std::pair("render x --finding 0", "0 is not a number above 0\n"),
        std::pair("render x --from nan", "nan is not a number of 0 or more\n"),
        std::pair("compare a b --gouge-um=-1", "-1 is not a number of 0 or more\n")}) {
    const ProgramRun run = run_swarf(words);
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_NE(run.output.find(answer), std::string::npos) << run.output;
  }
}

TEST_F(Options, CompareMeasuresOnlyWhatLiesSoNear) {
  const std::string design = file("design.stl", solid(box(0, 10, 5)));
  const std::string stock = file("stock.stl", solid(box(0, 10, 5.05) + box(100, 10, 5)));
  const std::string compare =
      "compare " + stock + " " + design + " --pitch-mm 0.5 --gouge-um 100 --excess-um 100";
  const ProgramRun all = run_swarf(compare);
  EXPECT_EQ(all.exit_code, 1) << all.output;
  const ProgramRun near = run_swarf(compare + " --reach-mm 1");
  EXPECT_EQ(near.exit_code, 1) << near.output;  // what lies farther away is a finding with its area
  EXPECT_NE(near.output, all.output);
}

/// A grid rounds the edges of a slot; what that may be is not put down to the cut.
TEST_F(Options, CompareAllowsEdgesThatAGridHasRounded) {
  const std::string run = (folder_ / "run").string();
  const std::string scene = SWARF_SOURCE_DIR "/scenes/exact_scallop_mesh/";
  ASSERT_NE(run_swarf("run " + scene + "scene.toml --no-render -o " + run).exit_code, 2);
  const std::string compare = "compare " + run + "/stock.vdb " + scene + "scene.toml --json --edge-mm ";
  EXPECT_NE(run_swarf(compare + "0").output, run_swarf(compare + "0.5").output);
}

/// Where both are meshes the option would change nothing: it is not taken as if it did.
TEST_F(Options, CompareRefusesAnEdgeWhereNoGridHasRoundedAny) {
  const std::string design = file("design.stl", solid(box(0, 10, 5)));
  const ProgramRun run = run_swarf("compare " + design + " " + design + " --edge-mm 0.2");
  EXPECT_EQ(run.exit_code, 2) << run.output;
  EXPECT_TRUE(says(run, "unused-option")) << run.output;
}

TEST_F(Options, CompareWritesItsMapsToAFolder) {
  const std::string design = file("design.stl", solid(box(0, 10, 5)));
  const fs::path out = folder_ / "maps";
  const ProgramRun run =
      run_swarf("compare " + design + " " + design + " --pitch-mm 0.5 --output " + out.string());
  EXPECT_EQ(run.exit_code, 0) << run.output;
  EXPECT_FALSE(fs::is_empty(out));
}

TEST_F(Options, ExportDecimatesWithinTheErrorThatIsAsked) {
  const std::string run = (folder_ / "run").string();
  const std::string scene = SWARF_SOURCE_DIR "/scenes/exact_slot_flat/scene.toml";
  ASSERT_NE(
      run_swarf("run " + scene + " --no-render --output " + run + " --set stock.voxel_mm=0.5").exit_code, 2);
  const auto size = [&](const char* error) {
    const fs::path file = folder_ / (std::string("part_") + error + ".glb");
    const ProgramRun made = run_swarf("export " + run + " --gltf " + file.string() + " --error-um " + error);
    EXPECT_EQ(made.exit_code, 0) << made.output;
    return fs::file_size(file);
  };
  EXPECT_LT(size("500"), size("0.01"));
}

}  // namespace

}  // namespace options_test
