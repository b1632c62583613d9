// The facets of a design mesh as sheets that hang together by smooth edges: what rays on a mesh stand on.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <unordered_set>
#include <vector>

#include "base/frames.h"
#include "mesh/tri_mesh.h"
#include "surface/under_facets.h"

namespace swarf::stock {

/// An edge of a mesh whose facets turn by more than the crease angle: the corners of its two ends on either
/// side.
struct SharpEdge {
  std::array<uint32_t, 2> left, right;
  /// Of two curved faces: the edge strays from it by no more. What planes leave is UnderFacets::edge_mm.
  double chord_mm = 0.0;
};

/// A place on a facet, or on the surface under it.
struct FacetPlace {
  Vec3 point, normal;  ///< mm; unit, interpolated between the facet's corners or that of the surface
  uint32_t facet;
};

struct FacetSheets {
  static constexpr uint32_t kNone = 0xffffffffU;

  /// Corners: a vertex is one in each sheet it belongs to. Normals are angle-weighted means over the facets
  /// of the sheet.
  std::vector<Vec3> points, normals;
  std::vector<std::array<uint32_t, 3>> facets;      ///< by their corners, counter-clockwise outside
  std::vector<std::array<uint32_t, 3>> neighbours;  ///< across side k, from corner k to k + 1; kNone: sharp
  std::vector<uint32_t> sheet;                      ///< of each facet: the least facet of its sheet
  std::vector<SharpEdge> sharp_edges;
  std::vector<uint32_t> sources;                   ///< the triangle of the mesh that each facet is
  surface::UnderFacetsPtr under;                   ///< the exact surfaces; null: the facets are the design
  std::vector<std::array<Vec3, 3>> normals_under;  ///< of the surfaces, at the corners of each facet

  /// At corner k of a facet: of the surface under it, or the mean over the sheet.
  const Vec3& normal_at(uint32_t facet, size_t k) const {
    return under != nullptr ? normals_under[facet][k] : normals[facets[facet][k]];
  }
  /// Whether the design over a facet is a curved surface.
  bool is_curved(uint32_t facet) const { return under != nullptr && under->is_curved(sources[facet]); }
  const surface::FacetOnSurface& on_surface(uint32_t facet) const { return under->facets[sources[facet]]; }
  const surface::SurfacePtr& surface_of(uint32_t facet) const {
    return under->surfaces[static_cast<size_t>(on_surface(facet).surface)];
  }
  const Vec3& corner(uint32_t facet, size_t k) const { return points[facets[facet][k]]; }
  FacetPlace place(uint32_t facet, const Vec3& barycentric) const;
  /// On the surface under a curved facet, at its parameters.
  FacetPlace place_at(uint32_t facet, const Vec2& uv) const;
  /// The curved edge that a side of a curved facet stands for; null: none, the side is exact.
  const surface::EdgePlaces* edge_of(uint32_t facet, size_t side) const;

  /// Calls visit(facet) for the facets that hang together with `facet` within a ball, which holds a point of
  /// it; those near it first. Ends when visit returns true.
  template <typename Visit>
  void each_near(uint32_t facet, const Vec3& centre, double radius_mm, const Visit& visit) const;

  /// Where the line point + s `along` meets the sheet of `facet`, within a ball: the first that is met from
  /// the facet on.
  std::optional<FacetPlace> meet(uint32_t facet, const Vec3& centre, double radius_mm, const Vec3& point,
                                 const Vec3& along) const;
  /// The nearest place to a point among those facets.
  FacetPlace nearest(uint32_t facet, const Vec3& centre, double radius_mm, const Vec3& point) const;

 private:
  /// False when the side lies outside the ball.
  bool side_near(uint32_t facet, size_t side, const Vec3& centre, double radius_mm) const;
};

/// Vertices with equal positions count as one, facets without area are left out; an edge of other than two
/// facets, or one where they turn by more than the crease angle, is sharp. Where the surfaces under the
/// facets are known, their normals decide: an edge where they turn by more than kSameTangent is sharp.
FacetSheets facet_sheets(const TriMesh& mesh, double crease_rad, surface::UnderFacetsPtr under = nullptr);

/// Faces that meet in one tangent plane do so within this, rad: what CAD systems call smooth.
inline constexpr double kSameTangent = 1e-3;

template <typename Visit>
void FacetSheets::each_near(uint32_t facet, const Vec3& centre, double radius_mm, const Visit& visit) const {
  std::vector<uint32_t> found{facet};
  std::unordered_set<uint32_t> known;  // looked up only: its order never shows
  for (size_t i = 0; i < found.size(); ++i) {
    const uint32_t here = found[i];
    if (visit(here)) return;
    if (i == 0) known.insert(here);
    for (size_t side = 0; side < 3; ++side) {
      const uint32_t next = neighbours[here][side];
      if (next == kNone || !side_near(here, side, centre, radius_mm)) continue;
      if (known.insert(next).second) found.push_back(next);
    }
  }
}

}  // namespace swarf::stock
