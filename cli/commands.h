// The subcommands of swarf. Each adds itself to the parser; its callback returns the exit code through
// `exit_code`.
#pragma once

#include <CLI/CLI.hpp>

namespace swarf::cli {

/// Exit codes: 0 every criterion holds, 1 findings, 2 the input is wrong, 3 internal error, 130 stopped by
/// Ctrl-C.
inline constexpr int kPass = 0;
inline constexpr int kFindings = 1;
inline constexpr int kBadInput = 2;
inline constexpr int kInternalError = 3;
inline constexpr int kStopped = 130;

void add_run(CLI::App& app, int& exit_code);
void add_batch(CLI::App& app, int& exit_code);
void add_init(CLI::App& app, int& exit_code);
void add_machines(CLI::App& app, int& exit_code);
void add_show(CLI::App& app, int& exit_code);
void add_replay(CLI::App& app, int& exit_code);
void add_check(CLI::App& app, int& exit_code);
void add_plan(CLI::App& app, int& exit_code);
void add_post(CLI::App& app, int& exit_code);
void add_compare(CLI::App& app, int& exit_code);
void add_render(CLI::App& app, int& exit_code);
void add_export(CLI::App& app, int& exit_code);
/// The manual page and completions of all commands that have been added before.
void add_manual(CLI::App& app);

}  // namespace swarf::cli
