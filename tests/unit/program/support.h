// What the program tests share.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "program/source_text.h"
#include "program/surface_blocks/program.h"

namespace swarf::program {

inline std::string project_file(const std::string& path) {
  return std::string(SWARF_SOURCE_DIR) + "/" + path;
}

inline std::string dome_text() {
  return read_file(project_file("scenes/lin_koren_dome/dome.nc"));
}

/// A valid program around `blocks`, which stand from line 2 on.
inline std::string with_modal_words(const std::string& blocks) {
  return "G17 G21 G54 G90 T1 M6 S12000 M3\n" + blocks + "M30\n";
}

/// A closed surface 1 (a 10 mm square plane), five lines.
inline std::string plane_blocks() {
  return "G10 L70 P1 Q1 R1\nG10 L71 P1 I1 J0 X10\nG10 L71 P1 I0 J1 Y10\nG10 L79 P1\n";
}

struct Parsed {
  Program program;
  Diagnostics diagnostics;
};

inline Parsed parse(const std::string& text) {
  Parsed parsed;
  parsed.program = parse_surface_blocks(text, "test.nc", parsed.diagnostics);
  return parsed;
}

/// "code line:column" of each diagnostic.
inline std::vector<std::string> places(const Diagnostics& diagnostics) {
  std::vector<std::string> found;
  for (const Diagnostic& d : diagnostics.list()) {
    found.push_back(d.code + " " + std::to_string(d.where.line) + ":" + std::to_string(d.where.column));
  }
  return found;
}

inline std::string all_text(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& d : diagnostics.list()) text += format(d) + "\n";
  return text;
}

/// The program, with the diagnostics in the failure when there are any.
inline Program parse_clean(const std::string& text) {
  Parsed parsed = parse(text);
  EXPECT_TRUE(parsed.diagnostics.list().empty()) << all_text(parsed.diagnostics) << "--- of the program\n"
                                                 << text;
  return parsed.program;
}

}  // namespace swarf::program
