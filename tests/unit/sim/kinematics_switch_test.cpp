// The scene's keys for LinuxCNC's M428, M429 and M430, for the words of the machine's builder, and for what
// stands in the control at the start.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "sim/job/scene.h"
#include "support/program_run.h"

namespace swarf::sim {
namespace {

namespace fs = std::filesystem;
using program::Kinematics;

struct Loaded {
  Scene scene;
  std::string errors;  ///< their codes
};

Loaded load(const std::string& program) {
  const fs::path folder = test::fresh_folder("kinematics_switch");
  test::write_text(folder / "scene.toml",
                   "machine = \"m.toml\"\n" + program +
                       "[stock]\nbox_mm = [[0, 0, 0], [1, 1, 1]]\nvoxel_mm = 0.5\n"
                       "[design]\nkind = \"none\"\n"
                       "[cutter]\ndiameter_mm = 10\nflute_length_mm = 25\nlength_mm = 60\n");
  Diagnostics diagnostics;
  Loaded loaded;
  loaded.scene = load_scene((folder / "scene.toml").string(), {}, diagnostics);
  for (const Diagnostic& one : diagnostics.list()) {
    if (one.severity == Severity::kError) loaded.errors += one.code + " " + one.text + "\n";
  }
  fs::remove_all(folder);
  return loaded;
}

TEST(KinematicsSwitch, IsReadFromTheScene) {
  const Loaded told = load(
      "nc = \"p.ngc\"\nkinematics_switch = { m428 = \"identity\", m429 = \"tcp\", m430 = \"identity\", start "
      "= \"tcp\" }\n");
  EXPECT_EQ(told.errors, "");
  EXPECT_EQ(told.scene.kinematics_switch.m428, Kinematics::kIdentity);
  EXPECT_EQ(told.scene.kinematics_switch.m429, Kinematics::kTcp);
  EXPECT_EQ(told.scene.kinematics_switch.m430, Kinematics::kIdentity);
  EXPECT_EQ(told.scene.kinematics_switch.start, Kinematics::kTcp);
  const Loaded silent = load("nc = \"p.ngc\"\ndialect = \"linuxcnc\"\n");
  EXPECT_EQ(silent.errors, "");
  EXPECT_FALSE(silent.scene.kinematics_switch.m430);
}

TEST(BuilderWords, AreReadFromTheScene) {
  const Loaded told = load(
      "nc = \"p.nc\"\nbuilder_words = { M68 = \"clamp C\", \"cycl def 392\" = \"tuning\", m046 = \"probe "
      "out\" }\n");
  EXPECT_EQ(told.errors, "");
  EXPECT_EQ(told.scene.builder_words,
            (program::BuilderWords{{"M46", "probe out"}, {"M68", "clamp C"}, {"CYCL DEF 392", "tuning"}}));
  EXPECT_NE(load("nc = \"p.nc\"\nbuilder_words = { \"G68 X\" = \"x\" }\n").errors.find("'G68 X'"),
            std::string::npos);
  EXPECT_NE(load("nc = \"p.nc\"\nbuilder_words = { M68 = 1 }\n").errors, "");
  EXPECT_NE(load("cl = \"p.cl\"\nbuilder_words = { M68 = \"x\" }\n").errors.find("builder_words"),
            std::string::npos);
}

TEST(KinematicsSwitch, WrongWordsAreRefused) {
  EXPECT_NE(load("nc = \"p.ngc\"\nkinematics_switch = { m430 = \"user\" }\n").errors.find("m430"),
            std::string::npos);
  EXPECT_NE(load("nc = \"p.ngc\"\nkinematics_switch = { m431 = \"tcp\" }\n").errors.find("m431"),
            std::string::npos);
  EXPECT_NE(load("nc = \"p.ngc\"\ndialect = \"fanuc\"\nkinematics_switch = { m430 = \"tcp\" }\n")
                .errors.find("kinematics_switch"),
            std::string::npos);
}

/// What stands in the control before the first block.
TEST(StartKeys, AreReadFromSetup) {
  const Loaded told =
      load("nc = \"p.nc\"\n[setup]\nunits = \"inch\"\nstart_tool = 7\nt_changes_tool = true\n");
  EXPECT_EQ(told.errors, "");
  EXPECT_EQ(told.scene.setup.unit_mm, 25.4);
  EXPECT_EQ(told.scene.setup.start_tool, 7);
  EXPECT_TRUE(told.scene.setup.t_changes_tool);
  EXPECT_EQ(load("nc = \"p.nc\"\n[setup]\nstart_tool_name = \"END8\"\n").scene.setup.start_tool_name, "END8");
  const Loaded silent = load("nc = \"p.nc\"\n");
  EXPECT_EQ(silent.errors, "");
  EXPECT_FALSE(silent.scene.setup.unit_mm);
  EXPECT_EQ(silent.scene.setup.start_tool, 0);
  EXPECT_NE(load("nc = \"p.nc\"\n[setup]\nunits = \"feet\"\n").errors.find("unknown-choice"),
            std::string::npos);
  EXPECT_NE(load("nc = \"p.nc\"\n[setup]\nstart_tool = 0\n").errors.find("out-of-range"), std::string::npos);
}

}  // namespace
}  // namespace swarf::sim
