// What the readers of letter blocks (LinuxCNC, Fanuc) share: their files, the words of the block being read,
// and the checks that every dialect of ISO words makes of them.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "program/control/control.h"
#include "program/control/cycles.h"
#include "program/control/offsets.h"
#include "program/control/path.h"
#include "program/control/tilt.h"
#include "program/control/tools.h"
#include "program/letters/letter_block.h"
#include "program/letters/line_source.h"

namespace swarf::program::nc {

/// The state that the dialects of letters begin with; each adds its own.
struct LetterDialect : Parameters {
  LetterDialect(const std::string& file, Control& machine, const FormulaSyntax& formula)
      : control(machine), path(file), reader(formula, *this, machine) {}

  /// The file, opened once.
  LineSource& open(const std::string& file);
  /// Counts a line that is about to be executed and gives errors its place.
  void at_line(const LineSource& source);
  /// True for a line with '%', which must stand alone; the second one ends the program. So does one that
  /// blocks stand before; where they come `in_pairs` a warning says so ("percent-alone").
  bool percent(std::string_view line, bool in_pairs);
  /// Warns of a main program that ends with its file: it may have been cut off.
  void warn_of_missing_end(const char* ends);
  /// Fails when the block has the letter where it means nothing.
  void check_letter(char letter, bool allowed, const char* used_with);
  /// Fails when the block lacks the letter.
  void need(char letter, const char* with);
  /// Fails for F that is not above zero, or S below it.
  void check_feed_and_speed();

  int column(char letter) const { return reader.column_of(block.place(letter)); }
  int g_column(int group) const { return reader.column_of(block.g_places[static_cast<size_t>(group)]); }
  /// The code of a group as the program writes it: "G68.2".
  std::string g_name(int group) const { return code_name('G', block.g_written[static_cast<size_t>(group)]); }

  Control& control;
  std::string path, kept_line;
  FormulaReader reader;
  LetterBlock block;
  std::vector<std::unique_ptr<LineSource>> sources;
  bool ended = false, percent_seen = false;
};

}  // namespace swarf::program::nc
