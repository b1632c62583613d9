// The [flank] table of a scene: a ruled design that is milled by the flank (Chu et al.).
#pragma once

#include <optional>

#include "base/config.h"
#include "flank/flank_path.h"

namespace swarf::sim {

struct FlankSettings {
  flank::Placement placement = flank::Placement::kMinimax;
  flank::FlankMotion motion;  ///< but for the control's period and the law of its blocks
  double tip_below_mm = 1.0;  ///< of guide curve 0, in the last pass
  int depth_passes = 1;
  std::optional<double> clearance_mm;  ///< to be kept from every fixture (flank_clearance.h)
  bool best_tool = false;     ///< of all tools of the scene the one whose proven placement errs least
  bool all_machines = false;  ///< compare the shipped five-axis machines
  SourceLocation where;
};

/// `by_program`: feed, spindle and chord tolerance are words of the program.
FlankSettings read_flank(ConfigTable table, bool by_program);

}  // namespace swarf::sim
