// Key frames: the fewest poses between which straight motion stays within a tolerance.
#pragma once

#include <span>
#include <vector>

#include "base/frames.h"

namespace swarf::render {

/// Rotations of the poses as quaternions whose signs follow each other, so that a viewer turns the short way.
std::vector<Eigen::Quaterniond> continuous_rotations(std::span<const Pose> poses);

/// Ascending indices, first and last among them, such that linear interpolation in time between their
/// translations comes within `tolerance_mm` of every other one (Ramer 1972, with time as the parameter).
std::vector<size_t> translation_keys(std::span<const double> times_s, std::span<const Pose> poses,
                                     double tolerance_mm);

/// The same for rotations under spherical linear interpolation, angles in rad.
std::vector<size_t> rotation_keys(std::span<const double> times_s,
                                  std::span<const Eigen::Quaterniond> rotations, double tolerance_rad);

}  // namespace swarf::render
