// Every program of the project as it is, without a flag: read, or refused for the reason that stands here.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "support/program_run.h"

namespace programs_as_they_are_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// What a machinist has to say, for the text does not: which machine turns, how the writer's arcs run.
const std::map<std::string, std::string> kRefused = {
    {"assets/programs/spinner_u5/axis_cross.mpf", "axis-missing"},
    {"assets/programs/spinner_u5/bottle_opener.mpf", "axis-missing"},
    {"tests/data/programs/nc/heidenhain/good/dome_and_holes.h", "axis-missing"},
    {"scenes/cl_camworks_plate/plate.clt", "circle-sense"},
};

bool is_program(const fs::path& file) {
  static const std::set<std::string> endings = {".nc",  ".ngc", ".h",   ".mpf",      ".spf",
                                                ".cls", ".apt", ".cl",  ".cldata",   ".clt",
                                                ".ncl", ".tap", ".eia", ".aptsource"};
  return fs::is_regular_file(file) && endings.count(file.extension().string()) > 0;
}

/// Those of assets, scenes and tests/data, but those that are wrong on purpose ("bad").
std::set<std::string> programs() {
  std::set<std::string> files;
  const fs::path root = SWARF_SOURCE_DIR;
  for (const char* folder : {"assets/programs", "scenes", "tests/data/programs"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string name = fs::relative(entry.path(), root).string();
      if (is_program(entry.path()) && name.find("/bad/") == std::string::npos) files.insert(name);
    }
  }
  return files;
}

/// Codes of the errors of each file, by `swarf check --json`.
std::map<std::string, std::set<std::string>> errors_of(const std::set<std::string>& files) {
  std::string words = "cd " SWARF_SOURCE_DIR " && " SWARF_PROGRAM " check --json";
  for (const std::string& file : files) words += " '" + file + "'";
  const swarf::test::ProgramRun done = swarf::test::run_command(words);
  std::map<std::string, std::set<std::string>> errors;
  for (const json& file : json::parse(done.output).at("files")) {
    std::set<std::string>& codes = errors[file.at("file").get<std::string>()];
    for (const json& one : file.at("diagnostics"))
      if (one.at("severity") == "error") codes.insert(one.at("code").get<std::string>());
  }
  return errors;
}

TEST(ProgramsAsTheyAre, AreReadOrRefusedForAReason) {
  const std::set<std::string> files = programs();
  ASSERT_GE(files.size(), 76U);
  const auto errors = errors_of(files);
  size_t read = 0;
  for (const std::string& file : files) {
    const auto refused = kRefused.find(file);
    const std::set<std::string> expected =
        refused == kRefused.end() ? std::set<std::string>{} : std::set<std::string>{refused->second};
    EXPECT_EQ(errors.at(file), expected) << file;
    if (errors.at(file).empty()) ++read;
  }
  std::printf("%zu programs: %zu read, %zu refused for a reason\n", files.size(), read, files.size() - read);
}

TEST(ProgramsAsTheyAre, WhatIsRefusedIsReadWithTheFlagThatItsReasonNames) {
  const auto check = [](const std::string& words) {
    return swarf::test::run_command("cd " SWARF_SOURCE_DIR " && " SWARF_PROGRAM " check --no-drive " + words);
  };
  const swarf::test::ProgramRun turned = check("assets/programs/spinner_u5/axis_cross.mpf");
  EXPECT_NE(turned.output.find("--machine NAME; those that turn and come with swarf: fork_head (XYZCA)"),
            std::string::npos)
      << turned.output;
  for (const char* words : {"--machine spinner_u5_620 assets/programs/spinner_u5/axis_cross.mpf",
                            "--machine spinner_u5_620 assets/programs/spinner_u5/bottle_opener.mpf",
                            "--circle clockwise scenes/cl_camworks_plate/plate.clt"}) {
    const swarf::test::ProgramRun done = check(words);
    EXPECT_LE(done.exit_code, 1) << done.output;  // 1: beyond travel, with work offsets of zero
    EXPECT_EQ(done.output.find("axis-missing"), std::string::npos) << done.output;
  }
}

}  // namespace
}  // namespace programs_as_they_are_test
