// The rays that measure a design: feet on it, outward normals, the area each stands for, and who is next to
// whom. One plain structure for parametric surfaces and triangle meshes; what the cutter leaves on the rays
// is in SurfaceDexels.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/frames.h"
#include "mesh/mesh_distance.h"
#include "mesh/tri_mesh.h"
#include "stock/rays/facet_sheets.h"
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
  explicit DesignMesh(const TriMesh& design, surface::UnderFacetsPtr faces = nullptr)
      : mesh(design), distance(mesh), under(std::move(faces)) {}
  DesignMesh(const DesignMesh&) = delete;
  DesignMesh& operator=(const DesignMesh&) = delete;

  const TriMesh mesh;
  const mesh::MeshDistance distance;
  const surface::UnderFacetsPtr under;  ///< null: the facets are the design

  /// A place of a facet, or of the surface under it.
  struct Place {
    Vec3 point = Vec3::Zero();
    Vec2 uv = Vec2::Zero();  ///< of a curved facet, in the parameters of its surface
    double distance_mm = std::numeric_limits<double>::infinity();
    uint32_t triangle = 0;
  };
  /// The place over one facet that is nearest to a point: of a curved one by Newton's steps from the place
  /// over the facet's own nearest one (surface_foot.h).
  Place nearest_on(uint32_t triangle, const Vec3& point) const;
  /// The place of the whole design that is nearest to a point. Surfaces stray from their facets by up to
  /// UnderFacets::chord_mm, so every facet is looked at that is no more than twice that farther than the
  /// nearest. `within_mm`: as of MeshDistance::nearest().
  Place nearest(const Vec3& point, double within_mm = std::numeric_limits<double>::infinity()) const;
};

/// A depth below a foot is the foot's own while the design is at least this share of it away, less the
/// rounding of meshes: nearly all where columns follow the design's own normal; where they follow a mesh's
/// interpolated ones, which lean up to the crease's angle from the facets, cos 30 deg and a little for
/// rounding.
inline constexpr double kOwnShare = 1.0 - 1e-4, kOwnShareLeaning = 0.85;
inline constexpr double kFloatMesh = 2e-5;  ///< mm: vertices are floats

struct RayField {
  std::vector<Vec3> points, normals;           ///< W, mm; unit, out of the material
  std::vector<double> areas_mm2;               ///< the share of the design's area each ray stands for
  std::vector<std::array<uint32_t, 2>> edges;  ///< neighbouring rays; no edge runs across a crease
  /// Parametric designs: the design between the rays, counter-clockwise outside.
  std::vector<std::array<uint32_t, 3>> triangles;
  std::vector<uint32_t> order;  ///< rays, tile by tile
  std::vector<RayTile> tiles;
  double pitch_mm = 0.0, chord_mm = 0.0;  ///< as asked for

  /// Parametric designs: ray iv * nu + iu stands at (u_lines[iu], v_lines[iv]). Null for meshes.
  surface::SurfacePtr surface;
  std::vector<double> u_lines, v_lines;

  size_t size() const { return points.size(); }
  /// The place between rays a (t = 0) and b (t = 1): on a surface at the interpolated (u,v), on a mesh on the
  /// facets under or over the interpolated foot, along the interpolated normal.
  Foot between(uint32_t a, uint32_t b, double t) const;
  /// The foot of one ray displaced by `tangent_mm` (perpendicular to its normal): on a surface by the first
  /// order in (u,v), on a mesh on the facets of its sheet around it. Nothing beyond the end of either.
  std::optional<Foot> displaced(uint32_t ray, const Vec3& tangent_mm) const;

  /// How much of a cut `depth_mm` below a foot (at `point`, mm, outward `normal`) is the foot's to answer
  /// for: down to where another face of the design is nearer (the medial ball inside the part). A tool that
  /// touches a wall's edge along the floor cuts the whole length of the wall's ray, but the depth of the
  /// gouge is the floor's. On a parametric surface, which bounds no body, all of it.
  /// `share`: how closely, of the result; found is the lower end.
  double own_depth(const Vec3& point, const Vec3& normal, double depth_mm, double share = 1e-9) const;
  /// Whether a cut whose upper end lies at `high` (mm along the normal) is the foot's: one that leaves what
  /// is the foot's own standing, or its skin, belongs to another face.
  bool answers_for(const Vec3& point, const Vec3& normal, double high) const;

  /// Meshes: the facets, by the sheets that rays stand on, and the facet that holds each ray's foot.
  std::shared_ptr<const FacetSheets> sheets;
  std::vector<uint32_t> facet_of;
  /// Meshes: places that are denser than the rays, which tell where the design rises beside a ray
  /// (free_ranges.h). Null: the rays themselves do.
  std::shared_ptr<const RayField> walls;
  /// Meshes: the mesh as it was given.
  std::shared_ptr<const DesignMesh> design;
};
using RayFieldPtr = std::shared_ptr<const RayField>;

/// A grid along the parameters of about `pitch_mm`. Where the chord between two feet strays from the surface
/// by more than `chord_mm`, its grid interval is divided evenly until it does not: fillets get their rays.
RayFieldPtr rays_on_surface(const surface::SurfacePtr& surface, double pitch_mm, double chord_mm = 0.005);

/// Edges whose facets turn by more than this are sharp: their rays stand twice, once per side; rad (30 deg).
inline constexpr double kCrease = 0.5235987755982988;

/// No place of a mesh is farther than this from a ray of its own sheet; of the pitch (see rays_on_mesh).
inline constexpr double kFarthestRay = 1.2;

/// Feet on the facets of the mesh, as many as the pitch asks for however the facets are cut: where the sheet
/// (facets that hang together by smooth edges) is flat they stand on a square grid of `pitch_mm`, elsewhere
/// they are picked greedily: corners of a sheet first, then its borders, its inside, and last what is left.
/// - Two rays of a sheet are at least 0.8 pitches apart unless their normals turn by more than the crease
///   angle, so that fillets keep theirs, or one is on the border of the sheet: about one ray per square of
///   the pitch.
/// - A ray on a border answers for no depth (RayField::own_depth), so that one within may stand as near to it
///   as 0.3 pitches: the middle of a thin wall keeps its ray.
/// - Places 1/3 pitch apart on every facet and side are offered, and refused only if a ray stands within 0.8
///   pitches: no place is farther from a ray of its sheet than kFarthestRay (0.8 + 0.24 to the border of a
///   facet + 1/6 along it).
/// - Both sides of a sharp edge are borders of sheets, each with rays of its own; a sheet has at least one.
/// What is proven between the rays (measure/certificate.h) rests on the facets themselves, not on the rays:
/// rays find, cells of facets and sharp edges prove.
/// Vertices with equal positions count as one; normals are angle-weighted means over the facets that hang
/// together by smooth edges, interpolated in between. Facets without area carry no rays. Neighbours are the
/// rays of a sheet with no third one in the ball on their connection (Gabriel graph: it is connected where
/// the sheet is). The mesh must have facets with area.
/// With the surfaces under the facets, feet and normals are those of the surfaces, and so is all that is
/// between the rays; the facets tell their borders, what lies beside what, and which face is nearest, within
/// UnderFacets::chord_mm.
RayFieldPtr rays_on_mesh(const TriMesh& mesh, double pitch_mm, double crease_rad = kCrease,
                         const surface::UnderFacetsPtr& under = nullptr);

/// Rays that somebody else has set on a design mesh: they are cut like those of rays_on_mesh and answer for
/// the same depths, but have neither areas nor neighbours. `pitch_mm`: about how far they are apart.
RayFieldPtr rays_at(std::vector<Vec3> points, std::vector<Vec3> normals,
                    std::shared_ptr<const DesignMesh> design, double pitch_mm);

/// Appends a tile of the rays order[begin ..] to the field; for the makers.
void add_tile(RayField& field, uint32_t begin);

}  // namespace swarf::stock
