// One judge: everything that a run is checked for, each with its limit, value and outcome. Console, exit
// code, metrics.json, findings.json, page and pictures read this list; nothing else decides.
//
// Collisions, rapids in material, the spindle, travel and speed of the axes and the program's checks of
// itself count in every run; a limit is loosened only by writing it in [accept]. What was not looked at is
// kNotJudged with the reason: never green, and said in the verdict itself.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace swarf::motion {
struct MotionFinding;
}

namespace swarf::sim {

struct Job;
struct Result;

enum class Outcome {
  kHolds,
  kFails,
  kNotProven,  ///< the value meets the limit, its bound does not: counts like kFails
  kNotJudged,  ///< nothing is known; Check::reason says why
};

struct Check {
  std::string name;     ///< stable, snake_case: "gouge"
  std::string subject;  ///< for people: "Deepest gouge"
  std::string what{};   ///< one line for people, with unit: "deepest gouge 0.012 um, at most 0.2 um"
  std::string unit{};   ///< of limit, value and bound; "" for a count
  std::optional<double> limit{}, value{};
  std::optional<double> bound{};  ///< proven: no place is worse than this (measure::Bound)
  Outcome outcome = Outcome::kNotJudged;
  std::string covers{};  ///< of a check that sees only what is large enough: "contacts of 0.200 mm and more"
  std::string reason{};  ///< why it is not judged or not proven; what a result rests on
};

/// The list for a finished run; the same checks in the same order for every job.
std::vector<Check> judge(const Job& job, const Result& result);

/// Those of the list that judge motion alone: travel, axis_speed, round_trip. Of `result` only main is read.
std::vector<Check> judge_motion(const Job& job, const Result& result);

/// Check::name of what a fault of the motion breaks.
const char* check_of(const motion::MotionFinding& fault);

/// No check fails or is not proven. Of an empty list, a run that was not finished: false.
bool passes(std::span<const Check> checks);

/// "9 checks hold (collisions: contacts of 0.200 mm and more); not judged: gouge, excess (no design)".
std::string verdict_text(std::span<const Check> checks);
/// The same after "PASS: " or "FINDINGS: ".
std::string verdict_sentence(std::span<const Check> checks);

/// Check::outcome in words for JSON: "holds", "fails", "not_proven", "not_judged".
const char* outcome_name(Outcome outcome);

/// The check of this name, or null.
const Check* find_check(std::span<const Check> checks, const std::string& name);

}  // namespace swarf::sim
