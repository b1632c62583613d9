// Colours for a finished stock: the deviation at its vertices from a design mesh. What is judged is measured
// by the rays, and by part_comparison.h.
#pragma once

#include "mesh/tri_mesh.h"

namespace swarf::measure {

/// Fills stock.deviation_um with the signed distance to a closed design mesh (positive is excess; the sign by
/// the pseudo-normal of the nearest face, edge or vertex); NaN beyond `reach_mm`.
void deviation_from_mesh(TriMesh& stock, const TriMesh& design, double reach_mm);

}  // namespace swarf::measure
