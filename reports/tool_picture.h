// A tool as its outline, to scale: flutes, neck and shank, holder.
#pragma once

#include <string>

#include "cutter/cutter.h"

namespace swarf::reports {

/// <svg> of kToolPictureHeight pixels, as wide as the tool is; the tip is at its lower edge.
std::string tool_svg(const cutter::Cutter& tool);
inline constexpr double kToolPictureHeight = 120.0;

}  // namespace swarf::reports
