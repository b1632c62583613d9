// The finished part as one mesh with what was measured on it.
#pragma once

#include <vector>

#include "measure/metrics.h"
#include "render/draw_list.h"
#include "render/figures/colour.h"
#include "reports/machine_view.h"

namespace swarf::reports {

/// Edges of the stock that turn by more are shaded as edges, rad.
inline constexpr double kCreaseRad = 0.5;

/// The level set's mesh in the work frame, closed: what is exported. Vertices on a machined design surface
/// carry the deviation of the measuring rays and the normal of the cut that made them, so that cusps far
/// below the voxel size are seen; walls of gouges and of what was left standing their own distance from the
/// design; what no ray has seen NaN.
TriMesh part_mesh(const FinishedRun& run);

/// The same for the eye, made from the stock's closed mesh or a decimated one: split at its creases before it
/// is measured, so that either side of an edge has its own normal and deviation. Not closed by indices.
TriMesh shown_part(const FinishedRun& run, TriMesh closed);

/// The colours of deviation end at the scene's limits: what breaks one has the strongest colour of its side.
render::DeviationScale deviation_scale(const sim::Job& job);

/// Tool-axis fan and paths of Fig. 13 in the work frame.
std::vector<render::DrawLine> fan_lines(const FinishedRun& run);

}  // namespace swarf::reports
