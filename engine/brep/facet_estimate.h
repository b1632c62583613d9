// How many facets a CAD file will need, before memory is taken for them.
#pragma once

#include "brep/model.h"

namespace swarf::brep {

/// More by the estimate are refused: ten times as many of some 600 bytes each are 1.5 GB, and the library
/// takes minutes for them.
inline constexpr double kMostFacets = 2.5e5;

/// Facets with a chord of `chord_mm` inside the faces and of `edge_mm` along the edges, by the bends of the
/// patches: a facet with sides du and dv strays from its surface by |S_uu| du^2 / 8 and |S_vv| dv^2 / 8, its
/// diagonal by |S_uv| du dv / 4, at 64 places of each. Whole patches count, also where they are trimmed away.
/// The library divides unevenly and finer than it must: on kato_mould it made 4 times as many at 20 um and 9
/// times at 5 um.
double estimated_facets(const Model& model, double chord_mm, double edge_mm);

/// Throws InputError "cad-too-fine" where the estimate is above kMostFacets, with the part's size and unit.
void require_facets_fit(const Model& model, double chord_mm, double edge_mm);

}  // namespace swarf::brep
