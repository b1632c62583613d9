// setups.json: what came of a scene of several set-ups, which leaves one folder of results for each.
#pragma once

#include <string>
#include <vector>

#include "sim/simulation.h"

namespace swarf::reports {

/// The file that marks a folder as the results of several set-ups.
inline constexpr const char* kSetupsMark = "setups.json";

/// One of them, finished.
struct SetupOutcome {
  int number = 0;
  std::string name;
  std::string folder;  ///< below that of setups.json
  bool passes = false;
  std::string verdict;      ///< in words
  uint64_t start_hash = 0;  ///< of the level set before its first sweep and behind its last one
  uint64_t hash = 0;
  std::string starts_from;  ///< whose cuts the stock has seen before; "": the raw stock as [stock] says it
  std::string cuts;         ///< what determines these cuts
  double volume_removed_mm3 = 0.0, volume_left_mm3 = 0.0, time_s = 0.0;
};

SetupOutcome setup_outcome(const sim::Job& job, const sim::Result& result);

/// For people: how the stock went from one to the next.
std::string setup_line(const SetupOutcome& setup);

/// `count`: how many the scene has; not all of them may have been asked for: without a failure nobody knows
/// then whether the whole passes (null).
std::string setups_json(const std::string& scene, const std::string& command, size_t count,
                        const std::vector<SetupOutcome>& setups);

}  // namespace swarf::reports
