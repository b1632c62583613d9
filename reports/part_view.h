// The finished part as one mesh with what was measured on it.
#pragma once

#include <vector>

#include "render/draw_list.h"
#include "reports/machine_view.h"

namespace swarf::reports {

/// The level set's mesh in the work frame. Vertices on a machined design surface carry the deviation of the
/// measuring rays and the normal of the cut that made them, so that cusps far below the voxel size are seen;
/// elsewhere deviation_um is NaN.
TriMesh part_mesh(const FinishedRun& run);

/// Half width of the colour scale of deviation, um: a round number a little above the allowed scallop.
double deviation_scale_um(const sim::Job& job);

/// Tool-axis fan and paths of Fig. 13 in the work frame.
std::vector<render::DrawLine> fan_lines(const FinishedRun& run);

}  // namespace swarf::reports
