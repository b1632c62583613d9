// Circles of the tip that a program gives as many straight blocks, and how far linear axes lead from them.
//
// A five-axis circle (around a cone, say) reaches the control as points. With linear axes the tip leaves the
// circle by the chord of each block and, near the pole, by far more (theory 2, the tilted cone).
#pragma once

#include <optional>
#include <span>

#include "motion/blocks/block_motions.h"

namespace swarf::motion {

struct CircleError {
  int first = 0, last = 0;  ///< elements of the path, the longest run of lines whose points are on one circle
  double radius_mm = 0.0;
  double chord_mm = 0.0;  ///< how far a straight tip would leave it: the sagitta of the longest block
  int element = 0;        ///< where the tip leaves it most, and
  double u = 0.0;         ///< how far along that block
  double value_mm = 0.0;  ///< distance of the tip from the circle, mm
  int blocks() const { return last - first + 1; }
};

/// Of the motions `elements` (indices, ascending, feed blocks with axis values at both ends), the longest run
/// of at least eight consecutive ones that turns by a quarter or more on one circle; the first of equally
/// long ones. None: no such run.
std::optional<CircleError> circle_error(const BlockMotions& motions, std::span<const int> elements);

}  // namespace swarf::motion
