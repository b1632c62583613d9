// 3MF files, by lib3mf.
#pragma once

#include <string>

#include "mesh/tri_mesh.h"

namespace swarf::mesh {

/// The bytes of a 3MF package with one object in mm. Throws InputError "mesh-format" at `path` where the
/// format cannot hold the mesh.
std::string bytes_3mf(const TriMesh& mesh, const std::string& path);

/// What a 3MF package has to build: the meshes of all build items, components at their places, in mm by the
/// package's unit. Throws InputError "mesh-unreadable".
TriMesh read_3mf(const std::string& path);

}  // namespace swarf::mesh
