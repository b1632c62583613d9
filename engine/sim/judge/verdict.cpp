// What a list of checks comes to.
#include <fmt/format.h>

#include <algorithm>

#include "sim/judge/judge.h"

namespace swarf::sim {
namespace {

size_t count(std::span<const Check> checks, Outcome outcome) {
  return static_cast<size_t>(
      std::count_if(checks.begin(), checks.end(), [&](const Check& c) { return c.outcome == outcome; }));
}

std::string spoken(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

/// "gouge, travel".
std::string names(std::span<const Check> checks, Outcome outcome) {
  std::string text;
  for (const Check& check : checks) {
    if (check.outcome == outcome) text += (text.empty() ? "" : ", ") + spoken(check.name);
  }
  return text;
}

/// "gouge, excess (no design), spindle (the program does not say when it turns)".
std::string what_is_not_judged(std::span<const Check> checks) {
  std::vector<std::pair<std::string, std::string>> by_reason;  // reason, names
  for (const Check& check : checks) {
    if (check.outcome != Outcome::kNotJudged) continue;
    const auto same = std::find_if(by_reason.begin(), by_reason.end(),
                                   [&](const auto& one) { return one.first == check.reason; });
    if (same == by_reason.end())
      by_reason.emplace_back(check.reason, spoken(check.name));
    else
      same->second += ", " + spoken(check.name);
  }
  std::string text;
  for (const auto& [reason, list] : by_reason)
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", list, reason);
  return text;
}

/// "collisions, rapids in material: contacts of 0.200 mm and more"; of those that hold.
std::string covered(std::span<const Check> checks) {
  std::string list, covers;
  for (const Check& check : checks) {
    if (check.outcome != Outcome::kHolds || check.covers.empty()) continue;
    list += (list.empty() ? "" : ", ") + spoken(check.name);
    covers = check.covers;
  }
  return list.empty() ? list : fmt::format(" ({}: {})", list, covers);
}

/// "bed with flutes, bed with holder"; what a check that is judged could not look at.
std::string unseen(std::span<const Check> checks) {
  std::string text;
  for (const Check& check : checks)
    if (check.outcome != Outcome::kNotJudged && !check.unseen.empty())
      text += (text.empty() ? "; not looked at: " : ", ") + check.unseen;
  return text;
}

}  // namespace

std::string verdict_sentence(std::span<const Check> checks) {
  return (passes(checks) ? "PASS: " : "FINDINGS: ") + verdict_text(checks);
}

std::string verdict_text(std::span<const Check> checks) {
  if (checks.empty()) return "nothing was judged";
  std::string text;
  const std::string fails = names(checks, Outcome::kFails), open = names(checks, Outcome::kNotProven);
  if (!fails.empty()) text += fails + (count(checks, Outcome::kFails) == 1 ? " fails; " : " fail; ");
  if (!open.empty()) text += open + " not proven; ";
  const size_t held = count(checks, Outcome::kHolds);
  text += fmt::format("{} {}", held, held == 1 ? "check holds" : "checks hold") + covered(checks);
  const std::string silent = what_is_not_judged(checks);
  return text + unseen(checks) + (silent.empty() ? "" : "; not judged: " + silent);
}

}  // namespace swarf::sim
