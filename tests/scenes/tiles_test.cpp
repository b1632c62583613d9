// swarf run --tiles: ranks of mpirun cut one part together, and what comes out is what one process leaves.
// SWARF_KILLS: at how many random moments a rank is killed (default 3); SWARF_KILL_BLOCKS: blocks of the
// program.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/rng.h"
#include "support/program_run.h"

namespace tiles_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using swarf::Rng;
using swarf::test::read_text;
using swarf::test::run_command;
using swarf::test::run_swarf;
using Clock = std::chrono::steady_clock;

long number_from(const char* name, long otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::atol(text) : otherwise;
}

/// As many processes as that, whatever the machine has; CI runs as root.
std::string mpirun(int ranks) {
  return fmt::format(
      "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpirun --oversubscribe --bind-to none -n {} "
      "{} ",
      ranks, SWARF_PROGRAM);
}

/// Everything but times, memory and the command that was given.
json facts(const fs::path& folder) {
  const json all = json::parse(read_text(folder / "metrics.json")).flatten();
  json kept;
  for (const auto& [path, value] : all.items()) {
    const bool measured = path.ends_with("_s") || path.find("seconds") != std::string::npos ||
                          path.find("memory") != std::string::npos || path.find("_ns") != std::string::npos ||
                          path.find("threads") != std::string::npos ||
                          path.find("command") != std::string::npos ||
                          path.find("per_s") != std::string::npos;
    if (!measured) kept[path] = value;
  }
  return kept;
}

class Tiles : public testing::Test {
 protected:
  void SetUp() override {
    if (run_command("command -v mpirun").exit_code != 0)
      GTEST_SKIP() << "mpirun is not installed (openmpi-bin of packages.txt)";
    if (!fs::exists(fs::path(SWARF_PROGRAM).parent_path() / "swarf_mpi.so"))
      GTEST_SKIP() << "built where Open MPI is missing (libopenmpi-dev of packages.txt)";
    folder_ = swarf::test::fresh_folder("tiles");
  }
  void TearDown() override {
    if (!HasFailure()) fs::remove_all(folder_);
  }
  void write_wave(long blocks, double voxel_mm) const {
    const auto written = run_command(fmt::format("/usr/bin/python3 '{}/tests/bench/wave.py' {} '{}' {}",
                                                 SWARF_SOURCE_DIR, blocks, folder_.string(), voxel_mm));
    ASSERT_EQ(written.exit_code, 0) << written.output;
  }
  std::string wave() const { return at("scene.toml") + " --no-render "; }
  std::string at(const std::string& name) const { return (folder_ / name).string(); }

  /// The same job alone and by several ranks: equal numbers, findings and blocks.
  void expect_same(const std::string& job, const std::vector<int>& counts) const {
    const auto alone = run_swarf("run " + job + " -o " + at("alone"));
    ASSERT_LE(alone.exit_code, 1) << alone.output;
    for (const int count : counts) {
      SCOPED_TRACE(fmt::format("{} ranks: {}", count, job));
      const auto run = run_command(mpirun(count) + "run --tiles " + job + " -o " + at("tiles"));
      ASSERT_EQ(run.exit_code, alone.exit_code) << run.output;
      const json before = facts(at("alone")), now = facts(at("tiles"));
      EXPECT_EQ(now, before) << json::diff(before, now).dump(1);
      for (const char* file : {"findings.json", "blocks.csv"})
        EXPECT_EQ(read_text(at(std::string("tiles/") + file)), read_text(at(std::string("alone/") + file)))
            << file;
    }
  }

  fs::path folder_;
};

TEST_F(Tiles, AnyNumberOfRanksLeavesWhatOneProcessLeaves) {
  write_wave(6000, 0.4);
  expect_same(wave(), {1, 2, 4, 8});
}

/// Flutes too short: shank and stock meet in every row, and each such sweep is judged against the whole
/// stock.
TEST_F(Tiles, ContactsOfTheToolAreThoseOfOneProcess) {
  write_wave(1500, 0.4);
  expect_same(wave() + "--set cutter.flute_length_mm=1", {3});
}

/// A design: its measuring rays are shared out too.
TEST_F(Tiles, RaysAreThoseOfOneProcess) {
  expect_same(
      std::string(SWARF_SOURCE_DIR) + "/scenes/nc_pocket/scene.toml --no-render" + swarf::test::kSoonProven,
      {2});
}

TEST_F(Tiles, GoesOnFromAStockThatAnyOtherRunHasLeft) {
  write_wave(4000, 0.4);
  const auto whole = run_swarf("run " + wave() + " --save-stock-after 699 -o " + at("alone"));
  ASSERT_EQ(whole.exit_code, 0) << whole.output;
  const std::string saved = at("alone/stock_after_line_699.vdb");
  const auto run =
      run_command(mpirun(3) + "run --tiles " + wave() + " --from " + saved + " -o " + at("tiles"));
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_EQ(facts(at("tiles"))["/stock/hash"], facts(at("alone"))["/stock/hash"]);
}

TEST_F(Tiles, WhatIsWrongIsSaidOnce) {
  const auto run = run_command(mpirun(3) + "run --tiles " + at("nothing.toml"));
  EXPECT_EQ(run.exit_code, 2) << run.output;
  EXPECT_EQ(run.output.find("file-not-found"), run.output.rfind("file-not-found")) << run.output;
  write_wave(500, 0.4);
  const auto other = run_command(mpirun(1) + "run --tiles " + wave() + "-o " + at("tiles") + " : -n 1 " +
                                 SWARF_PROGRAM + " run --tiles " + wave() + "--set stock.voxel_mm=0.5");
  EXPECT_EQ(other.exit_code, 2) << other.output;
  EXPECT_NE(other.output.find(
                "rank 1: error: this rank has another stock.voxel_mm: 0.5; rank 0 has 0.4 [rank-differs]"),
            std::string::npos)
      << other.output;
  EXPECT_FALSE(fs::exists(at("tiles")));
}

TEST_F(Tiles, WhatTheRanksCannotAgreeOnIsRefused) {
  const std::string scenes = std::string(SWARF_SOURCE_DIR) + "/scenes/";
  for (const auto& [job, what] :
       std::vector<std::pair<std::string, std::string>>{{scenes + "two_setups/scene.toml", "[[setup]]"},
                                                        {scenes + "kruth_cylinder/inclined.toml", "[post]"},
                                                        {"- < /dev/null", "-"}}) {
    const auto run = run_command(mpirun(2) + "run --tiles -o " + at("tiles") + " " + job);
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_NE(run.output.find(what + ": error: this is for a run of one process"), std::string::npos)
        << run.output;
    EXPECT_EQ(run.output.find("not-in-tiles"), run.output.rfind("not-in-tiles")) << run.output;
    EXPECT_FALSE(fs::exists(at("tiles")));
  }
}

TEST_F(Tiles, WithoutMpirunTheProgramSaysHowToStart) {
  const auto run = run_swarf("run --tiles " + at("scene.toml"));
  EXPECT_EQ(run.exit_code, 2) << run.output;
  EXPECT_NE(run.output.find("mpirun -n 4 swarf run SCENE --tiles"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("[no-mpirun]"), std::string::npos) << run.output;
}

/// Built without MPI there is no module beside the program; all else is as it is.
TEST(TilesWithoutMpi, TheProgramSaysWhatToInstall) {
  const fs::path folder = swarf::test::fresh_folder("tiles_without_mpi");
  const std::string program = (folder / "swarf").string();
  fs::copy_file(SWARF_PROGRAM, program);
  EXPECT_EQ(run_command(program + " --version").exit_code, 0);
  const auto run = run_command(program + " run --tiles scene.toml");
  EXPECT_EQ(run.exit_code, 2) << run.output;
  EXPECT_NE(run.output.find("install libopenmpi-dev and openmpi-bin"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("[no-mpi]"), std::string::npos) << run.output;
  fs::remove_all(folder);
}

/// At random moments one of the ranks is killed, rank 0 as often as the others: mpirun says which and ends
/// the rest, and the run goes on from what the tiles were when they were kept last.
TEST_F(Tiles, ARunWhoseRankDiesGoesOn) {
  constexpr int kRanks = 3;
  write_wave(number_from("SWARF_KILL_BLOCKS", 8000), 0.2);
  const auto start = Clock::now();
  ASSERT_EQ(run_command(mpirun(kRanks) + "run --tiles " + wave() + "-o " + at("whole")).exit_code, 0);
  const double whole_s = std::chrono::duration<double>(Clock::now() - start).count();
  const auto hash = facts(at("whole"))["/stock/hash"];
  const long count = number_from("SWARF_KILLS", 3);
  Rng rng(300);
  int kept = 0, told = 0;
  for (long i = 0; i < count && !HasFailure(); ++i) {
    const double after =
        (static_cast<double>(i) + rng.uniform(0.0, 1.0)) / static_cast<double>(count) * whole_s;
    const int victim = static_cast<int>(i % kRanks);
    SCOPED_TRACE(fmt::format("rank {} after {:.3f} of {:.2f} s", victim, after, whole_s));
    // The rank names itself in its environment; the scene's path tells this run from others of the machine.
    const auto run =
        run_command(fmt::format("{}run --tiles {} --keep-every 0.05 -o {} & pid=$!; sleep {:.3f}; for p in "
                                "$(pgrep -f 'run --tiles {}'); do "
                                "tr '\\0' '\\n' < /proc/$p/environ 2>/dev/null | grep -qx "
                                "OMPI_COMM_WORLD_RANK={} && kill -9 $p; done; wait $pid",
                                mpirun(kRanks), wave(), at("out"), after, at("scene.toml"), victim));
    std::string from;
    for (const auto& entry : fs::directory_iterator(folder_))
      if (entry.path().filename().string().starts_with("out.part") &&
          fs::exists(entry.path() / "stock_so_far.vdb"))
        from = (entry.path() / "stock_so_far.vdb").string();
    if (run.exit_code != 0) {
      told += run.output.find(fmt::format("process rank {}", victim)) != std::string::npos ? 1 : 0;
      const auto again = run_command(mpirun(2) + "run --tiles " + wave() +
                                     (from.empty() ? "" : "--from " + from) + " -o " + at("out"));
      ASSERT_EQ(again.exit_code, 0) << run.output << again.output;
      kept += from.empty() ? 0 : 1;
    }
    EXPECT_EQ(facts(at("out"))["/stock/hash"], hash) << run.output;
    for (const auto& entry : fs::directory_iterator(folder_))
      if (entry.path().filename().string().starts_with("out")) fs::remove_all(entry.path());
    fmt::print("{} of {}: rank {} killed after {:.2f} of {:.2f} s, {}\n", i + 1, count, victim, after,
               whole_s,
               run.exit_code == 0 ? "over already"
               : from.empty()     ? "from the start"
                                  : "went on from a stock");
    std::fflush(stdout);
  }
  fmt::print("{} of {} runs went on from a stock; mpirun named the rank in {}\n", kept, count, told);
}

}  // namespace
}  // namespace tiles_test
