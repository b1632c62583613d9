// A finished stock, given as a mesh, against a design: a parametric surface or another mesh.
#pragma once

#include <cstddef>

#include "measure/measure.h"
#include "mesh/tri_mesh.h"
#include "stock/surface_dexels.h"

namespace swarf::measure {

/// Signed distance of the stock's vertices to the design; positive is excess. Its accuracy is that of the
/// mesh.
struct DeviationSummary {
  size_t measured = 0;
  size_t unmeasured = 0;  ///< farther away than the reach, beyond the design's edge, or facing another way
  double excess_max_um = 0.0, gouge_max_um = 0.0;
  double mean_abs_um = 0.0, rms_um = 0.0;
  double within_tolerance_pct = 0.0;
};

/// Fills stock.deviation_um (NaN: not measured) from the normals' feet on the design surface, whose grid
/// `design` carries; `stock` needs normals. A vertex counts only when its normal lies within about 37 degrees
/// of the design's, and its foot at least `edge_mm` away from the patch's edge: a grid rounds the edges of
/// the solid.
void deviation_from_surface(TriMesh& stock, const stock::SurfaceDexels& design, double reach_mm,
                            double edge_mm);

/// The same against the nearest point of a closed design mesh; the sign is that of the interpolated vertex
/// normals, which `design` needs.
void deviation_from_mesh(TriMesh& stock, const TriMesh& design, double reach_mm);

DeviationSummary summarise(const TriMesh& stock, const MeasureLimits& limits);

}  // namespace swarf::measure
