// What the user sees while and after a command works: progress, tables, diagnostics.
#pragma once

#include <chrono>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "base/progress.h"

namespace swarf::cli {

/// Ctrl-C asks the running command to stop and keep what is finished; a second one ends the program at once.
void catch_interrupt();
/// For a command that never asks whether it is: Ctrl-C and SIGTERM end the program at once, as they do by
/// themselves.
void let_interrupts_end();
bool interrupted();

/// How much is said, for all commands.
struct Manner {
  bool quiet = false;    ///< errors, warnings, findings and the verdict alone
  bool verbose = false;  ///< every finding, not only the first of each code
  bool progress = true;  ///< stages of long work; not with quiet
};
void set_manner(const Manner& manner);
const Manner& manner();

/// A diagnostic as `format` writes it; on a terminal with its severity in colour, unless NO_COLOR is set.
std::string painted(const Diagnostic& diagnostic, std::FILE* where);

/// On a terminal one line per stage, redrawn with a bar and the time left; otherwise plain lines.
/// Everything goes to stderr, so that stdout stays free for --json.
class TerminalProgress final : public Progress {
 public:
  void begin(std::string_view stage, double total, std::string_view unit) override;
  void advance(double done) override;
  void start_at(double done) override { first_ = done; }
  void note(std::string_view text) override;
  void end() override;
  bool stop_requested() const override { return interrupted(); }

 private:
  using Clock = std::chrono::steady_clock;
  void draw(double done);

  std::string stage_, unit_;
  double total_ = 0.0, first_ = 0.0;
  Clock::time_point start_, drawn_;
};

/// Two aligned columns.
void print_table(const std::vector<std::pair<std::string, std::string>>& rows);

/// Warnings and notes that did not stop the command.
void print_diagnostics(const std::vector<Diagnostic>& diagnostics);

}  // namespace swarf::cli
