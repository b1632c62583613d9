// What cuts the level set of a job, and the checks of it: made from the motion alone, so that every process
// of a run that shares its stock out makes the same.
#pragma once

#include <vector>

#include "motion/cycles/cycles.h"
#include "sim/job/scene.h"
#include "sim/run/bad_cuts.h"
#include "sim/run/carried_cuts.h"
#include "sim/run/cut_identity.h"
#include "sim/run/cut_sweeps.h"
#include "sim/run/earlier_cuts.h"
#include "sim/run/sweep_places.h"
#include "sim/run/tool_clearance.h"

namespace swarf::sim {

/// Its parts refer to each other: it stays where it is. All that it is made of must outlive it.
struct CutParts {
  CutParts(const Job& job, const motion::Cycles& cycles, const CarriedCuts& carried_cuts);
  CutParts(const CutParts&) = delete;
  CutParts& operator=(const CutParts&) = delete;

  CutSweeps sweeps;
  std::vector<stock::CutterSolid> solids;  ///< by tool
  const CarriedCuts& carried;
  CutIdentity identity;
  SweepPlaces places;
  EarlierCuts earlier;
  ToolClearanceCheck clearance;
  BadCutCheck bad_cuts;

  /// Takes sweeps [begin, end) out of the stock, or out of its own tiles (stock_tiles.h).
  void cut(stock::Stock& stock, size_t begin, size_t end) const;

  /// Where the batch that sweep `at` belongs to ends: the whole tool is looked at once for each.
  size_t batch_end(size_t at) const;
  /// Where the next part of the program ends after which the invariants are looked at.
  size_t check_end(size_t at) const;
  /// One has ended between `before` and `at` sweeps, and the program has not.
  bool is_check_due(size_t before, size_t at) const;
};

}  // namespace swarf::sim
