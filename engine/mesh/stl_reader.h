// STL, binary and as text. Binary in one pass with constant memory per facet: ten million facets in seconds.
#pragma once

#include <string>

#include "mesh/tri_mesh.h"

namespace swarf::mesh {

/// The file's facets with equal positions merged; its facet normals say nothing new and are left out. Throws
/// InputError with the line, or the byte, where the file is not STL, is cut off, or holds more than it says.
TriMesh read_stl(const std::string& path);

}  // namespace swarf::mesh
