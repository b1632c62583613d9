// Splits the triangles of a mesh until a field on its surface is shown right by what is interpolated between
// the vertices.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "base/frames.h"
#include "mesh/tri_mesh.h"

namespace swarf::mesh {

/// A field on a surface, and how a picture of it errs.
struct ShownField {
  /// Sets deviation_um of each vertex to the field there, NaN where it has none; may set the normals too. The
  /// mesh has positions and normals, no triangles.
  std::function<void(TriMesh& places)> measure;
  /// Of what a picture shows where corners with the values `um` have these shares (sum 1), from `truth`; 1 is
  /// as much as is allowed. No value is NaN.
  std::function<double(const std::array<float, 3>& um, const Vec3& shares, float truth)> error;
  double saturates = std::numeric_limits<double>::infinity();  ///< values beyond +- this are shown alike, um
  /// Where the field is known to change within a facet, mm: these places, if nearer than near_mm, become
  /// vertices. A dent that lies between all places that are looked at would be missed.
  std::vector<Vec3> known_changes{};
  double near_mm = 0.0;
  /// Where the mesh has none of its own to keep: no more vertices are made.
  size_t most_vertices = 0;
  /// No further round of splits is begun when so many places beside the vertices have been measured.
  size_t most_places = 250000;
};

/// Of a mesh with normals whose creases are split (split_creases): measures its vertices and splits triangles
/// until no place that was looked at errs by more than is allowed, the worst by error and area first where
/// there would be too many vertices.
///
/// 1. A field may jump at a crease. Places on the border of a patch of triangles that share vertices are
///    measured kInsetMm inside the patch: each side of an edge has the value of its own face.
/// 2. Along each side of a triangle the field is measured at places whose distances from a crease double: a
///    field that changes within micrometres of an edge is seen on a side of 100 mm. The side is divided where
///    the polyline through its places errs, at the kinks, and so are all triangles that meet there: none
///    hangs beside another.
/// 3. A triangle is divided anew by the shortest diagonals between equal values: strips along an edge stay
///    strips.
/// 4. A triangle whose sides are right is looked at inside, and its longest side halved where that errs.
///
/// The surface stays where it is; flat triangles become smaller ones in the same plane.
void show_field(const ShownField& field, TriMesh& mesh);
inline constexpr double kInsetMm = 1e-3;

/// At random places, evenly by area, where the field has a value.
struct ShownAgreement {
  size_t seen = 0;   ///< places with a value whose triangle has values
  size_t wrong = 0;  ///< of those: the error is more than is allowed
  size_t grey = 0;   ///< places with a value whose triangle has none
  double worst = 0.0;
  Vec3 where = Vec3::Zero();  ///< the worst, mm
};
ShownAgreement shown_agreement(const ShownField& field, const TriMesh& mesh, size_t count);

}  // namespace swarf::mesh
