// The shipped program killed and interrupted at random moments, and gone on with: the stock is that of a run
// that was never stopped. SWARF_KILLS: how often (default 4 each); SWARF_KILL_BLOCKS: blocks of the program.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "base/rng.h"
#include "support/program_run.h"

extern char** environ;

namespace killed_test {
namespace {

namespace fs = std::filesystem;
using swarf::Rng;
using Clock = std::chrono::steady_clock;

long number_from(const char* name, long otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::atol(text) : otherwise;
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The wave of tests/bench/wave.py.
void write_job(const fs::path& folder, long blocks) {
  const long rows = std::max(1L, blocks / 100);
  std::string nc =
      "G21 G90 G17 G94\nG54\nT1 M6\nG43 H1\nS8000 M3\nG0 X0 Y0\nG0 Z10\nG1 Z-0.5 F500\nG1 F2000\n";
  for (long row = 0; row < rows; ++row) {
    const double y = static_cast<double>(row) * 51.0 / static_cast<double>(rows);
    for (int i = 0; i <= 100; ++i) {
      const double x = row % 2 == 0 ? i : 100 - i;
      nc += fmt::format("X{:.4f} Y{:.4f} Z{:.4f}\n", x, y, -1.0 + 0.5 * std::sin(x / 10) * std::cos(y / 15));
    }
  }
  swarf::test::write_text(folder / "wave.ngc", nc + "G0 Z20\nM30\n");
  swarf::test::write_text(folder / "scene.toml", R"(title = "wave"
machine = ")" SWARF_SOURCE_DIR R"(/assets/machines/mill_3axis/machine.toml"
nc = "wave.ngc"
dialect = "linuxcnc"
[cutter]
number = 1
diameter_mm = 10
flute_length_mm = 25
length_mm = 60
gauge_length_mm = 100
[setup]
work_origin_mm = [0, 0, 150]
start = { X_mm = 0, Y_mm = 0, Z_mm = 610 }
[stock]
box_mm = [[-6, -6, -11], [106, 56, 1]]
voxel_mm = 0.15
[design]
kind = "none"
[movie]
seconds = 0
)");
}

class Killed : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = swarf::test::fresh_folder("killed");
    write_job(folder_, number_from("SWARF_KILL_BLOCKS", 8000));
    const auto start = Clock::now();
    ASSERT_EQ(wait_for(start_run("")), 0) << log();
    whole_s_ = seconds_since(start);
    hash_ = hash();
  }
  void TearDown() override {
    if (!HasFailure()) fs::remove_all(folder_);
  }

  pid_t start_run(const std::string& from) {
    const std::string command = fmt::format(
        "exec {} run {}/scene.toml --no-render --keep-every 0.05 -o {}{} > {}/log.txt 2>&1", SWARF_PROGRAM,
        folder_.string(), out().string(), from.empty() ? "" : " --from " + from, folder_.string());
    std::string shell = "sh", option = "-c", text = command;
    char* words[] = {shell.data(), option.data(), text.data(), nullptr};
    pid_t process = 0;
    if (posix_spawn(&process, "/bin/sh", nullptr, nullptr, words, environ) != 0)
      throw std::runtime_error("cannot start the program");
    return process;
  }
  static int wait_for(pid_t process) {
    int status = 0;
    waitpid(process, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  fs::path out() const { return folder_ / "out"; }
  std::string log() const { return swarf::test::read_text(folder_ / "log.txt"); }
  std::string hash() const {
    const auto metrics = nlohmann::json::parse(swarf::test::read_text(out() / "metrics.json"));
    return metrics.at("stock").at("hash").get<std::string>();
  }
  /// Until a run that is going has kept a stock, or is over.
  void wait_for_stock(pid_t process) const {
    siginfo_t over{};
    while (!fs::exists(folder_ / fmt::format("out.part{}/stock_so_far.vdb", process)) && over.si_pid == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      waitid(P_PID, static_cast<id_t>(process), &over, WEXITED | WNOHANG | WNOWAIT);
    }
  }
  /// Stops a run after a share of its time, none: as soon as it has kept a stock. Goes on from what it has
  /// left; true when that was a stock.
  bool stop_and_go_on(int signal_number, std::optional<double> share) {
    fs::remove_all(out());
    const pid_t process = start_run("");
    if (share)
      std::this_thread::sleep_for(std::chrono::duration<double>(*share * whole_s_));
    else
      wait_for_stock(process);
    kill(process, signal_number);
    const int code = wait_for(process);
    if (code == 0) return false;  // it was over already
    EXPECT_EQ(code, signal_number == SIGKILL ? 128 + SIGKILL : 130) << log();
    const fs::path pending = folder_ / fmt::format("out.part{}", process);
    const fs::path kept = signal_number == SIGKILL ? pending / "stock_so_far.vdb" : out() / "stock.vdb";
    const bool is_kept = fs::exists(kept);
    EXPECT_TRUE(is_kept || signal_number == SIGKILL || !fs::exists(out())) << log();
    EXPECT_EQ(wait_for(start_run(is_kept ? kept.string() : "")), 0) << log();
    EXPECT_EQ(hash(), hash_);
    fs::remove_all(pending);
    return is_kept;
  }
  void stop_often(int signal_number, uint64_t seed) {
    const long count = number_from("SWARF_KILLS", 4);
    int kept = stop_and_go_on(signal_number, {}) ? 1 : 0;
    EXPECT_EQ(kept, 1) << "no stock is kept on the way";
    for (long i = 0; i < count && !HasFailure(); ++i) {
      Rng rng(seed + static_cast<uint64_t>(i));
      const double share = rng.uniform(0.0, 1.0);
      SCOPED_TRACE(fmt::format("Rng rng({}): after {:.3f} of {:.2f} s", seed + static_cast<uint64_t>(i),
                               share, whole_s_));
      kept += stop_and_go_on(signal_number, share) ? 1 : 0;
    }
    fmt::print("{} of {} runs went on from a stock, the others from the start or were over\n", kept,
               count + 1);
  }

 private:
  fs::path folder_;
  double whole_s_ = 0.0;
  std::string hash_;
};

TEST_F(Killed, RunsGoOnFromTheStockThatWasKept) {
  stop_often(SIGKILL, 100);
}

TEST_F(Killed, InterruptedRunsGoOnFromTheirResult) {
  stop_often(SIGINT, 200);
}

}  // namespace
}  // namespace killed_test
