// What a scene leaves open, and what was taken for it: one table of the console, the report and metrics.json.
#pragma once

#include <string>
#include <vector>

namespace swarf::sim {

struct Assumption {
  std::string what;    ///< "Stock"
  std::string value;   ///< with its unit
  std::string reason;  ///< the rule, with its numbers
  std::string change;  ///< the flag or key that says it
};
using Assumptions = std::vector<Assumption>;

}  // namespace swarf::sim
