// New vertices on the triangles of a mesh. Internal to this folder.
#pragma once

#include <span>

#include "base/frames.h"
#include "mesh/tri_mesh.h"

namespace swarf::mesh {

/// Gives the mesh a vertex where it is nearest to each of the places: the triangle there becomes three.
/// Places farther than `within_mm` from it, or beside an edge or another vertex, get none. The mesh has
/// normals.
void add_vertices_at(std::span<const Vec3> places, double within_mm, TriMesh& mesh);

}  // namespace swarf::mesh
