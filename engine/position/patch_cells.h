// Surface patches divided into cells that are small enough to be told from their second derivatives, under a
// tree of bounding spheres (Kato et al., section 2.1; theory 3).
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "surface/face.h"
#include "surface/surface.h"

namespace swarf::position {

/// A surface over the unit square of its parameters, with its four boundary curves and corners.
struct Patch {
  surface::SurfacePtr surface;
  /// Which of its parameters belong to the part; null: the whole square. Where it is trimmed, its loops stop
  /// the tool as edges of their own (face_target.h).
  std::shared_ptr<const surface::FaceDomain> domain = nullptr;
};

/// A rectangle of parameters of one patch, or (patch -1) what bounds several of them. For (s, t) in
/// [-1,1]^2 the place at centre + (s half_u, t half_v) is
///     p + s a + t b + s^2 uu + s t uv + t^2 vv    within `stray`;  mm
/// proven by Taylor's formula about the centre with Surface::bend_bounds, or by those of its halves.
struct PatchCell {
  Vec3 p = Vec3::Zero(), a = Vec3::Zero(), b = Vec3::Zero();
  Vec3 uu = Vec3::Zero(), uv = Vec3::Zero(), vv = Vec3::Zero();
  double stray_uu = 0.0, stray_uv = 0.0,
         stray_vv = 0.0;                            ///< of the last three terms alone, about any place, mm
  double stray = 0.0;                               ///< at most the sum of those, mm
  double radius = 0.0;                              ///< of the sphere about p that holds it, mm
  Vec2 centre = Vec2::Zero(), half = Vec2::Zero();  ///< parameters
  int patch = -1;
  int child = -1;                                     ///< index of the first of two; -1: a leaf
  surface::Region region = surface::Region::kInside;  ///< what of it belongs to the part

  Vec2 low() const { return centre - half; }
  Vec2 high() const { return centre + half; }
};

/// How small the leaves are. The smaller, the fewer steps a position takes and the more memory the cells.
struct CellOptions {
  double most_bend = 0.05;        ///< mm that a leaf may leave its tangent plane by
  double most_stray = 1e-3;       ///< mm that it may leave the quadratic one by
  size_t most_cells = 2'000'000;  ///< of all patches together; 272 bytes each
};

/// Cell of a rectangle of parameters.
PatchCell patch_cell(const surface::Surface& surface, int patch, const Vec2& low, const Vec2& high);
/// A part of a leaf, with the leaf's bounds.
PatchCell part_of(const surface::Surface& surface, const PatchCell& leaf, const Vec2& centre,
                  const Vec2& half);
/// What of a rectangle of parameters belongs to the part.
surface::Region region_of(const Patch& patch, const Vec2& low, const Vec2& high);
/// 0: halves of the cell by u are made of it, 1: by v; the direction in which it is longer.
int longer_side(const PatchCell& cell);

/// All cells; the root is the last. Parallel over the patches; the same for any number of threads. Throws
/// InputError "too-many-cells" when the limit is reached, before more memory is taken, and
/// "patch-not-finite" for a surface without proven bounds.
std::vector<PatchCell> cell_tree(const std::vector<Patch>& patches, const CellOptions& options);

}  // namespace swarf::position
