// "surface.scallop_max_um" or "planners.1.time_s" inside a JSON document.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace swarf::test {

inline nlohmann::json at_path(const nlohmann::json& document, const std::string& dotted) {
  std::string pointer = "/" + dotted;
  for (char& c : pointer) {
    if (c == '.') c = '/';
  }
  return document.at(nlohmann::json::json_pointer(pointer));
}

}  // namespace swarf::test
