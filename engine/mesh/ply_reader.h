// PLY, as text and binary of both byte orders.
#pragma once

#include <string>

#include "mesh/tri_mesh.h"

namespace swarf::mesh {

/// Vertices, with normals (nx, ny, nz) and colours (red, green, blue, alpha) where the file has them, and the
/// polygons of its faces as triangles. Other properties and elements are read over. Throws InputError with
/// the line, or the byte, of what is wrong: a number out of bounds, a vertex that is not there, a file that
/// is cut off or holds more than its header announces.
TriMesh read_ply(const std::string& path);

}  // namespace swarf::mesh
