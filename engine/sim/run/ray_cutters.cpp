#include "sim/run/ray_cutters.h"

#include <algorithm>
#include <utility>

#include "sim/run/result.h"

namespace swarf::sim {

JobSweeps all_ray_sweeps(const Job& job, const motion::Cycles& cycles, const CarriedCuts& carried) {
  return with_carried(ray_sweeps(job, cycles), carried);
}

JobSweeps with_carried(JobSweeps own, const CarriedCuts& carried) {
  JobSweeps all = std::move(own);
  for (stock::Sweep sweep : carried.rays.sweeps) {
    sweep.block = static_cast<uint32_t>(all.sweeps.size());
    all.sweeps.push_back(sweep);
  }
  all.error_bound_mm = std::max(all.error_bound_mm, carried.rays.error_bound_mm);
  return all;
}

RayCutters ray_cutters(const Job& job, const JobSweeps& rays, const CarriedCuts& carried) {
  RayCutters cutters{tool_solids(job.scene), tool_of_blocks(rays), {}};
  const auto first = static_cast<int>(cutters.solids.size());
  cutters.solids.insert(cutters.solids.end(), carried.solids.begin(), carried.solids.end());
  for (const int solid : carried.rays.solids) cutters.solid_of.push_back(first + solid);
  return cutters;
}

RayCutters ray_cutters(const Job& job, const MeasuredPath& measured) {
  RayCutters cutters = ray_cutters(job, measured.rays, *measured.carried);
  cutters.passes = pass_of_blocks(measured.rays, measured.path);
  cutters.passes.resize(cutters.solid_of.size(), -1);
  return cutters;
}

}  // namespace swarf::sim
