// Mirror images and scaling: what is left of a frame behind its rigid part (ModalState and Control know rigid
// frames only), a factor and an offset for each axis. Every dialect applies it to its words.
#pragma once

#include <cmath>
#include <optional>

#include "base/frames.h"
#include "program/control/target.h"

namespace swarf::program::nc {

/// Coordinates of the control's frame from programmed ones, axis by axis: factor u + offset, mm.
struct Stretch {
  Vec3 factor = Vec3::Ones(), offset = Vec3::Zero();
  bool none() const { return factor == Vec3::Ones() && offset.isZero(0.0); }
  /// All axes are scaled alike, mirrored or not: angles stay.
  bool uniform() const { return factor.cwiseAbs() == Vec3(Vec3::Constant(std::abs(factor[0]))); }
  /// A coordinate, or a way along the axis (`incremental`).
  double along(int axis, double value_mm, bool incremental) const {
    return factor[axis] * value_mm + (incremental ? 0.0 : offset[axis]);
  }
  /// The mirror image of a turn in this plane turns the other way.
  bool turns_over(const PlaneAxes& plane) const { return factor[plane.first] * factor[plane.second] < 0.0; }
  /// By how much lengths in this plane grow; nothing where its axes are scaled differently, and arcs would be
  /// none.
  std::optional<double> in_plane(const PlaneAxes& plane) const {
    const double first = std::abs(factor[plane.first]), second = std::abs(factor[plane.second]);
    return first == second ? std::optional(first) : std::nullopt;
  }
};

}  // namespace swarf::program::nc
