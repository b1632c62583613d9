// The [design] table of a CL scene: what the finished part is measured against.
#pragma once

#include <string>
#include <vector>

#include "base/config.h"
#include "surface/surface.h"

namespace swarf::sim {

enum class DesignKind {
  kProgram,   ///< the surfaces of the scene's own program
  kNone,      ///< nothing is measured
  kSurface,   ///< the surfaces of another program of surface blocks
  kAnalytic,  ///< one surface in closed form, or a NURBS surface in its smooth parts
  kMesh,      ///< a closed triangle mesh: STL, PLY or OBJ, mm; or the bodies of a CAD file in facets
};

struct DesignSettings {
  DesignKind kind = DesignKind::kProgram;
  std::string name = "program";  ///< as in the scene: "hyperboloid"
  double pitch_mm = 0.2;         ///< grid of measuring rays on the design; cusps are refined between them
  /// CL scenes: blocks are divided into sweeps that stay this close to their motion for the measuring rays.
  double sweep_tolerance_mm = 2e-5;
  std::string surface_file;                   ///< kSurface
  std::string mesh_file;                      ///< kMesh
  std::string mesh_key = "mesh";              ///< that names it: "step" for a CAD file
  double chord_mm = 5e-4;                     ///< CAD files: facets stray no farther from the faces
  std::vector<surface::SurfacePtr> surfaces;  ///< kAnalytic
};

/// Reads [design]; `cl` tells which keys belong there. Without `kind` it is the mesh or the surface whose
/// file is named, else none. Problems go to the table's diagnostics; `surface_file` and `mesh_file` are left
/// as written.
DesignSettings read_design(ConfigTable table, bool cl);

}  // namespace swarf::sim
