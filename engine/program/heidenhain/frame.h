// Where the coordinates of a Heidenhain program lie: datum shift, mirror image, rotation and scaling.
//
//   p = T(shift) M Rz(turn) S u          u as programmed, M mirrors, S scales about the datum (cycle 11) or
//                                        about a centre of its own (cycle 26)
//
// The control's frame is rigid, so that M and S are applied to the words: M Rz(turn) = Rz(+-turn) M, and what
// is left behind the rigid part is a factor and an offset for each axis.
#pragma once

#include "base/frames.h"
#include "program/control/stretch.h"

namespace swarf::program::nc::heidenhain {

/// What cycles 7, 8, 10, 11 and 26 (TRANS ..) leave, in mm and degrees.
struct Level {
  Vec3 shift = Vec3::Zero();
  Vec3 mirror = Vec3::Ones();  ///< -1: this axis is mirrored
  double turn_deg = 0.0;
  double scale = 1.0;              ///< cycle 11: all axes, about the datum
  Vec3 axis_scale = Vec3::Ones();  ///< cycle 26
  Vec3 centre = Vec3::Zero();      ///< of cycle 26
  bool mirrors() const { return mirror != Vec3::Ones(); }
  bool scales() const { return scale != 1.0; }
  bool scales_axes() const { return axis_scale != Vec3::Ones(); }
  bool stretches() const { return mirrors() || scales() || scales_axes(); }
  bool none() const { return shift.isZero(0.0) && turn_deg == 0.0 && !stretches(); }
  /// T(shift) Rz(+-turn).
  Pose rigid() const;
  Stretch stretch() const;
};

/// Spatial angles SPA SPB SPC in degrees: about the fixed X, then the fixed Y, then the fixed Z.
Mat3 spatial_rotation(double a_deg, double b_deg, double c_deg);

}  // namespace swarf::program::nc::heidenhain
