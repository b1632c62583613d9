#include "program/cl/cycle.h"

#include <algorithm>

namespace swarf::program {
namespace {

void peck(const ClCycle& cycle, std::vector<ClCycleStep>& steps) {
  const double back = cycle.kind == ClCycleKind::kDeep ? cycle.clear_mm + cycle.depth_mm : kPeckGap;
  double step = cycle.first_step_mm > 0.0 ? cycle.first_step_mm : cycle.step_mm;
  for (double depth = 0.0; depth < cycle.depth_mm; step = cycle.step_mm) {
    const double next = std::min(cycle.depth_mm, depth + step);
    steps.push_back({-next, false, 0.0});
    if (next < cycle.depth_mm) {
      steps.push_back({std::min(cycle.clear_mm, back - next), true, 0.0});
      if (cycle.kind == ClCycleKind::kDeep) steps.push_back({kPeckGap - next, true, 0.0});
    }
    depth = next;
  }
}

}  // namespace

std::vector<ClCycleStep> cycle_steps(const ClCycle& cycle) {
  std::vector<ClCycleStep> steps;
  if (cycle.arrive_mm > cycle.clear_mm) steps.push_back({cycle.clear_mm, true, 0.0});
  if (cycle.kind == ClCycleKind::kDeep || cycle.kind == ClCycleKind::kChipBreak) {
    peck(cycle, steps);
  } else {
    steps.push_back({-cycle.depth_mm, false, 0.0});
  }
  const bool fed_out = cycle.kind == ClCycleKind::kBore || cycle.kind == ClCycleKind::kTap;
  if (fed_out) steps.push_back({cycle.clear_mm, false, cycle.dwell_s});
  if (!fed_out || cycle.retract_mm != cycle.clear_mm) {
    steps.push_back({cycle.retract_mm, true, fed_out ? 0.0 : cycle.dwell_s});
  }
  return steps;
}

}  // namespace swarf::program
