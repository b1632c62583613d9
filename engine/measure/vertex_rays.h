// The deviation at vertices of a part's mesh by rays of their own: what a picture shows is what a measuring
// ray at that place finds, whatever the mesh's own error.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "measure/seen_surface.h"
#include "mesh/tri_mesh.h"
#include "stock/raw/raw_shape.h"
#include "stock/rays/surface_dexels.h"

namespace swarf::measure {

/// What the vertices are measured with. Borrowed.
struct VertexRayInput {
  const stock::RayField& design;  ///< the measuring rays
  const stock::RawShape& raw;
  double slack_mm = 0.0;  ///< no vertex is farther from the part's true surface
  /// Takes out of these rays what is taken out of the measuring rays.
  std::function<void(stock::SurfaceDexels&)> cut;
};

/// Of a design of facets or CAD faces: fills part.deviation_um (um, excess > 0; NaN: not measured). The mesh
/// has normals.
///
///   along its own normal   A ray finds the surface that the sweeps left within the slack of the vertex: the
///                 deviation is the distance of that place from the design, as one compares parts.
///   over the design        No such ray ends there, and the vertex lies over a place of the design whose
///                 normal agrees with its own: the same along that normal.
///   else          Nothing is found, and nothing is said.
void deviation_by_vertex_rays(const VertexRayInput& input, TriMesh& part);

/// Of a parametric design: the same for the vertices that its rays have seen, but not on the machined face
/// (Seen::on_face). What no ray finds stays as it is.
void deviation_by_vertex_rays(const VertexRayInput& input, const SeenSurface& seen,
                              std::span<const uint32_t> vertices, TriMesh& part);

}  // namespace swarf::measure
