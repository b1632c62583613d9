// Whether a parametric design lies where the stock is. Of meshes mesh/mesh_check.h says it.
#pragma once

#include <string>

#include "base/diagnostics.h"
#include "sim/job/scene.h"

namespace swarf::sim {

/// A place of the design outside the raw stock lacks material that no cut has taken. Error
/// "design-outside-stock": all of it lies there, proven by its bends, and nothing could be measured. Warning
/// "design-beyond-stock": some of it does, looked at on a grid; with the farthest place. Both say in which
/// units and by which offset the two would meet.
void check_design_place(const Job& job, Diagnostics& diagnostics);

/// "X 0.000 to 40.000, Y .. mm".
std::string spoken_box(const Box& box);

}  // namespace swarf::sim
