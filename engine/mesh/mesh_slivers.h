// Triangles too flat to have a plane of their own.
#pragma once

#include "mesh/mesh_check.h"

namespace swarf::mesh {

/// Flips the longest sides of triangles that are no higher than `height_mm` into the diagonals across them
/// and their neighbours, while that makes the lower of the two higher. A closed mesh stays closed, and no
/// place of it moves by more than the height. What no flip helps remains.
void flip_slivers(WeldedMesh& mesh, double height_mm);

}  // namespace swarf::mesh
