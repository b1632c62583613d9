// What is there but is no file: devices without an end and pipes nobody writes to. Every command refuses
// them at once, wherever it takes a file.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>
#include <vector>

#include "mesh/mesh_io.h"
#include "support/program_run.h"
#include "support/solids.h"

namespace special_files_test {
namespace {

namespace fs = std::filesystem;
using swarf::test::write_text;

const std::string kScene = SWARF_SOURCE_DIR "/scenes/exact_slot_flat/scene.toml";
constexpr const char* kLongest = "10";  ///< s: a program that waits is killed and exits with 137

swarf::test::ProgramRun run_or_kill(const std::string& arguments) {
  return swarf::test::run_command(std::string("timeout -s KILL ") + kLongest + " " + SWARF_PROGRAM + " " +
                                  arguments);
}

class SpecialFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = swarf::test::fresh_folder("special_files");
    swarf::mesh::save_mesh(at("good.stl"), swarf::test::block({0, 0, 0}, {10, 10, 10}));
    for (const char* ending : {"", ".stl", ".ply", ".obj", ".vdb", ".toml", ".nc", ".cls", ".record"})
      ASSERT_EQ(mkfifo(at(std::string("pipe") + ending).c_str(), 0600), 0) << ending;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string at(const std::string& name) const { return (folder_ / name).string(); }
  void expect_refused(const std::string& arguments) const {
    const auto run = run_or_kill(arguments + (arguments.starts_with("run") ? " -o " + at("out") : ""));
    EXPECT_EQ(run.exit_code, 2) << "swarf " << arguments << "\n" << run.output;
    EXPECT_NE(run.output.find("[no-regular-file]"), std::string::npos) << "swarf " << arguments << "\n"
                                                                       << run.output;
  }

  fs::path folder_;
};

TEST_F(SpecialFiles, AreRefusedAtOnceByEveryCommand) {
  const std::string good = " " + at("good.stl");
  for (const std::string& file :
       std::vector<std::string>{"/dev/zero", at("pipe"), at("pipe.toml"), at("pipe.nc"), at("pipe.cls")}) {
    expect_refused("run " + file);
    expect_refused("check " + file);
    expect_refused("plan " + file + " -o " + at("plan.nc"));
    expect_refused(fmt::format("compare{} {}", good, file));
  }
  for (const std::string& file :
       std::vector<std::string>{"/dev/zero", at("pipe.stl"), at("pipe.ply"), at("pipe.obj"), at("pipe.vdb")})
    expect_refused(fmt::format("compare {}{}", file, good));
  for (const std::string& file : std::vector<std::string>{at("pipe.stl"), at("pipe.ply"), at("pipe.obj")})
    expect_refused(fmt::format("compare{} {}", good, file));
  expect_refused("run " + kScene + " --no-render --from " + at("pipe.vdb"));
  expect_refused("replay " + at("pipe.record"));
}

TEST_F(SpecialFiles, AreRefusedWhereASceneNamesThem) {
  for (const char* machine : {"/dev/zero", "pipe.toml"}) {
    std::string scene = swarf::test::read_text(kScene);
    const size_t from = scene.find("machine = \"") + 11;
    scene.replace(from, scene.find('"', from) - from, machine);
    write_text(folder_ / "scene.toml", scene);
    expect_refused("run " + at("scene.toml") + " --no-render");
    expect_refused("check " + at("scene.toml"));
  }
}

TEST_F(SpecialFiles, AFolderIsRefusedAsWell) {
  for (const std::string& command : std::vector<std::string>{
           "run " + folder_.string(), "check " + folder_.string(),
           "plan " + folder_.string() + " -o " + at("plan.nc"), "replay " + folder_.string(),
           "compare " + folder_.string() + " " + at("good.stl"),
           "compare " + at("good.stl") + " " + folder_.string()}) {
    const auto run = run_or_kill(command);
    EXPECT_EQ(run.exit_code, 2) << "swarf " << command << "\n" << run.output;
    EXPECT_NE(run.output.find("fix: "), std::string::npos) << run.output;
  }
}

}  // namespace

}  // namespace special_files_test
