// What swarf check says of one file, to people and to programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/diagnostics.h"

namespace swarf::cli {

struct Checked {
  std::string kind;                    ///< "nc", "cl", "surface_blocks", "scene" or "machine"
  std::string text;                    ///< lines for people, of a file that is right or has findings
  nlohmann::ordered_json numbers;      ///< the same as an object; names carry their unit
  std::vector<Diagnostic> told;        ///< warnings and notes
  std::vector<Diagnostic> findings{};  ///< reads well, but the machine cannot do it: the file is not right
};

}  // namespace swarf::cli
