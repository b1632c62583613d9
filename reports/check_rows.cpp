#include "reports/check_rows.h"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "sim/judge/limit_text.h"

namespace swarf::reports {
namespace {

State state_of(sim::Outcome outcome) {
  switch (outcome) {
    case sim::Outcome::kHolds:
      return State::kHolds;
    case sim::Outcome::kFails:
      return State::kFails;
    case sim::Outcome::kNotProven:
      return State::kNotProven;
    case sim::Outcome::kNotJudged:
      break;
  }
  return State::kNotChecked;
}

std::string with_unit(std::string number, const sim::Check& check) {
  static const std::map<std::string, std::string> written{{"um", "µm"}, {"mm2", "mm²"}, {"mm3", "mm³"}};
  if (check.unit.empty()) return number;
  const auto found = written.find(check.unit);
  return number + " " + (found == written.end() ? check.unit : found->second);
}

std::string measured(const sim::Check& check) {
  std::string text =
      check.unit == "um" ? sim::text_beside(*check.value, *check.limit) : fmt::format("{:.3g}", *check.value);
  if (check.bound) text += ", proven below " + sim::text_beside(*check.bound, *check.limit);
  return with_unit(std::move(text), check);
}

}  // namespace

Verdict verdict_of(const std::vector<sim::Check>& checks) {
  Verdict verdict;
  verdict.pass = sim::passes(checks);
  verdict.headline = sim::verdict_text(checks);
  for (const sim::Check& check : checks) {
    if (check.outcome == sim::Outcome::kNotJudged || !check.limit || !check.value) continue;
    verdict.criteria.push_back({check.subject, measured(check),
                                "at most " + with_unit(sim::limit_text(*check.limit), check),
                                state_of(check.outcome)});
  }
  return verdict;
}

std::vector<Check> check_rows(const std::vector<sim::Check>& checks) {
  std::vector<Check> rows;
  for (const sim::Check& check : checks)
    rows.push_back({check.subject, check.what == check.subject ? "" : check.what, check.reason,
                    state_of(check.outcome)});
  return rows;
}

Tone tone_of(const sim::Check& check) {
  switch (check.outcome) {
    case sim::Outcome::kHolds:
      return Tone::kOk;
    case sim::Outcome::kFails:
      return Tone::kBad;
    case sim::Outcome::kNotProven:
      return Tone::kWarning;
    case sim::Outcome::kNotJudged:
      break;
  }
  return Tone::kNeutral;
}

}  // namespace swarf::reports
