// The rays that measure a design: feet on it, outward normals, the area each stands for, and who is next to
// whom. One plain structure for parametric surfaces and triangle meshes; what the cutter leaves on the rays
// is in SurfaceDexels.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/frames.h"
#include "mesh/mesh_distance.h"
#include "mesh/tri_mesh.h"
#include "surface/surface.h"

namespace swarf::stock {

/// Up to 64 neighbouring rays that are cut together: an oriented box around their feet and a cone around
/// their normals. Its rays are order[begin .. begin + count).
struct RayTile {
  uint32_t begin = 0, count = 0;
  Vec3 origin = Vec3::Zero();                    ///< of the frame below, W
  Mat3 frame = Mat3::Identity();                 ///< rows e1, e2, mean normal
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< feet in the frame, mm
  double normal_spread = 0.0;                    ///< greatest |normal - mean normal|
};

/// A place on the design, between the rays too.
struct Foot {
  Vec3 point, normal;       ///< W, mm; unit, out of the material
  double u = 0.0, v = 0.0;  ///< parametric designs only
};

/// The mesh that rays stand on, with its own distances.
struct DesignMesh {
  explicit DesignMesh(const TriMesh& design) : mesh(design), distance(mesh) {}
  DesignMesh(const DesignMesh&) = delete;
  DesignMesh& operator=(const DesignMesh&) = delete;

  const TriMesh mesh;
  const mesh::MeshDistance distance;
};

/// An edge of a mesh whose facets turn by more than the crease angle: the rays of its two ends on either
/// side.
struct SharpEdge {
  std::array<uint32_t, 2> left, right;
};

struct RayField {
  std::vector<Vec3> points, normals;               ///< W, mm; unit, out of the material
  std::vector<double> areas_mm2;                   ///< the share of the design's area each ray stands for
  std::vector<std::array<uint32_t, 2>> edges;      ///< neighbouring rays; no edge runs across a crease
  std::vector<std::array<uint32_t, 3>> triangles;  ///< the design between the rays, counter-clockwise outside
  std::vector<uint32_t> order;                     ///< rays, tile by tile
  std::vector<RayTile> tiles;
  double pitch_mm = 0.0, chord_mm = 0.0;  ///< as asked for

  /// Parametric designs: ray iv * nu + iu stands at (u_lines[iu], v_lines[iv]). Null for meshes.
  surface::SurfacePtr surface;
  std::vector<double> u_lines, v_lines;

  size_t size() const { return points.size(); }
  /// The place between rays a (t = 0) and b (t = 1): on a surface at the interpolated (u,v), on a mesh at the
  /// interpolated foot and normal.
  Foot between(uint32_t a, uint32_t b, double t) const;
  /// The foot of one ray displaced by `tangent_mm` (perpendicular to its normal): on a surface by the first
  /// order in (u,v), on a mesh on the facets up to two edges away. Nothing beyond the end of either.
  std::optional<Foot> displaced(uint32_t ray, const Vec3& tangent_mm) const;

  /// How much of a cut `depth_mm` below a foot (at `point`, mm, outward `normal`) is the foot's to answer
  /// for: down to where another face of the design is nearer (the medial ball inside the part). A tool that
  /// touches a wall's edge along the floor cuts the whole length of the wall's ray, but the depth of the
  /// gouge is the floor's. On a parametric surface, which bounds no body, all of it.
  /// `share`: how closely, of the result; found is the lower end.
  double own_depth(const Vec3& point, const Vec3& normal, double depth_mm, double share = 1e-9) const;

  /// Meshes: the facets before their division, by the rays at their corners, and the sharp edges.
  std::vector<std::array<uint32_t, 3>> facets;
  std::vector<SharpEdge> sharp_edges;
  /// Meshes: the mesh as it was given.
  std::shared_ptr<const DesignMesh> design;
  /// Meshes: the triangles around ray n are star[star_begin[n] .. star_begin[n + 1]).
  std::vector<uint32_t> star_begin, star;
};
using RayFieldPtr = std::shared_ptr<const RayField>;

/// A grid along the parameters of about `pitch_mm`. Where the chord between two feet strays from the surface
/// by more than `chord_mm`, its grid interval is divided evenly until it does not: fillets get their rays.
RayFieldPtr rays_on_surface(const surface::SurfacePtr& surface, double pitch_mm, double chord_mm = 0.005);

/// Edges whose facets turn by more than this are sharp: their rays stand twice, once per side; rad (30 deg).
inline constexpr double kCrease = 0.5235987755982988;

/// Feet on the facets of the mesh, which are divided until no edge is longer than `pitch_mm`. Vertices with
/// equal positions count as one; normals are angle-weighted means over the facets that hang together by
/// smooth edges, interpolated in between. Facets without area carry no rays. The mesh must have facets with
/// area.
RayFieldPtr rays_on_mesh(const TriMesh& mesh, double pitch_mm, double crease_rad = kCrease);

/// Appends a tile of the rays order[begin ..] to the field; for the two makers.
void add_tile(RayField& field, uint32_t begin);

}  // namespace swarf::stock
