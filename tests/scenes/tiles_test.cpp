// swarf run --tiles: ranks of mpirun cut one part together, and what comes out is what one process leaves.
// SWARF_KILLS: at how many random moments a run that is under way is killed (default 3); SWARF_KILL_BLOCKS:
// blocks of the program.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/rng.h"
#include "support/program_run.h"
#include "support/run_facts.h"

namespace tiles_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using swarf::Rng;
using swarf::test::facts;
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
  void write_wave(long blocks, double voxel_mm) const { swarf::test::write_wave(folder_, blocks, voxel_mm); }
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

  /// What a run to "out" has left to go on from; empty: nothing.
  std::string kept_stock() const {
    std::string kept = fs::exists(at("out/stock.vdb")) ? at("out/stock.vdb") : "";
    for (const auto& entry : fs::directory_iterator(folder_))
      for (const char* name : {"stock.vdb", "stock_so_far.vdb"})
        if (entry.path().filename().string().starts_with("out.part") && fs::exists(entry.path() / name))
          kept = (entry.path() / name).string();
    return kept;
  }
  void remove_results() const {
    for (const auto& entry : fs::directory_iterator(folder_))
      if (entry.path().filename().string().starts_with("out")) fs::remove_all(entry.path());
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

/// What lies between the rays is proven by all ranks: bounds, findings and the areas that stay open.
TEST_F(Tiles, TheProofIsThatOfOneProcess) {
  expect_same(std::string(SWARF_SOURCE_DIR) + "/scenes/exact_between_rays/scene.toml --no-render", {2});
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

/// What each rank is expected to take is told, and too much refused before it is taken; rank 0 holds the
/// most.
TEST_F(Tiles, TheMemoryOfEveryRankIsPredicted) {
  write_wave(2000, 0.2);
  const auto refused =
      run_command(mpirun(3) + "run --tiles " + wave() + "--max-memory 100 -o " + at("tiles"));
  EXPECT_EQ(refused.exit_code, 2) << refused.output;
  EXPECT_NE(refused.output.find("out-of-memory"), std::string::npos) << refused.output;
  EXPECT_EQ(refused.output.find("--spill"), std::string::npos) << "which ranks refuse\n" << refused.output;
  EXPECT_FALSE(fs::exists(at("tiles")));
  const size_t told = refused.output.find(", rank 0 ");
  ASSERT_NE(told, std::string::npos) << refused.output;
  int lead = 0, other = 0, limit = 0;
  ASSERT_EQ(
      std::sscanf(refused.output.c_str() + told,
                  ", rank 0 %d MB, each of 2 other ranks %d MB expected; limit %d MB", &lead, &other, &limit),
      3)
      << refused.output;
  EXPECT_EQ(limit, 100);
  const std::string enough = fmt::format("--max-memory {} -o ", std::max(lead, other) + 2);
  EXPECT_EQ(run_command(mpirun(3) + "run --tiles " + wave() + enough + at("tiles")).exit_code, 0);
  const std::string less = fmt::format("--max-memory {} -o ", std::max(lead, other) - 2);
  EXPECT_EQ(run_command(mpirun(3) + "run --tiles " + wave() + less + at("less")).exit_code, 2);
}

TEST_F(Tiles, WhatTheRanksCannotAgreeOnIsRefused) {
  const std::string scenes = std::string(SWARF_SOURCE_DIR) + "/scenes/";
  for (const auto& [job, what] : std::vector<std::pair<std::string, std::string>>{
           {scenes + "nc_pocket/scene.toml --spill --max-memory 500", "--spill"},
           {scenes + "two_setups/scene.toml", "[[setup]]"},
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

/// SIGUSR1 stops all ranks in order; the run goes on where it was. Ctrl-C makes mpirun kill: what was kept
/// last is left. Both end with the stock of a run that nobody stopped.
TEST_F(Tiles, AStoppedRunGoesOn) {
  write_wave(8000, 0.2);
  ASSERT_EQ(run_swarf("run " + wave() + "-o " + at("alone")).exit_code, 0);
  const auto hash = facts(at("alone"))["/stock/hash"];
  for (const char* signal : {"USR1", "INT"}) {
    SCOPED_TRACE(signal);
    // The signal comes when the stock has been kept once: in the middle of the cut.
    const auto run = run_command(fmt::format(
        "{}run --tiles {} --keep-every 0.01 -o {} & pid=$!; while kill -0 $pid 2>/dev/null && ! ls "
        "{}.part*/stock_so_far.vdb >/dev/null 2>&1; do sleep 0.01; done; kill -{} $pid; wait $pid",
        mpirun(2), wave(), at("out"), at("out"), signal));
    EXPECT_NE(run.exit_code, 0) << run.output;
    EXPECT_NE(run.output.find("SIGUSR1 to mpirun stops in order"), std::string::npos) << run.output;
    ASSERT_FALSE(kept_stock().empty()) << run.output;
    if (std::string(signal) == "USR1") {
      EXPECT_NE(run.output.find("go on with: mpirun -n 2"), std::string::npos) << run.output;
    }
    const auto again =
        run_command(mpirun(2) + "run --tiles " + wave() + "--from " + kept_stock() + " -o " + at("again"));
    ASSERT_EQ(again.exit_code, 0) << again.output;
    EXPECT_EQ(facts(at("again"))["/stock/hash"], hash);
    EXPECT_GT(facts(at("again"))["/stock/blocks_resumed"].get<int>(), 0);
    remove_results();
  }
}

/// At random moments a rank is killed, or mpirun, or mpirun gets Ctrl-C: it ends all of them, and the run
/// goes on from what the tiles were when they were kept last. Runs that were over already do not count.
class TilesKilled : public Tiles {
 protected:
  static constexpr int kRanks = 3;
  static constexpr std::array kKills{"rank 0", "Ctrl-C", "rank 1", "mpirun", "rank 2"};

  /// The rank names itself in its environment; the scene's path tells this run from others of the machine.
  std::string ranks() const {
    return fmt::format("$(pgrep -f '^{} run --tiles {}')", SWARF_PROGRAM, at("scene.toml"));
  }
  std::string kill_command(size_t kind) const {
    const std::string what = kKills.at(kind);
    if (what == "Ctrl-C") return "kill -INT $pid";
    if (what == "mpirun") return "kill -9 $pid";
    return fmt::format(
        "for p in {}; do tr '\\0' '\\n' < /proc/$p/environ 2>/dev/null | grep -qx OMPI_COMM_WORLD_RANK={} && "
        "kill -9 $p; done",
        ranks(), what.back());
  }
  /// Exit code of the run; none of its ranks is left.
  int run_and_kill(size_t kind, double after_s) const {
    const auto run = run_command(fmt::format(
        "{}run --tiles {} --keep-every 0.05 -o {} & pid=$!; sleep {:.3f}; {}; wait $pid; code=$?; "
        "for n in $(seq 100); do [ -z \"{}\" ] && break; sleep 0.1; done; [ -z \"{}\" ] || echo "
        "ranks are left; exit $code",
        mpirun(kRanks), wave(), at("out"), after_s, kill_command(kind), ranks(), ranks()));
    EXPECT_EQ(run.output.find("ranks are left"), std::string::npos) << run.output;
    return run.exit_code;
  }
  /// From what is kept, or from the start. True: something was kept.
  bool go_on() const {
    const std::string from = kept_stock();
    const auto again = run_command(mpirun(2) + "run --tiles " + wave() +
                                   (from.empty() ? "" : "--from " + from) + " -o " + at("out"));
    EXPECT_EQ(again.exit_code, 0) << again.output;
    return !from.empty();
  }
};

TEST_F(TilesKilled, ARunGoesOn) {
  write_wave(number_from("SWARF_KILL_BLOCKS", 8000), 0.2);
  const auto start = Clock::now();
  ASSERT_EQ(run_command(mpirun(kRanks) + "run --tiles " + wave() + "-o " + at("whole")).exit_code, 0);
  const double whole_s = std::chrono::duration<double>(Clock::now() - start).count();
  const auto hash = facts(at("whole"))["/stock/hash"];
  const long wanted = number_from("SWARF_KILLS", 3);
  std::map<std::string, std::pair<int, int>> hits;  // killed, of these from a stock
  Rng rng(300);
  long hit = 0, kept = 0;
  for (long tries = 0; hit < wanted && tries < 5 * wanted && !HasFailure(); ++tries) {
    const size_t kind = static_cast<size_t>(tries) % kKills.size();
    const double after_s = rng.uniform(0.0, whole_s);
    SCOPED_TRACE(fmt::format("{} after {:.3f} of {:.2f} s", kKills.at(kind), after_s, whole_s));
    const bool over = run_and_kill(kind, after_s) == 0;
    const bool from_stock = !over && go_on();
    EXPECT_EQ(facts(at("out"))["/stock/hash"], hash);
    remove_results();
    auto& [killed, resumed] = hits[kKills.at(kind)];
    hit += over ? 0 : 1, killed += over ? 0 : 1;
    kept += from_stock ? 1 : 0, resumed += from_stock ? 1 : 0;
    fmt::print("{} of {}: {} killed after {:.2f} of {:.2f} s, {}\n", hit, wanted, kKills.at(kind), after_s,
               whole_s,
               over         ? "over already"
               : from_stock ? "went on from a stock"
                            : "from the start");
    std::fflush(stdout);
  }
  EXPECT_EQ(hit, wanted) << "too many runs were over before they were killed";
  for (const auto& [what, count] : hits)
    fmt::print("{}: {} killed, {} of them went on from a stock\n", what, count.first, count.second);
  fmt::print("{} killed, {} went on from a stock\n", hit, kept);
}

}  // namespace
}  // namespace tiles_test
