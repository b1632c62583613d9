// Lin & Koren's planner: the least interval over the previous path, by Eq. 2 with R = 1/kappa across the
// feed; the previous path is offset by it.
//
// The paper takes R on the previous path, but the cusp of Eq. 1 stands in the middle of the strip. Where the
// surface curves more strongly ahead, the paper's interval leaves more than the wanted scallop (2.5 % more on
// the reference dome); it is then shortened until the strip's own theory gives what was asked for.
#pragma once

#include "toolpath/grid_step.h"

namespace swarf::toolpath {

NextPass next_lin_koren(const Area& area, const CubicSpline& previous);

}  // namespace swarf::toolpath
