// What a run leaves of its motion besides the tables: with it, and the inputs beside it, any cycles of the
// program can be made again without those before them.
#pragma once

#include <optional>
#include <string>

#include "motion/cycles/cycles.h"
#include "reports/pending_folder.h"

namespace swarf::reports {

inline constexpr const char* kMotionFile = "motion.places";

struct KeptMotion {
  std::string swarf;    ///< version that ran it
  uint64_t inputs = 0;  ///< inputs_hash() of its folder
  motion::CycleRecall recall;
};

/// Of the kept copies (kept_inputs.h) by name and content, and of the overrides that they were run with.
uint64_t inputs_hash(const std::string& folder);

/// Writes it, when the inputs have been kept. Places that a control would have to remember a plan for are
/// left out: the one before serves. Throws InputError "cannot-write".
void keep_motion(const PendingFolder& folder, const motion::Cycles& cycles);

/// None where the run left none. Throws InputError "not-a-run" when the file is broken.
std::optional<KeptMotion> read_motion(const std::string& folder);

/// Throws InputError "run-differs" when the inputs in the folder are not those that were run.
void require_inputs(const KeptMotion& motion, const std::string& folder);

/// The cycles have been prepared, not walked (sim::plan_tool): they are known now as those of the run. Throws
/// InputError "run-differs" as CycleReader does, and when the path has not what the places name.
void recall_motion(motion::Cycles& cycles, KeptMotion motion, const std::string& folder);

}  // namespace swarf::reports
