// The parts of every tool of a scene as bodies on the spindle.
#pragma once

#include <vector>

#include "collision/body.h"
#include "sim/job/scene.h"

namespace swarf::sim {

/// Flutes stand for a polygon of their outline, inside it by no more, mm.
inline constexpr double kToolOutline = 1e-3;

/// Flutes, neck, shank and holder, which stand in the spinning flutes' outline; "holder", with several tools
/// "holder of T3".
std::vector<collision::Body> tool_bodies(const Job& job);

}  // namespace swarf::sim
