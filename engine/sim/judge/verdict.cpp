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

/// Names, each once with those of the same words, in order of the first: ("collisions, rapids in material",
/// "contacts of 0.200 mm and more").
class ByWords {
 public:
  void add(const std::string& name, const std::string& words) {
    const auto same =
        std::find_if(groups_.begin(), groups_.end(), [&](const auto& group) { return group.words == words; });
    if (same == groups_.end())
      groups_.push_back({spoken(name), words});
    else
      same->names += ", " + spoken(name);
  }
  struct Group {
    std::string names, words;
  };
  const std::vector<Group>& groups() const { return groups_; }

 private:
  std::vector<Group> groups_;
};

/// "gouge, excess (no design), spindle (the program does not say when it turns)".
std::string what_is_not_judged(std::span<const Check> checks) {
  ByWords by_reason;
  for (const Check& check : checks)
    if (check.outcome == Outcome::kNotJudged) by_reason.add(check.name, check.reason);
  std::string text;
  for (const auto& [names, reason] : by_reason.groups())
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", names, reason);
  return text;
}

/// " (collisions, rapids in material: contacts of 0.200 mm and more)"; of those that hold.
std::string covered(std::span<const Check> checks) {
  ByWords by_cover;
  for (const Check& check : checks)
    if (check.outcome == Outcome::kHolds && !check.covers.empty()) by_cover.add(check.name, check.covers);
  std::string text;
  for (const auto& [names, covers] : by_cover.groups())
    text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", names, covers);
  return text.empty() ? text : fmt::format(" ({})", text);
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
