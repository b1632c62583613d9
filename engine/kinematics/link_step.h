// One link on a walk along the chain, packed: what carrying a point along with it, or back, needs of its
// axis.
#pragma once

#include "base/frames.h"
#include "kinematics/rotation.h"

namespace swarf::kinematics {

struct LinkStep {
  bool rotary = false;
  int axis = 0;        ///< index into MachineModel::axes
  double sense = 1.0;  ///< of the step per unit of the axis value
  Along along = Along::kX;
  Vec3 direction = Vec3::UnitX(), origin = Vec3::Zero();
};

}  // namespace swarf::kinematics
