// --from, --to, --from-line and --to-line: a part of a program's time.
#pragma once

#include <CLI/CLI.hpp>

#include "sim/run/cycle_window.h"

namespace swarf::cli {

/// `what`: what the part is for, as the help says it. `places` must live as long as the command.
void add_window_options(CLI::App& command, sim::WindowPlaces& places, const std::string& what);

}  // namespace swarf::cli
