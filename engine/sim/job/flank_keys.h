// The [flank] table of a scene: a ruled design that is milled by the flank, without a program (Chu et al.).
#pragma once

#include "base/config.h"
#include "flank/flank_path.h"

namespace swarf::sim {

struct FlankSettings {
  flank::Placement placement = flank::Placement::kMinimax;
  flank::FlankMotion motion;  ///< but for the control's period and the law of its blocks
  double tip_below_mm = 1.0;  ///< of guide curve 0, in the last pass
  int depth_passes = 1;
  SourceLocation where;
};

FlankSettings read_flank(ConfigTable table);

}  // namespace swarf::sim
