// [[contact_pair]] of a scene: what is said of two bodies that come near each other.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/config.h"

namespace swarf::sim {

struct ContactPair {
  /// Of a link, a fixture, "stock", or a part of the tool: "holder" is that of every tool, "holder of T3" of
  /// one.
  std::string a, b;
  bool may_touch = false;  ///< their contacts are not looked at
  /// mm; a lesser gap is told. The pair is then watched, also where one of two links guides the other or
  /// their meshes overlap at home.
  std::optional<double> near_miss_mm;
  SourceLocation where;
};

/// "bad-contact-pair" where a table does not say one thing of two bodies.
std::vector<ContactPair> read_contact_pairs(ConfigTable& root);

}  // namespace swarf::sim
