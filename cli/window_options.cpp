#include "cli/window_options.h"

#include <string>

#include "cli/number_flags.h"

namespace swarf::cli {

void add_window_options(CLI::App& command, sim::WindowPlaces& places, const std::string& what) {
  CLI::Option* from = command.add_option("--from", places.from_s, what + " from this program time on, s")
                          ->type_name("S")
                          ->check(nonnegative());
  CLI::Option* to = command.add_option("--to", places.to_s, what + " up to this program time, s")
                        ->type_name("S")
                        ->check(nonnegative());
  command
      .add_option("--from-line", places.from_line,
                  what + " from the start of the first block of this line on, as findings name it")
      ->type_name("LINE")
      ->check(positive())
      ->excludes(from);
  command.add_option("--to-line", places.to_line, what + " up to the end of the last block of this line")
      ->type_name("LINE")
      ->check(positive())
      ->excludes(to);
}

}  // namespace swarf::cli
