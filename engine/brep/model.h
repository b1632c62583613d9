// What a CAD file holds, as plain structures in mm: solids, their faces as NURBS with loops, edges.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/placement.h"
#include "mesh/tri_mesh.h"
#include "surface/face.h"
#include "surface/under_facets.h"

namespace swarf::brep {

/// The shape as the library behind this folder holds it; nobody else looks inside.
struct Shape;

/// Faces that hang together.
struct Solid {
  std::string name;           ///< of the file; of its product where it has none; may be empty
  bool closed = false;        ///< its faces enclose a volume
  std::vector<size_t> faces;  ///< of Model::faces
  double area_mm2 = 0.0;      ///< by quadrature over the faces
  double volume_mm3 = 0.0;    ///< the same; above 0 where it is closed
};

struct Edge {
  std::vector<Vec3> points;   ///< mm; a polyline along it, closed where the first is the last
  double chord_mm = 0.0;      ///< it strays by no more from the curve at the places tried
  double tolerance_mm = 0.0;  ///< of the file: faces that share it lie this near to it
  double gap_mm = 0.0;  ///< the faces that share it lie so far apart, the widest of some places along it
  Vec3 gap_at = Vec3::Zero();
};

struct Model {
  std::string file;
  std::string unit;                  ///< as the file calls it: "INCH"
  double mm_per_unit = 1.0;          ///< what was multiplied in
  std::vector<Solid> solids;         ///< closed ones first or not, in the file's order
  std::vector<surface::Face> faces;  ///< each of them smooth: a face with a crease is several
  int face_count = 0;                ///< of the file; Face::number runs to it
  std::vector<Edge> edges;           ///< each once
  std::vector<Vec3> vertices;        ///< mm
  double edge_tolerance_mm = 0.0;    ///< the greatest of the edges
  std::vector<Diagnostic> warnings;  ///< what was not read or was mended
  std::shared_ptr<const Shape> shape;
};

/// Both throw InputError: "cad-unreadable" (missing, no such file, cut off), "cad-empty" (nothing with
/// faces), "cad-no-unit", "cad-surface" (a surface that cannot be taken). What else the file holds and this
/// does not take is a warning "cad-not-read" with the entity's number and name. Planes, cylinders, cones,
/// spheres and tori become rational patches exactly; offset surfaces are approximated, which a warning tells.
/// Instances of an assembly stand where they are placed, and the whole where `placement` puts it.
Model read_step(const std::string& path, const Placement& placement = {});
inline constexpr double kSewing = 1e-3;  ///< mm
/// Faces that hang together within `sewing_mm` become shells, since IGES seldom tells.
Model read_iges(const std::string& path, double sewing_mm = kSewing, const Placement& placement = {});
/// By the ending: .stp, .step, .p21, .igs, .iges (any case).
Model read_cad(const std::string& path, const Placement& placement = {});
bool is_cad_file(const std::string& path);

/// The shape in flat facets.
struct Facets {
  TriMesh mesh;  ///< watertight where the shells are; closed solids turned outward
  /// No place of the faces is farther than this from the facet over it: proven by the bends of the patches;
  /// mm. The mesh's own rounding to float is included. Along the edges facets end on chords that the library
  /// keeps within what was asked for at the places it tries.
  double chord_mm = 0.0;
  double strays_mm = 0.0;  ///< the same as a distance, wherever on the facet: less where facets lie askew
  bool proven = true;      ///< false: a face has a crease inside, whose facets are held at some places only
  /// Where each facet lies on its face; facets across a crease inside a face have no surface.
  surface::UnderFacetsPtr under;
  size_t across_creases = 0;  ///< how many those are
};
/// Edges are divided no more coarsely, however coarse the facets may be: they say where faces end; mm.
inline constexpr double kEdgeChord = 2e-3;
/// Facets asked for with a chord of `chord_mm`, their sides along the edges with one of `edge_mm`; divided
/// further until the proof of the first holds, and what is proven is told. Closed solids only where
/// `closed_only`.
Facets tessellate(const Model& model, double chord_mm, bool closed_only = false, double edge_mm = kEdgeChord);

}  // namespace swarf::brep
