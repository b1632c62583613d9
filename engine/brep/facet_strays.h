// How far the faces of a CAD file stray from the facets that stand for them.
#pragma once

#include <array>
#include <vector>

#include "mesh/tri_mesh.h"
#include "surface/under_facets.h"

namespace swarf::brep {

/// From a point to a line segment, mm.
double to_segment(const Vec3& p, const Vec3& a, const Vec3& b);

/// No place of the surface over the triangle x (parameters) is farther from the facet than this, mm. The
/// distance from a convex body is a convex function: over the hull of the triangle's corners it is greatest
/// at one of them, and the surface stays within its flatness of that hull. Divided until `enough` holds or
/// nothing more is won (at the pole of a sphere the parameters turn about one place).
double distance_bound(const surface::Surface& surface, const std::array<Vec2, 3>& x,
                      const std::array<Vec3, 3>& facet, double enough, int depth = 0);

/// Per facet of a mesh: no place of the face over it is farther from it, and where a side of it stands for a
/// curved edge, the face ends no farther before or beyond it; mm, the rounding to float included. Facets of
/// planes are exact but for such sides. UnderFacets::chord_mm where a facet has no surface. Looked at no
/// closer than `enough_mm`.
std::vector<double> facet_strays(const TriMesh& mesh, const surface::UnderFacets& under, double enough_mm);

}  // namespace swarf::brep
