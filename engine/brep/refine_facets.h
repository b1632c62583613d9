// Facets of a CAD file divided where they stray too far from their faces.
#pragma once

#include "mesh/tri_mesh.h"
#include "surface/under_facets.h"

namespace swarf::brep {

struct RefinedFacets {
  TriMesh mesh;  ///< equal positions are one vertex
  surface::UnderFacets under;
};

/// Halves the sides of curved facets whose middles stray from their surface by more than `chord_mm`, and
/// both facets beside such a side, until there are none or there would be more than `most_facets`. Sides
/// that stand for an edge which is no straight line in the parameters stay whole. The library makes six
/// times as many facets for the same chord, for it also divides along a cylinder.
RefinedFacets refine(const TriMesh& mesh, const surface::UnderFacets& under, double chord_mm,
                     size_t most_facets);

}  // namespace swarf::brep
