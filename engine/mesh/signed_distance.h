// Signed distance to a triangle mesh: the sign by the pseudo-normal of the nearest face, edge or vertex.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "base/frames.h"
#include "mesh/mesh_distance.h"
#include "mesh/mesh_lines.h"
#include "mesh/tri_mesh.h"

namespace swarf::mesh {

/// What a point sees of a mesh.
struct SignedPoint {
  double distance_mm =
      std::numeric_limits<double>::infinity();  ///< > 0 on the side that the normals point to
  Vec3 foot = Vec3::Zero();                     ///< the nearest point of the mesh
  Vec3 normal = Vec3::UnitZ();  ///< unit, there: of the face, or the pseudo-normal of the edge or vertex
  uint32_t triangle = 0;        ///< of SignedDistance::mesh()
  /// How far the point lies beyond the border of an open mesh: across the foot's normal, 0 elsewhere.
  double beyond_mm = 0.0;
};

/// An edge's pseudo-normal is the sum of its faces' unit normals, a vertex's their sum weighted by the
/// corners' angles: with these (p - foot).normal has the sign of the distance for every closed mesh
/// (Baerentzen & Aanaes, Signed distance computation using the angle weighted pseudonormal, 2005). On an open
/// mesh the sign is that of the sheet's side.
/// Facets without area have no normal. Where one lies in an edge, the faces on its two sides meet there all
/// the same: a long side on one, several short ones on the other.
/// Where a mesh runs through itself, or folds flat upon itself, its nearest face may be seen from the wrong
/// side, from however far away. Of a mesh that may, points farther from it than its error are inside where it
/// winds around them at least once.
class SignedDistance {
 public:
  /// Vertices with equal positions count as one; triangles without area are left out. The mesh must have one
  /// with area.
  explicit SignedDistance(const TriMesh& mesh);
  /// Of a closed mesh that may run through itself, all of which lies within `error_mm` of the solid that it
  /// stands for.
  SignedDistance(const TriMesh& mesh, double error_mm);
  SignedDistance(const SignedDistance&) = delete;
  SignedDistance& operator=(const SignedDistance&) = delete;

  /// `within_mm`: nothing farther is looked for; its distance is +infinity then.
  SignedPoint at(const Vec3& p, double within_mm = std::numeric_limits<double>::infinity()) const;

  /// Infinite of meshes that do not run through themselves, mm.
  double error_mm() const { return error_mm_; }
  const TriMesh& mesh() const { return mesh_; }  ///< welded, positions only
  const MeshDistance& tree() const { return *tree_; }
  Vec3 corner(uint32_t triangle, size_t place) const;
  const Vec3& face_normal(uint32_t triangle) const { return face_normals_[triangle]; }
  /// The facet across each side (3 * triangle + place of the side's first corner), kBorder without one.
  const std::vector<uint32_t>& across() const { return across_; }
  static constexpr uint32_t kBorder = 0xffffffffU;
  /// The same where facets without area lie between: the side of which facet is there depends on the place.
  static constexpr uint32_t kSeam = 0xfffffffeU;

 private:
  Vec3 pseudo_normal(const NearestPoint& nearest, bool& border) const;
  bool winds_around(const Vec3& p) const;
  void join_sides(const TriMesh& welded, const std::vector<uint32_t>& number);
  void add_vertex_normals();
  void add_seam_normals();
  const Vec3& normal_across_seam(uint32_t side, const Vec3& point) const;

  TriMesh mesh_;
  std::unique_ptr<MeshDistance> tree_;
  double error_mm_ = std::numeric_limits<double>::infinity();
  mutable std::once_flag lines_once_;
  mutable std::unique_ptr<MeshLines> lines_;  ///< made when first asked for: most meshes never are
  std::vector<Vec3> face_normals_, vertex_normals_;
  std::vector<uint32_t> across_;
  std::vector<uint8_t> on_border_;  ///< per vertex
  /// Sides of facets with area along facets without, by seam.
  std::vector<std::vector<uint32_t>> seams_;
  std::unordered_map<uint32_t, uint32_t> seam_of_;  ///< per side; looked up only: its order never shows
};

}  // namespace swarf::mesh
