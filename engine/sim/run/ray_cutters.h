// What cuts the measuring rays of a job: its own sweeps, and behind them those of earlier set-ups.
#pragma once

#include <vector>

#include "sim/run/carried_cuts.h"
#include "sim/run/job_sweeps.h"

namespace swarf::sim {

struct MeasuredPath;

/// Of ray_sweeps() and then those of earlier set-ups; Sweep::block is the index, `sources` are of the own
/// ones alone.
JobSweeps all_ray_sweeps(const Job& job, const motion::Cycles& cycles, const CarriedCuts& carried);
/// The same from the job's own ones.
JobSweeps with_carried(JobSweeps own, const CarriedCuts& carried);

/// Cutters and passes of such sweeps, by Sweep::block.
struct RayCutters {
  std::vector<stock::CutterSolid> solids;
  std::vector<int> solid_of;
  std::vector<int> passes;  ///< -1: between passes, and of earlier set-ups
};
RayCutters ray_cutters(const Job& job, const MeasuredPath& measured);
/// Without passes, for who only cuts.
RayCutters ray_cutters(const Job& job, const JobSweeps& rays, const CarriedCuts& carried);

}  // namespace swarf::sim
