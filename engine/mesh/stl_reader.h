// Binary STL in one pass with constant memory per facet: ten million facets in seconds.
#pragma once

#include <optional>
#include <string>

#include "mesh/tri_mesh.h"

namespace swarf::mesh {

/// The file's facets with equal positions merged; its facet normals say nothing new and are left out. Nothing
/// when the file is not binary STL, i.e. its size is not what its facet count asks for.
std::optional<TriMesh> read_binary_stl(const std::string& path);

}  // namespace swarf::mesh
