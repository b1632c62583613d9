#include "sim/job/contact_keys.h"

namespace swarf::sim {
namespace {

constexpr Range kNearMiss{0.001, 1000.0};  // mm

ContactPair read_contact_pair(ConfigTable table) {
  ContactPair pair;
  pair.where = table.where();
  const std::vector<std::string> parts = table.texts("parts", {});
  const bool two = parts.size() == 2 && parts[0] != parts[1];
  if (two) {
    pair.a = parts[0];
    pair.b = parts[1];
  } else {
    table.error("bad-contact-pair", "parts", "a contact pair has two different parts",
                "parts = [\"vice\", \"holder\"]: links, fixtures, \"stock\" or parts of the tool");
  }
  pair.may_touch = table.boolean("may_touch", false);
  if (table.has("near_miss_mm")) pair.near_miss_mm = table.number("near_miss_mm", kNearMiss, 10.0);
  if (two && pair.may_touch == pair.near_miss_mm.has_value())
    table.error("bad-contact-pair", "may_touch",
                pair.may_touch ? "parts that may touch have no near miss" : "nothing is said of this pair",
                "write may_touch = true, or near_miss_mm = 2.0");
  return pair;
}

}  // namespace

std::vector<ContactPair> read_contact_pairs(ConfigTable& root) {
  std::vector<ContactPair> pairs;
  if (!root.has("contact_pair")) return pairs;
  for (const ConfigTable& table : root.tables("contact_pair")) pairs.push_back(read_contact_pair(table));
  return pairs;
}

}  // namespace swarf::sim
