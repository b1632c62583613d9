// One judge: everything that a run is checked for, each with its limit, value and outcome. Console, exit
// code, metrics.json, findings.json, page and pictures read this list; nothing else decides.
//
// Collisions, rapids in material, the spindle, travel and speed of the axes and the program's checks of
// itself count in every run; a limit is loosened only by writing it in [accept]. What was not looked at is
// kNotJudged with the reason: never green, and said in the verdict itself.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/check.h"

namespace swarf::motion {
struct MotionFinding;
}

namespace swarf::sim {

struct Job;
struct Result;

/// The list for a finished run; the same checks in the same order for every job.
std::vector<Check> judge(const Job& job, const Result& result);

/// Those of the list that judge motion alone: travel, axis_speed, round_trip. Of `result` only main is read.
std::vector<Check> judge_motion(const Job& job, const Result& result);

/// Check::name of what a fault of the motion breaks.
const char* check_of(const motion::MotionFinding& fault);

/// "9 checks hold (collisions: contacts of 0.200 mm and more); not judged: gouge, excess (no design)".
std::string verdict_text(std::span<const Check> checks);
/// The same after "PASS: " or "FINDINGS: ".
std::string verdict_sentence(std::span<const Check> checks);

}  // namespace swarf::sim
