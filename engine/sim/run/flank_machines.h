// What each shipped five-axis machine makes of a flank job: [flank] machines = "all".
#pragma once

#include <string>
#include <vector>

#include "sim/job/scene.h"
#include "stock/rays/surface_dexels.h"

namespace swarf::sim {

/// One machine under one law of its blocks, with the work clamped as "on_table" clamps it: the middle of the
/// stock's lower face 100 mm above the machine's own work origin.
struct FlankMachineRow {
  std::string machine;
  std::string law;        ///< "tcp", "joint", "ends" or "curve"
  bool reached = false;   ///< every cycle, within the travel of all axes
  std::string unreached;  ///< where not: which axis, or which place
  double time_s = 0.0;
  double least_mm = 0.0, greatest_mm = 0.0;  ///< of the envelope of its cycles over the rays
  std::string limiting;                      ///< what stands nearest to its limit most often: "A jerk"
  double limiting_share = 0.0;               ///< of the feeding cycles
  double most_mm() const { return greatest_mm > -least_mm ? greatest_mm : -least_mm; }
};

/// Machines by name, without those that have fewer than two rotary axes; tcp and joint, or the curve alone
/// where the passes follow one.
std::vector<FlankMachineRow> flank_machines(const Job& job, const std::vector<stock::SurfaceDexels>& dexels);

}  // namespace swarf::sim
