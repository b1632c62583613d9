// Wavefront OBJ: the polygons of a file.
#pragma once

#include <string>

#include "mesh/tri_mesh.h"

namespace swarf::mesh {

/// Vertices (v, with red, green and blue behind them where a program writes them so), normals (vn) when every
/// corner has one, and the polygons (f) as triangles; groups, materials, texture coordinates, points and
/// lines are read over. Free-form curves and surfaces are refused, not left out. Throws InputError with line
/// and column of what is wrong.
TriMesh read_obj(const std::string& path);

}  // namespace swarf::mesh
