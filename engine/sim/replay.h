// Two cuts against each other, block by block: the recorded one and the one that a scene gives today.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "sim/job/scene.h"
#include "sim/run/cut_record.h"

namespace swarf::sim {

struct ReplayDifference {
  bool exact = false;      ///< the stocks differ after `last` and are equal before it
  size_t first = 0;        ///< 0-based number of the first sweep that may be the one
  size_t last = 0;         ///< and of the last
  CutPlace recorded, now;  ///< of sweep `last`; where one run is over, its last place
};

struct ReplayResult {
  size_t sweeps = 0;                           ///< compared
  size_t states = 0;                           ///< hashes compared
  bool same_motion = true;                     ///< every sweep equals its recorded one
  std::vector<IdentityDifference> parts;       ///< what the scene has otherwise
  std::optional<ReplayDifference> difference;  ///< of the stocks; none: they are equal throughout
  bool stopped = false;
};

/// Cuts the scene's path again and compares it with the record:
///  1. up to the first sweep that moves otherwise every recorded hash is compared; a hash that differs there
///     means that equal motion left another stock, and only the interval between two hashes is known
///  2. from there both paths are cut sweep by sweep until the stocks differ: that sweep is exact
/// Throws InputError "record-other-stock" when box, voxel size, cutter or algorithm differ: such cuts
/// have no block in common.
ReplayResult replay(const CutRecord& record, const Job& job, Progress& progress);

}  // namespace swarf::sim
