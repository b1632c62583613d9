// What a run is checked for, with its outcome, and what is wrong where. Written by the judge alone.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "base/diagnostics.h"
#include "base/frames.h"

namespace swarf::sim {

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
  std::string unseen{};  ///< what it could not look at though it was asked to: said in the verdict
};

/// What is wrong with the job (not with the input): where on the part, in which block, when. An error where
/// its check fails or is not proven, else a warning.
struct Finding {
  std::string code;  ///< stable: "gouge", "scallop", "travel", ...
  Severity severity = Severity::kError;
  std::string text, fix;
  SourceLocation where;
  double t_s = 0.0;
  std::string block;              ///< the program's text there; "" where no line is meant
  std::string check{};            ///< Check::name of what it breaks; "" where it breaks nothing
  int line_last = 0;              ///< of a row of blocks: the last one's line; 0: one block, where.line
  std::optional<Vec3> place_W{};  ///< on the part, where it is worst; none: it has no place there
  std::optional<Vec3> place_M{};  ///< in the machine at t_s, where parts of it meet; none: it is not of them
  double amount_mm = 0.0;         ///< how deep, high or near; 0: not said
  std::string cause{};            ///< what made it, for those of one code: "holder of T3", "axis X"
  double reach_mm = 0.0;          ///< places of one cause this near each other are one fault
  SourceLocation earlier{};       ///< block of an earlier set-up that cut the place; line 0: none did
};

/// No check fails or is not proven. Of an empty list, a run that was not finished: false.
bool passes(std::span<const Check> checks);

/// Check::outcome in words for JSON: "holds", "fails", "not_proven", "not_judged".
const char* outcome_name(Outcome outcome);

/// The check of this name, or null.
const Check* find_check(std::span<const Check> checks, const std::string& name);

}  // namespace swarf::sim
