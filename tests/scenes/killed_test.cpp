// The shipped program killed and interrupted, and gone on with: the stock is that of a run that was never
// stopped. SWARF_KILLS: at how many random moments (default 4); SWARF_KILL_BLOCKS: blocks of the program.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
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

class Killed : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = swarf::test::fresh_folder("killed");
    const auto written = swarf::test::run_command(
        fmt::format("/usr/bin/python3 '{}/tests/bench/wave.py' {} '{}' 0.25", SWARF_SOURCE_DIR,
                    number_from("SWARF_KILL_BLOCKS", 8000), folder_.string()));
    ASSERT_EQ(written.exit_code, 0) << written.output;
    const auto start = Clock::now();
    const pid_t process = start_run("", kEachStep);
    wait_for_stocks(process, 1);
    first_stock_s_ = seconds_since(start);
    ASSERT_EQ(wait_for(process), 0) << log();
    whole_s_ = seconds_since(start);
    hash_ = hash();
  }
  void TearDown() override {
    if (!HasFailure()) fs::remove_all(folder_);
  }

  pid_t start_run(const std::string& from, double keep_every_s) {
    const std::string command =
        fmt::format("exec {} run {}/scene.toml --no-render --keep-every {} -o {}{} > {}/log.txt 2>&1",
                    SWARF_PROGRAM, folder_.string(), keep_every_s, out().string(),
                    from.empty() ? "" : " --from " + from, folder_.string());
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
  fs::path kept_stock(pid_t process) const {
    return folder_ / fmt::format("out.part{}/stock_so_far.vdb", process);
  }
  /// Until a run that is going has kept a stock so often, or is over. Each is a file of its own.
  void wait_for_stocks(pid_t process, int count) const {
    siginfo_t over{};
    for (ino_t last = 0; count > 0 && over.si_pid == 0;) {
      struct stat file {};
      const bool is_kept = stat(kept_stock(process).c_str(), &file) == 0;
      if (is_kept && file.st_ino != last) {
        last = file.st_ino;
        --count;
      } else {
        std::this_thread::sleep_for(std::chrono::microseconds(200));
        waitid(P_PID, static_cast<id_t>(process), &over, WEXITED | WNOHANG | WNOWAIT);
      }
    }
  }
  /// Ends a run that is under way, and goes on from what it has left; true when that was a stock.
  bool stop_and_go_on(pid_t process, int signal_number) {
    kill(process, signal_number);
    const int code = wait_for(process);
    if (code == 0) return false;  // it was over already
    EXPECT_EQ(code, signal_number == SIGKILL ? 128 + SIGKILL : 130) << log();
    const fs::path kept = signal_number == SIGKILL ? kept_stock(process) : out() / "stock.vdb";
    const bool is_kept = fs::exists(kept);
    EXPECT_TRUE(is_kept || signal_number == SIGKILL || !fs::exists(out())) << log();
    EXPECT_EQ(wait_for(start_run(is_kept ? kept.string() : "", kSeldom)), 0) << log();
    EXPECT_EQ(hash(), hash_);
    fs::remove_all(kept.parent_path());
    return is_kept;
  }
  /// After the first, second, .. stock that is kept: whatever the machine's speed, there is one to go on
  /// from.
  void stop_after_stocks(int signal_number) {
    for (const int count : {1, 2, 5}) {
      SCOPED_TRACE(fmt::format("after stock {}", count));
      fs::remove_all(out());
      const pid_t process = start_run("", kEachStep);
      wait_for_stocks(process, count);
      EXPECT_TRUE(stop_and_go_on(process, signal_number)) << "no stock is kept on the way";
    }
  }
  /// At SWARF_KILLS moments that are spread over the whole run, every second one over what comes after the
  /// first stock is kept.
  void stop_anywhere(int signal_number, uint64_t seed) {
    const long count = number_from("SWARF_KILLS", 4);
    int kept = 0;
    Rng rng(seed);
    for (long i = 0; i < count && !HasFailure(); ++i) {
      const double least = i % 2 == 0 ? 0.0 : first_stock_s_;
      const double after = least + (static_cast<double>(i) + rng.uniform(0.0, 1.0)) /
                                       static_cast<double>(count) * (whole_s_ - least);
      SCOPED_TRACE(fmt::format("after {:.3f} of {:.2f} s", after, whole_s_));
      fs::remove_all(out());
      const pid_t process = start_run("", 0.05);
      std::this_thread::sleep_for(std::chrono::duration<double>(after));
      const bool went_on = stop_and_go_on(process, signal_number);
      kept += went_on ? 1 : 0;
      fmt::print("{} of {}: signal {} after {:.2f} of {:.2f} s, {}\n", i + 1, count, signal_number, after,
                 whole_s_, went_on ? "went on from a stock" : "from the start, or it was over");
      std::fflush(stdout);  // a long series is watched while it runs
    }
    fmt::print("{} of {} runs went on from a stock, the others from the start or were over\n", kept, count);
  }

 private:
  static constexpr double kEachStep = 1e-9, kSeldom = 60.0;  ///< s, --keep-every

 private:
  fs::path folder_;
  double first_stock_s_ = 0.0, whole_s_ = 0.0;
  std::string hash_;
};

TEST_F(Killed, RunsGoOnFromTheStockThatWasKept) {
  stop_after_stocks(SIGKILL);
}

TEST_F(Killed, InterruptedRunsGoOnFromTheirResult) {
  stop_after_stocks(SIGINT);
}

TEST_F(Killed, AtAnyMoment) {
  stop_anywhere(SIGKILL, 100);
  stop_anywhere(SIGINT, 200);
}

}  // namespace
}  // namespace killed_test
