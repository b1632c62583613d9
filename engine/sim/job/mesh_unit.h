// Files of meshes that name no unit of their numbers.
#pragma once

#include <string>

#include "base/diagnostics.h"
#include "base/frames.h"

namespace swarf::sim {

/// "mm", "inch" and "m" in mm.
double unit_mm_of(const std::string& word);

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
