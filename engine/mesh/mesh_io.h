// Mesh files: reading through assimp, writing STL and PLY.
#pragma once

#include <string>

#include "mesh/mesh_check.h"
#include "mesh/tri_mesh.h"

namespace swarf::mesh {

/// Reads .stl, .ply or .obj (mm): all meshes of the file joined, equal vertices merged, normals and colours
/// kept where the file has them. Throws InputError when the file is missing, not a mesh, or empty.
TriMesh load_mesh(const std::string& path);

/// Writes .stl (binary) or .ply (binary, with normals, colours and `deviation_um` where the mesh has them) by
/// the ending of the name; the file is replaced whole. Throws InputError for another ending or when it cannot
/// be written.
void save_mesh(const std::string& path, const TriMesh& mesh);

}  // namespace swarf::mesh
