// The finished part as one mesh with what was measured on it.
#pragma once

#include <vector>

#include "render/draw_list.h"
#include "reports/machine_view.h"

namespace swarf::reports {

/// Edges of the stock that turn by more are shaded as edges, rad.
inline constexpr double kCreaseRad = 0.5;

/// The level set's mesh in the work frame, closed: what is exported. Vertices on a machined design surface
/// carry the deviation of the measuring rays and the normal of the cut that made them, so that cusps far
/// below the voxel size are seen; elsewhere deviation_um is NaN.
TriMesh part_mesh(const FinishedRun& run);

/// The same for the eye, made from the stock's closed mesh or a decimated one: split at its creases before it
/// is measured, so that either side of an edge has its own normal and deviation. Not closed by indices.
TriMesh shown_part(const FinishedRun& run, TriMesh closed);

/// Half width of the colour scale of deviation, um: a round number a little above the allowed scallop.
double deviation_scale_um(const sim::Job& job);

/// Tool-axis fan and paths of Fig. 13 in the work frame.
std::vector<render::DrawLine> fan_lines(const FinishedRun& run);

}  // namespace swarf::reports
