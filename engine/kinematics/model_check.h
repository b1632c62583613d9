// What makes a machine model unusable for the inverse, before any pose is asked for.
#pragma once

#include <string>
#include <vector>

#include "kinematics/machine_model.h"

namespace swarf::kinematics {

/// Two unit vectors with a smaller sine between them count as parallel, and three with a smaller triple
/// product as dependent: the inverse would lose six of its sixteen digits.
inline constexpr double kParallelTolerance = 1e-6;
/// By how much the length of a direction may differ from 1: a metre away this is 1e-9 mm. Loaders normalise.
inline constexpr double kUnitTolerance = 1e-12;

struct ModelProblem {
  std::string code;  ///< as in Diagnostic
  int axis = -1;     ///< index into MachineModel::axes; -1: the machine as a whole
  std::string text, fix;
};

/// Every reason why the model has no unique inverse: numbers of axes, chains, directions, dependent linear
/// axes, parallel rotary axes, a rotary axis that only spins the tool. Empty: it has one.
std::vector<ModelProblem> check_model(const MachineModel& machine);

/// The rotary axes in the order in which they turn the tool axis into the work frame: the one next to the
/// work first, through the base, to the one next to the tool.
std::vector<int> rotary_order(const MachineModel& machine);

}  // namespace swarf::kinematics
