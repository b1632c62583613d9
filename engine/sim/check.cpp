#include "sim/check.h"

#include <algorithm>

namespace swarf::sim {

bool passes(std::span<const Check> checks) {
  return !checks.empty() && std::none_of(checks.begin(), checks.end(), [](const Check& check) {
    return check.outcome == Outcome::kFails || check.outcome == Outcome::kNotProven;
  });
}

const char* outcome_name(Outcome outcome) {
  switch (outcome) {
    case Outcome::kHolds:
      return "holds";
    case Outcome::kFails:
      return "fails";
    case Outcome::kNotProven:
      return "not_proven";
    case Outcome::kNotJudged:
      break;
  }
  return "not_judged";
}

const Check* find_check(std::span<const Check> checks, const std::string& name) {
  const auto found =
      std::find_if(checks.begin(), checks.end(), [&](const Check& check) { return check.name == name; });
  return found == checks.end() ? nullptr : &*found;
}

}  // namespace swarf::sim
