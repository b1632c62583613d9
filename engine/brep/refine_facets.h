// Finer facets of a shape that is tessellated, by its surfaces and edges alone: sides are halved on the curve
// or the surface that they stand for. The library behind tessellate() takes many times as long for as fine a
// mesh.
#pragma once

#include <span>
#include <vector>

#include "brep/model.h"

namespace swarf::brep {

struct FineFacets {
  TriMesh mesh;  ///< welded
  double chord_mm =
      0.0;  ///< no face strays farther from its facets, proven by the bends; edges at their quarters
  std::vector<double> chords_mm;  ///< the same of each triangle: planes are exact but beside curved edges
};

/// Sides that stray by more than `chord_mm` are halved until none does. `most`: of triangles; with more, or
/// where facets have no surface (across creases), the mesh is empty.
FineFacets refine_facets(const Facets& facets, double chord_mm, size_t most);

/// With the finest of these chords that needs no more than `most` triangles, whose number is taken to grow as
/// one over the chord. `chords_mm`: finest first. The mesh is empty where even the last needs more, or none
/// can be refined.
FineFacets finest_facets(const Facets& facets, std::span<const double> chords_mm, size_t most);

}  // namespace swarf::brep
