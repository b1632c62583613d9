// Triangles too flat to have a plane of their own.
#pragma once

#include "mesh/mesh_check.h"

namespace swarf::mesh {

/// Flips the longest sides of triangles that are no higher than `height_mm` into the diagonals across them
/// and their neighbours, while that makes the lower of the two higher. A closed mesh stays closed. What no
/// flip helps remains. Returns how far no place of the surface moves beyond, mm: the heights of rounds add
/// up.
double flip_slivers(WeldedMesh& mesh, double height_mm);

/// The same for a mesh of floats. One without such triangles stays as it is; vertex normals do not.
double flip_slivers(TriMesh& mesh, double height_mm);

}  // namespace swarf::mesh
