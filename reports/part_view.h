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
/// Of a design of facets or CAD faces, triangles are divided where colours interpolated over them would show
/// another deviation than the part has (mesh/shown_field.h, render::ColourError), up to `most_vertices`; 0:
/// none is. `colours_off` (may be null) receives the share of random places, evenly by area, whose colour
/// still shows another deviation; of parametric patches, whose vertices follow the cusps, NaN.
TriMesh shown_part(const FinishedRun& run, TriMesh closed, size_t most_vertices = 0,
                   double* colours_off = nullptr);
/// Of a file: as many as keep it at about 5 MB.
inline constexpr size_t kShownVertices = 90000;

/// Of a design of facets or CAD faces the colours of deviation end as far below the design as above it: at
/// the greatest of the scene's limits, whose breach has the strongest colour of its side; without limits
/// where 98 % of the measured area that was cut lies within, rounded up to 1, 2 or 5 times a power of ten,
/// and no nearer than kLeastScaleUm. Of patches they end at the scene's limits of each side.
render::DeviationScale deviation_scale(const sim::Job& job, const std::vector<stock::SurfaceDexels>& dexels);
inline constexpr double kLeastScaleUm = 5.0;

/// Tool-axis fan and paths of Fig. 13 in the work frame.
std::vector<render::DrawLine> fan_lines(const FinishedRun& run);

}  // namespace swarf::reports
