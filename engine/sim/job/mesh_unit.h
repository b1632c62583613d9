// Files of meshes that name no unit of their numbers.
#pragma once

#include <string>

#include "base/config.h"
#include "base/diagnostics.h"
#include "base/frames.h"

namespace swarf::sim {

/// "mm", "inch" and "m" in mm.
double unit_mm_of(const std::string& word);

/// mesh_unit beside the mesh `file` of a format that carries its unit (glTF, COLLADA, FBX, 3MF, AMF) is an
/// error ("unit-twice"): its numbers come in mm already.
void refuse_second_unit(ConfigTable& table, const std::string& file);

/// Where a mesh is named, and the key of its unit.
struct MeshNamed {
  const char* name;  ///< "stock mesh"
  const char* unit_key;
  SourceLocation where;
};

/// Warns ("mesh-unit-suspicious"): what is thinner than the tool that machines it is in another unit, or
/// none.
void suspect_unit(const MeshNamed& mesh, const Box& box, double tool_mm, Diagnostics& diagnostics);

}  // namespace swarf::sim
