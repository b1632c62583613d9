// A binary glTF file, read without the code that writes them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "support/program_run.h"

namespace swarf::test {

struct Glb {
  nlohmann::json model;
  std::string binary;
};

inline Glb read_glb(const std::filesystem::path& path) {
  const std::string bytes = read_text(path);
  uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, sizeof length);
  return {nlohmann::json::parse(bytes.substr(20, length)), bytes.substr(28 + length)};
}

/// Least and greatest of an attribute of floats over all meshes.
inline std::pair<float, float> range_of(const Glb& glb, const char* attribute) {
  std::pair range{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};
  for (const nlohmann::json& mesh : glb.model.at("meshes")) {
    const nlohmann::json& attributes = mesh.at("primitives").at(0).at("attributes");
    if (!attributes.contains(attribute)) continue;
    const nlohmann::json& accessor = glb.model.at("accessors").at(attributes.at(attribute).get<size_t>());
    const nlohmann::json& view = glb.model.at("bufferViews").at(accessor.at("bufferView").get<size_t>());
    for (size_t i = 0; i < accessor.at("count").get<size_t>(); ++i) {
      float value = 0.0F;
      std::memcpy(&value, glb.binary.data() + view.value("byteOffset", size_t{0}) + 4 * i, sizeof value);
      range = {std::min(range.first, value), std::max(range.second, value)};
    }
  }
  return range;
}

}  // namespace swarf::test
