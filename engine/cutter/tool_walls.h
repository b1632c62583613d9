// What of the tool does not cut: neck, shank and holder as stacked frusta.
#pragma once

#include <vector>

#include "cutter/cutter.h"

namespace swarf::cutter {

/// The lateral wall of a frustum about the tool axis.
struct ToolWall {
  const char* part = "shank";                  ///< "neck", "shank" or "holder"
  double low = 0.0, high = 0.0;                ///< mm above the tip, low < high
  double low_radius = 0.0, high_radius = 0.0;  ///< mm
};

/// From the end of the flutes upwards; neck and shank are missing when they have no length.
std::vector<ToolWall> tool_walls(const Cutter& cutter);

}  // namespace swarf::cutter
