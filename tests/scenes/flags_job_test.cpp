// Programs without a scene, by the shipped program: what flags mean, what is assumed and said, what is
// refused.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "base/units.h"
#include "support/json_path.h"
#include "support/program_run.h"

namespace flags_job_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using swarf::test::at_path;
using swarf::test::ProgramRun;
using swarf::test::read_text;
using swarf::test::run_swarf;
using swarf::test::write_text;

/// A groove 60 long and 4 deep by T1, without G43, from Z0 as the upper face.
const char* const kGroove =
    "G21 G17 G90 G94\nT1 M6\nS3000 M3\nG0 X0 Y0\nZ20\nG1 Z-4 F300\nX60 F900\nG0 Z20\nM5\nM2\n";

/// Of a flat end of diameter d: the way and both ends.
double groove_volume(double d) {
  return (60.0 * d + 0.25 * swarf::kPi * d * d) * 4.0;
}

class FlagsJob : public testing::Test {
 protected:
  void SetUp() override { root_ = swarf::test::fresh_folder("flags_job"); }
  void TearDown() override { fs::remove_all(root_); }

  std::string path(const std::string& name) const { return (root_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    write_text(root_ / name, text);
    return path(name);
  }
  ProgramRun run(const std::string& words, const std::string& more = "--no-render") const {
    return run_swarf("run " + words + " " + more + " -o " + path("out"));
  }
  json metrics() const { return json::parse(std::ifstream(root_ / "out" / "metrics.json")); }
  double removed() const { return at_path(metrics(), "stock.volume_removed_mm3").get<double>(); }
  std::string assumed(const std::string& what) const {
    const json all = metrics();
    for (const json& one : all.at("assumptions")) {
      if (one.at("what") == what) return one.at("value").get<std::string>();
    }
    return "";
  }
  void expect_refused(const ProgramRun& run, const std::string& code, const std::string& words) const {
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_NE(run.output.find("[" + code + "]"), std::string::npos) << code << "\n" << run.output;
    EXPECT_NE(run.output.find(words), std::string::npos) << words << "\n" << run.output;
    EXPECT_FALSE(fs::exists(root_ / "out"));
  }

  fs::path root_;
};

TEST_F(FlagsJob, OneToolIsAllThatAProgramNeeds) {
  const ProgramRun done = run(write("part.nc", kGroove) + " --tool 10");
  ASSERT_EQ(done.exit_code, 0) << done.output;
  EXPECT_NEAR(removed(), groove_volume(10.0), 1e-3 * groove_volume(10.0));
  EXPECT_EQ(done.output.find("assumed"), 0U) << done.output;
  EXPECT_EQ(assumed("Machine"), "three-axis vertical mill");
  EXPECT_EQ(assumed("Stock"), "X -7.000 to 67.000, Y -7.000 to 7.000, Z -6.000 to 0.000 mm");
  EXPECT_EQ(assumed("Voxel"), "0.5 mm");
  EXPECT_EQ(assumed("Tool length"), "positions are those of the tip");
  EXPECT_NE(assumed("T1").find("D 10 mm"), std::string::npos);
  EXPECT_FALSE(assumed("Clamping").empty());
  EXPECT_FALSE(assumed("Design").empty());
  const std::string verdict = at_path(metrics(), "verdict_text").get<std::string>();
  EXPECT_NE(verdict.find("collisions (the tools have neither shank nor holder)"), std::string::npos)
      << verdict;
}

TEST_F(FlagsJob, ThePageAndThePictureAreThereAndTheFolderStandsAlone) {
  const std::string program = write("part.nc", kGroove);
  const ProgramRun done = run(program + " --tool 10", "--set stills.size=[160,120]");
  ASSERT_EQ(done.exit_code, 0) << done.output;
  EXPECT_TRUE(fs::exists(root_ / "out" / "still_part.png"));
  EXPECT_FALSE(fs::exists(root_ / "out" / "movie.mp4"));
  EXPECT_FALSE(fs::exists(root_ / "out" / "still_machine.png"));
  EXPECT_NE(read_text(root_ / "out" / "report.html").find("What was assumed"), std::string::npos);
  fs::remove(program);
  const ProgramRun again = run_swarf("render " + path("out") + " --still " + path("again.png"));
  EXPECT_EQ(again.exit_code, 0) << again.output;
  EXPECT_TRUE(fs::exists(root_ / "again.png"));
}

TEST_F(FlagsJob, WhatIsSaidIsNotAssumed) {
  const ProgramRun done =
      run(write("part.nc", kGroove) +
          " --tools T1=10 --stock=-10,-20,-15,30,20,0 --voxel 0.4 --machine mill_3axis --origin=-10,0,150");
  ASSERT_EQ(done.exit_code, 0) << done.output;
  const double half = (30.0 * 10.0 + 0.125 * swarf::kPi * 100.0) * 4.0;
  EXPECT_NEAR(removed(), half, 2e-3 * half);
  EXPECT_TRUE(assumed("Machine").empty() && assumed("Stock").empty() && assumed("Voxel").empty());
  EXPECT_TRUE(assumed("Clamping").empty());
  EXPECT_EQ(at_path(metrics(), "stock.voxel_mm"), 0.4);
}

TEST_F(FlagsJob, ACalledLengthIsTaken) {
  std::string program = kGroove;
  program.replace(program.find("S3000"), 5, "G43 H1\nS3000");
  ASSERT_EQ(run(write("part.nc", program) + " --tool 10").exit_code, 0);
  EXPECT_NEAR(removed(), groove_volume(10.0), 1e-3 * groove_volume(10.0));
  EXPECT_TRUE(assumed("Tool length").empty());
}

TEST_F(FlagsJob, InchesAndArcs) {
  // A full circle of radius 1 in by a tool of half an inch, 0.1 in deep.
  const std::string program = write("part.nc",
                                    "G20 G17 G90 G94\nT3 M6\nS3000 M3\nG0 X1 Y0\nZ1\nG1 Z-0.1 F10\n"
                                    "G3 X1 Y0 I-1 J0 F30\nG0 Z1\nM2\n");
  const ProgramRun done = run(program + " --tool 0.5in");
  ASSERT_EQ(done.exit_code, 0) << done.output;
  const double ring = swarf::kPi * (1.25 * 1.25 - 0.75 * 0.75) * 0.1 * 25.4 * 25.4 * 25.4;
  EXPECT_NEAR(removed(), ring, 3e-3 * ring);
  EXPECT_EQ(assumed("Stock"), "X -33.750 to 33.750, Y -33.750 to 33.750, Z -4.540 to 0.000 mm");
}

TEST_F(FlagsJob, AProgramWithoutAToolTakesTheOnlyOne) {
  const ProgramRun done =
      run(write("part.nc", "G21 G90 G94\nS3000 M3\nG0 X0 Y0 Z20\nG1 Z-4 F300\nX60 F900\nG0 Z20\nM2\n") +
          " --tool 6");
  ASSERT_EQ(done.exit_code, 0) << done.output;
  EXPECT_NEAR(removed(), groove_volume(6.0), 2e-3 * groove_volume(6.0));
  EXPECT_FALSE(assumed("Tool at start").empty());
}

TEST_F(FlagsJob, ClData) {
  const ProgramRun done = run(write("part.cls",
                                    "UNITS/MM\nLOADTL/7\nSPINDL/3000,CLW\nFROM/0,0,20\nRAPID\nGOTO/0,0,5\n"
                                    "FEDRAT/300\nGOTO/0,0,-4\nGOTO/60,0,-4\nRAPID\nGOTO/60,0,20\nFINI\n") +
                              " --tool 10");
  ASSERT_EQ(done.exit_code, 0) << done.output;
  EXPECT_NEAR(removed(), groove_volume(10.0), 1e-3 * groove_volume(10.0));
  EXPECT_EQ(assumed("Stock"), "X -7.000 to 67.000, Y -7.000 to 7.000, Z -6.000 to 0.000 mm");
}

TEST_F(FlagsJob, ADesignIsMeasured) {
  // A block whose upper face lies 4 mm below zero, 60 long and as wide as the groove.
  write(
      "part.stl",
      "solid b\n"
      "facet normal 0 0 1\nouter loop\nvertex 0 -4 -4\nvertex 60 -4 -4\nvertex 60 4 -4\nendloop\nendfacet\n"
      "facet normal 0 0 1\nouter loop\nvertex 0 -4 -4\nvertex 60 4 -4\nvertex 0 4 -4\nendloop\nendfacet\n"
      "facet normal 0 0 -1\nouter loop\nvertex 0 -4 -6\nvertex 60 4 -6\nvertex 60 -4 -6\nendloop\nendfacet\n"
      "facet normal 0 0 -1\nouter loop\nvertex 0 -4 -6\nvertex 0 4 -6\nvertex 60 4 -6\nendloop\nendfacet\n"
      "facet normal 0 -1 0\nouter loop\nvertex 0 -4 -6\nvertex 60 -4 -6\nvertex 60 -4 -4\nendloop\nendfacet\n"
      "facet normal 0 -1 0\nouter loop\nvertex 0 -4 -6\nvertex 60 -4 -4\nvertex 0 -4 -4\nendloop\nendfacet\n"
      "facet normal 0 1 0\nouter loop\nvertex 0 4 -6\nvertex 60 4 -4\nvertex 60 4 -6\nendloop\nendfacet\n"
      "facet normal 0 1 0\nouter loop\nvertex 0 4 -6\nvertex 0 4 -4\nvertex 60 4 -4\nendloop\nendfacet\n"
      "facet normal -1 0 0\nouter loop\nvertex 0 -4 -6\nvertex 0 -4 -4\nvertex 0 4 -4\nendloop\nendfacet\n"
      "facet normal -1 0 0\nouter loop\nvertex 0 -4 -6\nvertex 0 4 -4\nvertex 0 4 -6\nendloop\nendfacet\n"
      "facet normal 1 0 0\nouter loop\nvertex 60 -4 -6\nvertex 60 4 -4\nvertex 60 -4 -4\nendloop\nendfacet\n"
      "facet normal 1 0 0\nouter loop\nvertex 60 -4 -6\nvertex 60 4 -6\nvertex 60 4 -4\nendloop\nendfacet\n"
      "endsolid b\n");
  const ProgramRun done = run(write("part.nc", kGroove) + " --tool 10 --design " + path("part.stl"));
  ASSERT_EQ(done.exit_code, 0) << done.output;
  EXPECT_NEAR(at_path(metrics(), "surface.gouge_max_um").get<double>(), 0.0, 0.5);
  EXPECT_TRUE(assumed("Design").empty());
}

TEST_F(FlagsJob, RapidsIntoAnAssumedBlockAreNotJudged) {
  // The rapid goes down beside the part, where the block that is laid around the path has material.
  const std::string words =
      write("part.nc", "G21 G90 G94\nT1 M6\nS3000 M3\nG0 X0 Y0\nZ20\nZ-4\nG1 X60 F900\nG0 Z20\nM2\n") +
      " --tool 10";
  const ProgramRun done = run(words);
  EXPECT_EQ(done.exit_code, 0) << done.output;
  EXPECT_NE(done.output.find("the block is assumed around the path and 1 meet it"), std::string::npos)
      << done.output;
  EXPECT_EQ(run(words + " --stock=-10,-10,-10,70,10,0").exit_code, 1);
}

TEST_F(FlagsJob, ASpindleInAnAssumedBlockIsNotJudgedAndTakesNoTime) {
  // 90 mm deep with a tool whose length nobody has said: the spindle would stand in the block.
  const std::string words =
      write("part.nc", "G21 G90 G94\nT1 M6\nS3000 M3\nG0 X0 Y0\nZ100\nG1 Z95 F900\nZ0\nX60\nZ100\nM2\n") +
      " --tool 6";
  const ProgramRun done = run(words);
  EXPECT_EQ(done.exit_code, 0) << done.output;
  bool open = false;
  const json found = metrics();
  for (const json& check : found.at("checks")) {
    if (check.at("name") != "machine_parts") continue;
    open = check.at("outcome") == "not_judged" &&
           check.at("reason").get<std::string>().find("a block that is assumed") != std::string::npos;
  }
  EXPECT_TRUE(open) << done.output;
}

TEST_F(FlagsJob, InitWritesWhatTheFlagsMean) {
  const std::string program = write("part.nc", kGroove);
  ASSERT_EQ(run(program + " --tool 10").exit_code, 0);
  const json by_flags = metrics();
  const ProgramRun written = run_swarf("init " + program + " --tool 10 -o " + path("job"));
  ASSERT_EQ(written.exit_code, 0) << written.output;
  const ProgramRun done = run(path("job/scene.toml"));
  ASSERT_EQ(done.exit_code, 0) << done.output;
  EXPECT_EQ(at_path(metrics(), "stock.hash"), at_path(by_flags, "stock.hash"));
  EXPECT_EQ(at_path(metrics(), "motion.time_s"), at_path(by_flags, "motion.time_s"));
  const ProgramRun again = run_swarf("init " + program + " --tool 10 -o " + path("job"));
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_NE(again.output.find("output-in-the-way"), std::string::npos) << again.output;
}

TEST_F(FlagsJob, InitAloneIsAFirstJob) {
  const ProgramRun written = run_swarf("init --machine head_table_bc -o " + path("first"));
  ASSERT_EQ(written.exit_code, 0) << written.output;
  EXPECT_TRUE(fs::exists(root_ / "first" / "machine" / "machine.toml"));
  const ProgramRun done = run(path("first/scene.toml"));
  EXPECT_EQ(done.exit_code, 0) << done.output;
  EXPECT_GT(removed(), 1000.0);
}

TEST_F(FlagsJob, FiveAxesInSixLines) {
  write("part.nc",
        "G21 G90 G94\nT1 M6\nG43.4 H1\nS9000 M3\nG0 X0 Y0 Z30 B0 C0\nG1 Z-2 F500\nX40 B20 C30 F900\nG0 "
        "Z30\nG49\nM30\n");
  const std::string scene = write("scene.toml",
                                  "nc = \"part.nc\"\ndialect = \"fanuc\"\nmachine = \"head_table_bc\"\n"
                                  "tools = \"T1=ball8\"\nsetup.work_origin_mm = \"on_table\"\n");
  const ProgramRun done = run(scene);
  ASSERT_EQ(done.exit_code, 0) << done.output;
  EXPECT_GT(removed(), 100.0);
}

// ---- what is refused

TEST_F(FlagsJob, StockFlagsAreRead) {
  const std::string program = write("part.nc", kGroove);
  expect_refused(run(program + " --tool 10 --stock 60,20,0,0,-20,-10"), "bad-stock",
                 "--stock 0,-20,-10,60,20,0");
  expect_refused(run(program + " --tool 10 --stock 0,0,-10,40,30"), "bad-stock", "six numbers");
  expect_refused(run(program + " --tool 10 --stock 0,0,-10,40,30,x"), "bad-stock", "six numbers");
  expect_refused(run(program + " --tool 10 --stock 0,0,0,40,30,0"), "bad-stock", "40 x 30 x 0 mm");
}

TEST_F(FlagsJob, ToolsMustBeThoseOfTheProgram) {
  const std::string two = write("two.nc",
                                "G21 G90 G94\nT1 M6\nS3000 M3\nG0 X0 Y0 Z20\nG1 Z-1 F300\nG0 Z20\nT5 M6\n"
                                "S3000 M3\nG1 Z-2\nM2\n");
  expect_refused(run(two + " --tool 6"), "unknown-tool", "T1 (line 2), T5 (line 7)");
  expect_refused(run(two + " --tool 6"), "unknown-tool", "--tools T1=6,T5=..");
  expect_refused(run(two + " --tools T1=6,T2=4"), "unknown-tool", "T5 (line 7)");
  expect_refused(run(two), "missing-key", "--tool 6");
  expect_refused(run(two + " --tools nothing"), "bad-tool-list", "neither a file nor a list");
  expect_refused(run(two + " --tools T1=six,T5=4"), "bad-tool-word", "'T1=six'");
}

TEST_F(FlagsJob, FaultsAreToldAtTheFlagThatHasThem) {
  const std::string program = write("part.nc", kGroove);
  expect_refused(run(program + " --tools T1=6,T1=8"), "tool-twice",
                 "--tools T1=6,T1=8: error: T1 is described twice");
  expect_refused(run(program + " --tool 0"), "bad-tool-word", "--tool 0: error: '0' has a diameter of 0 mm");
  expect_refused(run(program + " --tool 6 --voxel 100"), "out-of-range", "--voxel 100: error:");
  expect_refused(run(program + " --tool 6 --machine mill"), "unknown-machine", "--machine mill: error:");
  write("empty.json", "{\"data\": []}");
  expect_refused(run(program + " --tools " + path("empty.json")), "no-tools", "empty.json: error: the table");
  EXPECT_EQ(run(program + " --tools 1=10").exit_code, 0);
  const ProgramRun checked = run_swarf("check " + program + " --tools T1=10");
  EXPECT_EQ(checked.exit_code, 0);
  EXPECT_NE(checked.output.find("T1 (D 10 mm"), std::string::npos) << checked.output;
  fs::remove_all(root_ / "out");
  expect_refused(run(program + " --tool 6 --origin 1e9,0,0"), "out-of-range", "--origin 1e9,0,0: error:");
}

TEST_F(FlagsJob, ToolsOfIso13399) {
  const std::string table = SWARF_SOURCE_DIR "/tests/data/tools/catalogue.p21";
  const ProgramRun done = run(write("part.nc", kGroove) + " --tools " + table);
  ASSERT_EQ(done.exit_code, 0) << done.output;
  EXPECT_NE(done.output.find("T4: it has neither RE nor SIG: its end is taken as flat"), std::string::npos)
      << done.output;
  fs::remove_all(root_ / "out");
  std::string program = kGroove;
  program.replace(program.find("T1"), 2, "T5");
  expect_refused(run(write("part.nc", program) + " --tools " + table), "unknown-tool",
                 "TM-8: it cuts threads (TP)");
}

TEST_F(FlagsJob, ADesignInInchesIsSuspectedAndRead) {
  // 60 x 20 x 10 mm.
  const double x = 60.0 / 25.4, y = 10.0 / 25.4, z = 10.0 / 25.4;
  std::string mesh;
  for (const double c : {-z, 0.0})
    for (const double b : {-y, y})
      for (const double a : {0.0, x})
        mesh += "v " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
  mesh += "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  write("part.obj", mesh);
  const std::string words =
      write("part.nc", kGroove) + " --tool 10 --stock=-5,-15,-15,65,15,0 --design " + path("part.obj");
  const ProgramRun small = run(words);
  EXPECT_NE(small.output.find("[mesh-unit-suspicious]"), std::string::npos) << small.output;
  EXPECT_NE(small.output.find("--set design.mesh_unit=inch"), std::string::npos) << small.output;
  const ProgramRun right = run(words, "--no-render --set design.mesh_unit=inch");
  EXPECT_EQ(right.output.find("mesh-unit-suspicious"), std::string::npos) << right.output;
  EXPECT_NEAR(at_path(metrics(), "surface.gouge_max_um").get<double>(), 4000.0, 1.0);  // the groove
}

TEST_F(FlagsJob, FiveAxisWordsNeedTheirMachine) {
  const std::string program =
      write("part.nc", "G21 G90 G94\nT1 M6\nS3000 M3\nG0 X0 Y0 Z20 B0 C0\nG1 Z-4 B20 F300\nM2\n");
  const ProgramRun refused = run(program + " --tool 6");
  expect_refused(refused, "machine-needed", "head_table_bc (XYZBC)");
  EXPECT_NE(refused.output.find("part.nc:4:"), std::string::npos) << refused.output;
  const std::string cl =
      write("part.cls",
            "UNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/3000,CLW\nFROM/0,0,20,0,0,1\nFEDRAT/300\n"
            "GOTO/0,0,-4,0,0,1\nGOTO/9,0,-4,0.6,0,0.8\nFINI\n");
  expect_refused(run(cl + " --tool 6"), "machine-needed", "head_table_bc (XYZBC)");
  expect_refused(run(program + " --tool 6 --machine head_tabel_bc"), "unknown-machine",
                 "did you mean 'head_table_bc'?");
}

TEST_F(FlagsJob, FilesThatAreNone) {
  expect_refused(run(root_.string() + " --tool 6"), "file-not-found", "this is a folder");
  expect_refused(run(path("gone.nc") + " --tool 6"), "file-not-found", "an NC program");
  expect_refused(run("--tool 6"), "file-not-found", "CL data");
  expect_refused(run(write("none.nc", "G21 G90\nG0 X0 Y0 Z5\nM2\n") + " --tool 6"), "no-motion", "none.nc");
  write("scene.toml", "nc = \"part.nc\"\n");
  expect_refused(run(path("scene.toml") + " --tool 6"), "flags-and-scene", "--tool");
}

TEST_F(FlagsJob, APathBesideTheStockIsToldWhereItIs) {
  const std::string program = write("part.nc", kGroove);
  const ProgramRun above = run(program + " --tool 10 --stock 0,-20,-40,60,20,-20");
  expect_refused(above, "path-misses-stock", "Z -4.000 to 20.000 mm");
  EXPECT_NE(above.output.find("an offset of X 0.000 Y 0.000 Z -40.000 mm"), std::string::npos)
      << above.output;
  const ProgramRun beside = run(program + " --tool 10 --stock 100,-20,-10,160,20,0");
  EXPECT_NE(beside.output.find("an offset of X 100.000 Y 0.000 Z 0.000 mm"), std::string::npos)
      << beside.output;
}

TEST_F(FlagsJob, ALengthThatIsNotCalledIsToldBeforeThePathMisses) {
  write("part.nc", kGroove);
  const std::string scene = write(
      "scene.toml",
      "nc = \"part.nc\"\nmachine = \"mill_3axis\"\ntools = \"10\"\n[setup]\nwork_origin_mm = [0, 0, 200]\n"
      "[stock]\nbox_mm = [[-10, -20, -20], [70, 20, 0]]\nvoxel_mm = 0.5\n");
  const ProgramRun plunged = run(scene);
  EXPECT_NE(plunged.output.find("length-not-compensated"), std::string::npos) << plunged.output;
  const std::string high =
      write("high.toml", read_text(scene).replace(read_text(scene).find("[-10, -20, -20], [70, 20, 0]"), 28,
                                                  "[-10, -20, -200], [70, 20, -150]"));
  const ProgramRun missed = run(high);
  EXPECT_EQ(missed.exit_code, 2) << missed.output;
  EXPECT_NE(missed.output.find("length-not-compensated"), std::string::npos) << missed.output;
  EXPECT_NE(missed.output.find("path-misses-stock"), std::string::npos) << missed.output;
}

TEST_F(FlagsJob, WhatASceneLacksIsToldAtOnce) {
  const ProgramRun lacks =
      run(write("scene.toml", "title = \"x\"\n[stock]\nvoxel_mm = -1\n[accept]\ntravle = 1\n"));
  EXPECT_EQ(lacks.exit_code, 2);
  for (const char* one :
       {"'machine' is missing", "'program' is missing", "the scene has no tool", "'stock.box_mm' must be",
        "'stock.voxel_mm' is -1", "nothing is called 'accept.travle'"})
    EXPECT_NE(lacks.output.find(one), std::string::npos) << one << "\n" << lacks.output;
}

// ---- the other commands

TEST_F(FlagsJob, CommandsThatAreNearlyRight) {
  const ProgramRun near = run_swarf("runn part.nc");
  EXPECT_EQ(near.exit_code, 2);
  EXPECT_NE(near.output.find("did you mean 'swarf run'?"), std::string::npos) << near.output;
  EXPECT_NE(run_swarf("xyzzy").output.find("init"), std::string::npos);
  const ProgramRun option = run_swarf("run part.nc --toool 6");
  EXPECT_EQ(option.exit_code, 2);
  EXPECT_NE(option.output.find("swarf run --toool: error: there is no such option"), std::string::npos)
      << option.output;
  EXPECT_NE(option.output.find("did you mean '--tool'?"), std::string::npos) << option.output;
  EXPECT_NE(run_swarf("run - --tool 6").output.find("'swarf check -' reads a pipe"), std::string::npos);
}

TEST_F(FlagsJob, EveryCommandTeachesWithAnExample) {
  for (const char* command :
       {"run", "init", "machines", "show", "check", "compare", "render", "export", "plan", "replay"}) {
    const ProgramRun help = run_swarf(std::string(command) + " --help");
    EXPECT_EQ(help.exit_code, 0) << command;
    EXPECT_NE(
        help.output.find("swarf " + std::string(command == std::string("machines") ? "run" : command) + " "),
        std::string::npos)
        << help.output;
  }
}

TEST_F(FlagsJob, MachinesAreListed) {
  const ProgramRun list = run_swarf("machines");
  EXPECT_EQ(list.exit_code, 0);
  EXPECT_NE(list.output.find("mill_3axis       three-axis vertical mill (3 axes)"), std::string::npos)
      << list.output;
  EXPECT_NE(list.output.find("X -380 to 380 mm, Y -205 to 205 mm, Z 100 to 610 mm"), std::string::npos);
  EXPECT_NE(list.output.find("(5 axes, head tilts, table turns)"), std::string::npos) << list.output;
}

/// Width and height from the header of a PNG.
std::pair<int, int> png_size(const fs::path& file) {
  const std::string bytes = read_text(file);
  const auto big_endian = [&](size_t at) {
    int value = 0;
    for (size_t i = 0; i < 4; ++i) value = value * 256 + static_cast<unsigned char>(bytes.at(at + i));
    return value;
  };
  return {big_endian(16), big_endian(20)};
}

TEST_F(FlagsJob, MachinesAndProgramsAreShown) {
  const ProgramRun machine = run_swarf("show lin_koren_xyzab -o " + path("machine.png"));
  ASSERT_EQ(machine.exit_code, 0) << machine.output;
  EXPECT_EQ(png_size(root_ / "machine.png"), std::pair(1600, 720));
  const ProgramRun part =
      run_swarf("show " + write("part.nc", kGroove) + " --tool 10 -o " + path("part.png"));
  ASSERT_EQ(part.exit_code, 0) << part.output;
  EXPECT_EQ(png_size(root_ / "part.png"), std::pair(1600, 720));
}

}  // namespace
}  // namespace flags_job_test
