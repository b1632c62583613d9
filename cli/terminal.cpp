#include "cli/terminal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <string_view>

namespace swarf::cli {
namespace {

std::atomic<bool> stop_flag{false};
static_assert(std::atomic<bool>::is_always_lock_free, "the signal handler needs a lock-free flag");

constexpr int kBarWidth = 28;
constexpr std::chrono::milliseconds kRedraw{100};
constexpr std::chrono::seconds kPlainLine{5};  // without a terminal: a line in so many seconds

/// When the first interrupt came, ns; 0: none has.
std::atomic<int64_t> first_interrupt{0};
static_assert(std::atomic<int64_t>::is_always_lock_free, "the signal handler needs a lock-free number");

int64_t steady_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return int64_t{1'000'000'000} * now.tv_sec + now.tv_nsec;
}

/// The first one asks to stop. One Ctrl-C may come twice: a terminal, timeout and mpirun send it to the
/// process and to its group. A later one ends the process, and says so: nothing else would.
void on_interrupt(int signal_number) {
  constexpr int64_t kSameInterrupt = 500'000'000;  // ns
  const int64_t now = steady_ns();
  int64_t first = 0;
  if (first_interrupt.compare_exchange_strong(first, now)) {
    stop_flag = true;
    return;
  }
  if (now - first < kSameInterrupt) return;
  constexpr std::string_view kText = "\nstopped by a second interrupt: what was under way is not kept\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, kText.data(), kText.size());
  std::signal(signal_number, SIG_DFL);
  std::raise(signal_number);
}

bool is_terminal() {
  static const bool answer = isatty(STDERR_FILENO) != 0;
  return answer;
}

Manner& the_manner() {
  static Manner manner;
  return manner;
}

bool silent() {
  return the_manner().quiet || !the_manner().progress;
}

/// NO_COLOR: https://no-color.org
bool takes_colour(std::FILE* where) {
  const char* refused = std::getenv("NO_COLOR");
  return isatty(fileno(where)) != 0 && (refused == nullptr || *refused == '\0');
}

}  // namespace

void set_manner(const Manner& manner) {
  the_manner() = manner;
}

const Manner& manner() {
  return the_manner();
}

std::string painted(const Diagnostic& diagnostic, std::FILE* where) {
  std::string text = format(diagnostic);
  if (!takes_colour(where)) return text;
  const bool error = diagnostic.severity == Severity::kError;
  const std::string word = error                                       ? " error: "
                           : diagnostic.severity == Severity::kWarning ? " warning: "
                                                                       : " note: ";
  const size_t at = text.find(word);
  if (at != std::string::npos)
    text.replace(at, word.size(), fmt::format("\033[1;{}m{}\033[0m", error ? 31 : 33, word));
  return text;
}

void catch_interrupt() {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  std::signal(SIGUSR1, on_interrupt);  // which mpirun passes on to its processes
}

void let_interrupts_end() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

bool interrupted() {
  return stop_flag;
}

void TerminalProgress::begin(std::string_view stage, double total, std::string_view unit) {
  stage_ = stage;
  unit_ = unit;
  total_ = total;
  first_ = 0.0;
  start_ = Clock::now();
  drawn_ = start_;
  if (is_terminal() && !silent()) draw(0.0);
}

void TerminalProgress::advance(double done) {
  if (silent()) return;
  const Clock::time_point now = Clock::now();
  if (is_terminal() ? now - drawn_ < kRedraw : now - drawn_ < kPlainLine) return;
  drawn_ = now;
  draw(done);
}

void TerminalProgress::draw(double done) {
  const double share = total_ > 0.0 ? std::clamp(done / total_, 0.0, 1.0) : 0.0;
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  const double rate = elapsed > 0.0 ? (done - first_) / elapsed : 0.0;
  const bool known = total_ > 0.0 && done - first_ > 0.02 * (total_ - first_);
  const std::string left = known ? fmt::format("{:.{}f} {}/s  {:.0f} s left", rate, rate < 10.0 ? 1 : 0,
                                               unit_, (total_ - done) / rate)
                                 : "";
  if (is_terminal()) {
    const int filled = static_cast<int>(share * kBarWidth);
    fmt::print(stderr, "\r\033[K{:<22} [{:#<{}}{:.<{}}] {:3.0f} %  {}", stage_, "", filled, "",
               kBarWidth - filled, 100.0 * share, left);
  } else {
    fmt::print(stderr, "{:<22} {:3.0f} %  {:.0f} of {:.0f} {}  {}\n", stage_, 100.0 * share, done, total_,
               unit_, left);
  }
  std::fflush(stderr);
}

void TerminalProgress::note(std::string_view text) {
  if (manner().quiet) return;
  fmt::print(stderr, "{}\n", text);
}

void TerminalProgress::end() {
  if (silent()) return;
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  fmt::print(stderr, "{}{:<22} {:6.2f} s{}\n", is_terminal() ? "\r\033[K" : "", stage_, elapsed,
             interrupted() ? "  (stopped)" : "");
}

void print_table(const std::vector<std::pair<std::string, std::string>>& rows) {
  size_t width = 0;
  for (const auto& [label, value] : rows) width = std::max(width, label.size());
  for (const auto& [label, value] : rows) fmt::print("  {:<{}}  {}\n", label, width, value);
}

void print_diagnostics(const std::vector<Diagnostic>& diagnostics) {
  for (const Diagnostic& diagnostic : diagnostics) fmt::print(stderr, "{}\n", painted(diagnostic, stderr));
}

}  // namespace swarf::cli
