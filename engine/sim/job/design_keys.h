// The [design] table of a CL scene: what the finished part is measured against.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/config.h"
#include "base/placement.h"
#include "surface/surface.h"

namespace swarf::sim {

enum class DesignKind {
  kProgram,     ///< the surfaces of the scene's own program
  kNone,        ///< nothing is measured
  kSurface,     ///< the surfaces of another program of surface blocks
  kAnalytic,    ///< one surface in closed form, or a NURBS surface in its smooth parts
  kRuledFaces,  ///< ruled faces of a CAD file, proven to be so (ruled_faces.h)
  kMesh,        ///< a closed triangle mesh: STL, PLY or OBJ, mm; or the bodies of a CAD file in facets
};

/// A face of a CAD file that is to be milled by the flank.
struct RuledFace {
  int number = 0;          ///< in the order of the file, from 1 on
  bool exchanged = false;  ///< guide curve 0, where the tip is, is its other edge
  bool along_u = false;    ///< of a plane, which is ruled both ways: the rulings run along u
  SourceLocation where;
};

struct DesignSettings {
  DesignKind kind = DesignKind::kProgram;
  std::string name = "program";  ///< as in the scene: "hyperboloid"
  double pitch_mm = 0.2;         ///< grid of measuring rays on the design; cusps are refined between them
  bool pitch_given = false;      ///< false: of a body by its size (load_design)
  /// CL scenes: blocks are divided into sweeps that stay this close to their motion for the measuring rays.
  double sweep_tolerance_mm = 2e-5;
  std::string surface_file;            ///< kSurface
  std::string mesh_file;               ///< kMesh
  std::vector<RuledFace> faces;        ///< kRuledFaces, of mesh_file
  std::string mesh_key = "mesh";       ///< that names it: "step" for a CAD file
  std::optional<double> mesh_unit_mm;  ///< of the numbers of a mesh; not said: mm
  Placement placement;                 ///< of mesh_file in the work
  SourceLocation mesh_where;
  double chord_mm = 5e-3;                     ///< CAD files: facets stray no farther from the faces
  std::vector<surface::SurfacePtr> surfaces;  ///< kAnalytic
};

/// Reads [design]; `cl` tells which keys belong there. Without `kind` it is the mesh or the surface whose
/// file is named, else none. Problems go to the table's diagnostics; `surface_file` and `mesh_file` are left
/// as written.
DesignSettings read_design(ConfigTable table, bool cl);

}  // namespace swarf::sim
