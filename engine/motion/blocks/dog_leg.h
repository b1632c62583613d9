// Rapid moves of machines whose axes do not wait for each other.
//
//      Y |      ___________ to      Every axis starts at once at its own rapid speed and stands when it has
//        |     /                    arrived. In the space of the axes that is a chain of straight legs, one
//        |    / X and Y, each as    for each arrival, and as such it stands in the tool path: stock,
//   from |___/  fast as it can      collision check and time see the same legs.
//        +---------------------> X
//  Modelling: a real axis also starts and stops by its own ramp, so that the corners between the legs are
//  rounded. The legs' corners are sharp; the look-ahead rounds them in the trajectory by kDogLegCorner.
#pragma once

#include <span>

#include "kinematics/machine_model.h"
#include "toolpath/tool_path.h"

namespace swarf::motion {

/// Deviation of the tip that the corners between legs are passed with, mm.
inline constexpr double kDogLegCorner = 0.5;

/// The path with each rapid under the joint law in its legs, for machines whose rapids are dog-legs; other
/// machines and other blocks: the path as it is. Legs carry their axis values. Throws InputError
/// "unreachable" like block_motions().
/// `by_tool`: the machine with each tool in its spindle (BlockMove::tool), or one for whatever tool.
toolpath::ToolPath with_dog_legs(toolpath::ToolPath path, std::span<const kinematics::MachineModel> by_tool);

}  // namespace swarf::motion
