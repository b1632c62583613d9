// Mesh files: the one door through which meshes come in, and writing STL, PLY and OBJ. What comes through is
// finite, within a kilometre of the origin (kFarthest) and soundly indexed, so that the libraries behind need
// not ask.
#pragma once

#include <string>

#include "mesh/mesh_check.h"
#include "mesh/tri_mesh.h"

namespace swarf::mesh {

/// Reads .stl, .ply or .obj (mm), or a scene (scene_reader.h), all meshes of the file joined, polygons split
/// into triangles, equal vertices merged, normals and colours kept where all have them. Throws InputError
/// with the line or byte of what is wrong when the file is missing, not a mesh, damaged, or empty.
TriMesh load_mesh(const std::string& path);

/// Whether files of that ending carry the unit of their numbers, or their format prescribes one.
bool carries_unit(const std::string& path);

/// Writes .stl (binary), .ply (binary, with normals, colours and `deviation_um` where the mesh has them) or
/// .obj (positions in mm as the shortest decimals that read back to the same floats, normals where there are
/// any) or .3mf (mm; its bytes differ from call to call, for lib3mf numbers its objects anew) by the ending
/// of the name; the file is replaced whole. Throws InputError for another ending or when it cannot be
/// written.
void save_mesh(const std::string& path, const TriMesh& mesh);

}  // namespace swarf::mesh
