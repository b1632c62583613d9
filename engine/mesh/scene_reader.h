// Meshes of the formats that carry whole scenes, read by assimp, 3MF by lib3mf.
#pragma once

#include <string>

#include "mesh/tri_mesh.h"

namespace swarf::mesh {

/// Whether the ending (small letters, with its dot) is of such a format: .glb .gltf .dae .fbx .3mf .amf .off
bool is_scene_ending(const std::string& ending);
/// The same, for messages: ".glb, .gltf, ..."
std::string scene_endings();

/// All meshes of the scene at their nodes' places, joined, polygons as triangles; lines, points, hidden
/// states and animations are left out. In mm with Z up: by what the format prescribes (glTF: metres, Y up) or
/// the file says (COLLADA `unit` and `up_axis`, FBX UnitScaleFactor and UpAxis, 3MF and AMF `unit`); OFF says
/// nothing, and its numbers are taken as mm and Z up, as of STL. A glTF that requires an extension, or
/// whose numbers stand in a file of their own, is refused. Throws InputError with what the library says is
/// wrong.
TriMesh read_scene_mesh(const std::string& path, const std::string& ending);

}  // namespace swarf::mesh
