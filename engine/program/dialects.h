// The one table of dialects: what everything outside a dialect's own folder knows of it. The scene file, the
// command line, its help, and run_nc read it; a new dialect is a folder, a value of Dialect and a row in
// dialects.cpp.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "program/evidence.h"
#include "program/nc_program.h"

namespace swarf::program {

namespace nc {
struct Control;
}

struct DialectRow {
  Dialect dialect;
  const char* name;                           ///< as scenes and the command line write it
  std::span<const std::string_view> endings;  ///< files so named are NC programs; small letters, with the dot
  /// What speaks for the dialect in the first 256 KiB of the file.
  Evidence (*evidence)(const ProgramHead& head);
  /// Reads the program to its end. Throws InputError at the first faulty block; ProgramStopped from the sink.
  void (*run)(const std::string& path, nc::Control& control);
};

/// Every dialect that can be read, in the order in which texts name them.
std::span<const DialectRow> dialects();
const DialectRow& dialect_row(Dialect dialect);
/// The names, as a scene may write them.
std::vector<std::string> dialect_names();
/// "linuxcnc, fanuc and ..": the names with `last` (" and ", " or ") before the last one.
std::string dialect_list(const char* last);
std::optional<Dialect> dialect_of(std::string_view name);
/// True for an ending that only NC programs have; small letters, with its dot.
bool is_dialect_ending(std::string_view extension);

}  // namespace swarf::program
