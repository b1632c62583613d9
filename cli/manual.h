// The manual page and the shell's completions, made from the same parser that reads the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace swarf::cli {

/// swarf.1 in troff: each command with its options and what its --help says below them.
std::string man_page(const CLI::App& app);

/// Completions of commands and long options for bash (and zsh with bashcompinit).
std::string bash_completions(const CLI::App& app);

}  // namespace swarf::cli
