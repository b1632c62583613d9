// A dialect: how its text is recognised, and the function that reads it into calls of the control.
#pragma once

#include <string>
#include <string_view>

#include "program/nc/control.h"
#include "program/nc_program.h"

namespace swarf::program::nc {

/// What speaks for a dialect in a program's first lines.
struct Evidence {
  int score = 0;       ///< number of words that only this dialect has; 0: nothing speaks for it
  std::string reason;  ///< the first such word, as written with its line: "G43.4 in line 12"
};

struct DialectReader {
  Dialect dialect;
  const char* name;
  /// `head`: the first 256 KiB of the file, `extension` with its dot, in small letters.
  Evidence (*recognise)(std::string_view head, std::string_view extension);
  /// Reads the program to its end. Throws InputError at the first faulty block; ProgramStopped from the sink.
  void (*run)(const std::string& path, Control& control);
};

// Each is defined in the file of its dialect; run_nc.cpp has the table of those there are.
extern const DialectReader kLinuxCncReader, kFanucReader, kSiemensReader, kHeidenhainReader;

}  // namespace swarf::program::nc
