// swarf batch: many runs into one table; finished ones are not run again unless something about them changed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "support/program_run.h"

namespace batch_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using swarf::test::read_text;
using swarf::test::run_swarf;
using swarf::test::write_text;

/// A slot along X at the depth, D6.
std::string slot(double depth_mm) {
  return fmt::format("G21 G17 G90 G94\nT1 M6\nS8000 M3\nG0 X5 Y10\nZ2\nG1 Z{} F300\nX25\nG0 Z20\nM5\nM2\n",
                     -depth_mm);
}

constexpr const char* kArguments =
    "arguments = [\"--no-render\", \"--tool\", \"6\", \"--stock\", \"0,0,-10,30,20,0\", \"--voxel\", "
    "\"0.5\"]\n";

class Batch : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = swarf::test::fresh_folder("batch");
    fs::create_directories(folder_ / "posts");
    for (const int depth : {1, 2, 3})
      write_text(folder_ / fmt::format("posts/slot_{}.nc", depth), slot(depth));
    write_text(at("jobs.toml"), std::string(kArguments) + "[[job]]\nfile = \"posts/*.nc\"\n");
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string at(const std::string& name) const { return (folder_ / name).string(); }
  swarf::test::ProgramRun batch(const std::string& more = "") const {
    return run_swarf(fmt::format("batch {} -o {} {}", at("jobs.toml"), at("night"), more));
  }
  json table() const { return json::parse(read_text(at("night/batch.json"))); }
  /// The time at which a job's results were made.
  auto made(const std::string& job) const {
    return fs::last_write_time(at("night/" + job + "/metrics.json"));
  }

  fs::path folder_;
};

TEST_F(Batch, EveryFileOfAPatternIsAJobOfItsOwn) {
  const auto run = batch("--junit " + at("night.xml"));
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_NE(run.output.find("PASS: 3 of 3 jobs pass"), std::string::npos) << run.output;
  const json found = table();
  ASSERT_EQ(found["jobs"].size(), 3U);
  for (int depth = 1; depth <= 3; ++depth) {
    const json& job = found["jobs"][static_cast<size_t>(depth - 1)];
    EXPECT_EQ(job["name"], fmt::format("slot_{}", depth));
    EXPECT_EQ(job["exit_code"], 0);
    EXPECT_GT(job["machine_time_s"].get<double>(), 4.0);  // 20 mm at 300 mm/min
    const json metrics = json::parse(read_text(at(fmt::format("night/slot_{}/metrics.json", depth))));
    // A slot of length 20 with round ends: (20 * 6 + 9 pi) * depth.
    EXPECT_NEAR(metrics["stock"]["volume_removed_mm3"].get<double>(), 148.274 * depth, 1.0 * depth);
    EXPECT_EQ(job["verdict"], metrics["verdict_text"]);
  }
  const std::string page = read_text(at("night/batch.html"));
  EXPECT_NE(page.find("3 of 3 jobs pass"), std::string::npos);
  EXPECT_NE(page.find("href=\"slot_2/metrics.json\""), std::string::npos);
  const std::string junit = read_text(at("night.xml"));
  for (const char* name : {"slot_1.nc", "slot_2.nc", "slot_3.nc"})
    EXPECT_NE(junit.find(std::string(name) + "\" tests="), std::string::npos) << junit;
}

TEST_F(Batch, WhatIsFinishedIsNotRunAgainUntilItChanges) {
  ASSERT_EQ(batch().exit_code, 0);
  const auto first = made("slot_1"), second = made("slot_2");
  const auto again = batch();
  EXPECT_NE(again.output.find("3 jobs, 0 to run"), std::string::npos) << again.output;
  EXPECT_EQ(made("slot_1"), first);

  write_text(at("posts/slot_2.nc"), slot(4));
  const auto changed = run_swarf(fmt::format("-v batch {} -o {}", at("jobs.toml"), at("night")));
  EXPECT_NE(changed.output.find("3 jobs, 1 to run"), std::string::npos) << changed.output;
  EXPECT_NE(changed.output.find("slot_2.nc has changed"), std::string::npos) << changed.output;
  EXPECT_EQ(made("slot_1"), first);
  EXPECT_GT(made("slot_2"), second);

  EXPECT_NE(batch("--at-once 2").output.find("3 jobs, 0 to run"), std::string::npos);
  EXPECT_NE(batch("--again").output.find("3 jobs, 3 to run"), std::string::npos);
}

TEST_F(Batch, AJobThatFailsStopsNoOther) {
  write_text(at("posts/slot_2.nc"), "G21 G17 G90 G94\nT1 M6\nS8000 M3\nG1 X10 F300\nG1 QQ7\nM2\n");
  write_text(at("posts/slot_3.nc"),
             "G21 G17 G90 G94\nT1 M6\nS8000 M3\nG0 X5 Y10\nZ2\nG1 Z-2 F300\nG0 X25\nZ20\nM5\nM2\n");
  const auto run = batch("--junit " + at("night.xml"));
  EXPECT_EQ(run.exit_code, 2) << run.output;
  const json found = table()["jobs"];
  EXPECT_EQ(found[0]["exit_code"], 0);
  EXPECT_EQ(found[1]["exit_code"], 2);
  EXPECT_NE(found[1]["verdict"].get<std::string>().find("slot_2.nc:5:"), std::string::npos) << found[1];
  EXPECT_TRUE(found[1]["findings"].is_null()) << "not judged is not zero";
  EXPECT_EQ(found[2]["exit_code"], 1);  // rapids in material
  EXPECT_GT(found[2]["findings"].get<int>(), 0);
  EXPECT_NE(read_text(at("night.xml")).find("<failure"), std::string::npos);
  EXPECT_EQ(batch("--summary").exit_code, 2) << "refused is not the same as not run";
  EXPECT_EQ(table()["jobs"][1]["outcome"], "WRONG INPUT");
  // What has failed is tried again, what has findings is known.
  EXPECT_NE(batch().output.find("3 jobs, 1 to run"), std::string::npos);
}

TEST_F(Batch, TasksOfAnArrayAndATableAtTheEnd) {
  EXPECT_EQ(batch("--only 2").exit_code, 0);
  EXPECT_EQ(batch("--only slot_3").exit_code, 0);
  const auto early = batch("--summary --json");
  EXPECT_EQ(early.exit_code, 130) << "a job that has not been run is no pass";
  EXPECT_TRUE(table()["jobs"][0]["exit_code"].is_null());
  EXPECT_EQ(table()["jobs"][0]["outcome"], "NOT RUN");
  EXPECT_EQ(batch("--only 1").exit_code, 0);
  EXPECT_EQ(batch("--summary").exit_code, 0);
  const auto beyond = batch("--only 4");
  EXPECT_EQ(beyond.exit_code, 2);
  EXPECT_NE(beyond.output.find("[no-job]"), std::string::npos) << beyond.output;
}

TEST_F(Batch, CtrlCKeepsWhatIsFinished) {
  // Long enough to be stopped in: a program of many moves.
  std::string longer = "G21 G17 G90 G94\nT1 M6\nS8000 M3\nG0 X5 Y10\nZ2\nG1 Z-1 F300\n";
  for (int i = 0; i < 200000; ++i) longer += fmt::format("X{} Y{}\n", 5 + (i * 7) % 20, 5 + (i * 11) % 10);
  write_text(at("posts/slot_2.nc"), longer + "G0 Z20\nM2\n");
  const auto run = swarf::test::run_command(fmt::format(
      "{} batch {} -o {} & p=$!; while [ ! -e {} ]; do sleep .05; done; sleep .3; kill -INT $p; wait $p",
      SWARF_PROGRAM, at("jobs.toml"), at("night"), at("night/slot_2.log")));
  EXPECT_EQ(run.exit_code, 130) << run.output;
  const json found = table()["jobs"];
  EXPECT_EQ(found[0]["outcome"], "PASS");
  EXPECT_EQ(found[1]["outcome"], "STOPPED");
  EXPECT_EQ(found[2]["outcome"], "NOT RUN");
  EXPECT_NE(run.output.find("go on with: swarf batch"), std::string::npos) << run.output;
}

TEST_F(Batch, WrongFilesAreToldBeforeAnythingRuns) {
  const auto refused = [&](const std::string& text, const std::string& code) {
    write_text(at("jobs.toml"), text);
    const auto run = batch();
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_NE(run.output.find("[" + code + "]"), std::string::npos) << run.output;
    EXPECT_FALSE(fs::exists(at("night"))) << code;
  };
  refused("title = \"nothing\"\n", "no-jobs");
  refused("[[job]]\nfile = \"posts/*.mpf\"\n", "no-match");
  refused("[[job]]\nfile = \"posts/*.nc\"\nname = \"one\"\n", "one-name");
  refused("[[job]]\nfile = \"posts/slot_1.nc\"\n[[job]]\nfile = \"posts/slot_1.nc\"\n", "same-name");
  refused("[[job]]\nfile = \"posts/slot_1.nc\"\nname = \"../up\"\n", "job-name");
  refused("[[job]]\nfile = \"posts/slot_1.nc\"\narguments = [\"-o\", \"there\"]\n", "own-option");
  refused("[[job]]\nfile = \"posts/slot_1.nc\"\narguments = [6]\n", "wrong-type");
  refused("[[job]]\nfile = \"posts/slot_1.nc\"\nthreads = 3\n", "unknown-key");
}

/// Stands in for Slurm's: each task at once, one after the other. The script was tried with Debian's
/// slurm-wlm too.
constexpr const char* kSbatch = R"(#!/bin/sh
tasks=1 out=/dev/null
while [ $# -gt 0 ]; do
  case $1 in
    --array=1-*) tasks=${1#--array=1-} ;;
    --output=*) out=${1#--output=} ;;
    --wrap) shift; wrap=$1 ;;
  esac
  shift
done
for i in $(seq "$tasks"); do SLURM_ARRAY_TASK_ID=$i sh -c "$wrap" >>"$out" 2>&1; done
echo "exit $? of $tasks" >>"$(dirname "$0")/submitted"
echo 7
)";

TEST_F(Batch, AClusterRunsEachJobAsATaskAndMakesTheTable) {
  fs::create_directories(folder_ / "bin");
  write_text(at("bin/sbatch"), kSbatch);
  fs::permissions(at("bin/sbatch"), fs::perms::owner_all);
  const std::string script = std::string(SWARF_SOURCE_DIR) + "/assets/cluster/batch_array.sh ";
  const std::string environment = fmt::format("PATH={}:$PATH SWARF={} ", at("bin"), SWARF_PROGRAM);
  const auto run =
      swarf::test::run_command(environment + script + at("jobs.toml") + " " + at("night") + " --time=10");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_EQ(run.output, "array 7, table 7\n");
  EXPECT_EQ(read_text(at("bin/submitted")), "exit 0 of 3\nexit 0 of 1\n");
  const json found = table();
  ASSERT_EQ(found["jobs"].size(), 3U);
  for (const json& job : found["jobs"]) EXPECT_EQ(job["exit_code"], 0) << job;
  EXPECT_TRUE(fs::exists(at("night/batch.xml")));
  const auto wrong = swarf::test::run_command(environment + script + at("none.toml") + " " + at("other"));
  EXPECT_EQ(wrong.exit_code, 2) << wrong.output;
  EXPECT_NE(wrong.output.find("file-not-found"), std::string::npos) << wrong.output;
}

}  // namespace
}  // namespace batch_test
