#include "stock/rays/dexel_kernel.h"

#include <cmath>
#include <vector>

#include "stock/rays/tile_bounds.h"
#include "stock/sweep/sweep_distance.h"

namespace swarf::stock {
namespace {

using kernel::max_of;
using kernel::min_of;

/// Rays flatter than this against the bottom plane are left to ray_height: the quotient loses its digits.
constexpr double kFlattest = 0.01;

/// One end of the sweep as plain numbers, which the compiler keeps in registers.
struct PoseRows {
  double xx, xy, xz, yx, yy, yz, zx, zy, zz, tx, ty, tz;
};

PoseRows pose_rows(const Mat3& Rt, const Vec3& tip) {
  return {Rt(0, 0), Rt(0, 1), Rt(0, 2), Rt(1, 0), Rt(1, 1), Rt(1, 2),
          Rt(2, 0), Rt(2, 1), Rt(2, 2), tip.x(),  tip.y(),  tip.z()};
}

struct PlaneHit {
  double s, x, y, steepness;  ///< height, place in the disc, normal . axis
};

SWARF_KERNEL_INLINE PlaneHit plane_hit(const PoseRows& p, double qx, double qy, double qz, double nx,
                                       double ny, double nz) {
  const double vx = qx - p.tx, vy = qy - p.ty, vz = qz - p.tz;
  const double steepness = p.zx * nx + p.zy * ny + p.zz * nz;
  const double s = -(p.zx * vx + p.zy * vy + p.zz * vz) / max_of(steepness, kFlattest);
  const double wx = vx + s * nx, wy = vy + s * ny, wz = vz + s * nz;
  return {s, p.xx * wx + p.xy * wy + p.xz * wz, p.yx * wx + p.yy * wy + p.yz * wz, steepness};
}

/// No entry lies lower than this: beside the disc the ray must first cross to the flank, and gains at most
/// its sideways share per mm. `lateral` is the greatest sideways share.
SWARF_KERNEL_INLINE double height_bound(const PlaneHit& a, const PlaneHit& b, double radius) {
  const double apart = std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y));
  const double ra = std::sqrt(a.x * a.x + a.y * a.y), rb = std::sqrt(b.x * b.x + b.y * b.y);
  const double least = min_of(a.steepness, b.steepness);
  const double lateral = std::sqrt(max_of(1.0 - least * least, 0.0)) + 1e-9;
  const double gap = max_of(min_of(ra, rb) - 0.5 * apart - radius, 0.0);
  return min_of(a.s, b.s) + gap / lateral;
}

SWARF_KERNEL_INLINE void tile_heights(const TileRays& rays, const SweepMap& map, double radius,
                                      TileHeights& out) {
  const PoseRows start = pose_rows(map.R0t, map.tip0), end = pose_rows(map.R1t, map.tip1);
  const double radius2 = radius * radius;
  for (int n = 0; n < kTileRays; ++n) {
    const double px = rays.px[n], py = rays.py[n], pz = rays.pz[n];
    const double nx = rays.nx[n], ny = rays.ny[n], nz = rays.nz[n];
    const PlaneHit a = plane_hit(start, px, py, pz, nx, ny, nz);
    const PlaneHit b = plane_hit(end, px, py, pz, nx, ny, nz);
    const double farthest2 = max_of(a.x * a.x + a.y * a.y, b.x * b.x + b.y * b.y);
    const bool plane = min_of(a.steepness, b.steepness) > kFlattest;
    out.exact[n] = plane & (farthest2 <= radius2) ? min_of(a.s, b.s) : kNoHeight;
    out.bound[n] = plane ? height_bound(a, b, radius) : -kNoHeight;
  }
}

/// Without the division: s <= top exactly where -z <= top * steepness, and the slack covers both roundings.
SWARF_KERNEL_INLINE bool pose_reaches(const TileRays& rays, const Mat3& Rt, const Vec3& tip,
                                      const double* tops) {
  const double zx = Rt(2, 0), zy = Rt(2, 1), zz = Rt(2, 2), tx = tip.x(), ty = tip.y(), tz = tip.z();
  int reached = 0;
  for (int n = 0; n < kTileRays; ++n) {
    const double top = tops[n] + 2.0 * kBoundSlack;
    const double z = zx * (rays.px[n] - tx) + zy * (rays.py[n] - ty) + zz * (rays.pz[n] - tz);
    const double steepness = zx * rays.nx[n] + zy * rays.ny[n] + zz * rays.nz[n];
    reached |= (steepness <= kFlattest) | (-z <= top * steepness);
  }
  return reached != 0;
}

SWARF_KERNEL_INLINE bool begins_where_ends(const SweepMap& next, const SweepMap& before) {
  return next.tip0 == before.tip1 && next.R0t.row(2) == before.R1t.row(2);
}

SWARF_KERNEL_INLINE uint32_t planes_reach(const TileRays& rays, std::span<const SweepMap> maps,
                                          const double* tops) {
  uint32_t reached = 0;
  bool known = false, at_end = false;  // of the sweep before
  for (size_t k = 0; k < maps.size(); ++k) {
    const SweepMap& map = maps[k];
    const bool same = known && begins_where_ends(map, maps[k - 1]);
    const bool at_start = same ? at_end : pose_reaches(rays, map.R0t, map.tip0, tops);
    known = !at_start;
    if (known) at_end = pose_reaches(rays, map.R1t, map.tip1, tops);
    reached |= static_cast<uint32_t>(at_start || at_end) << k;
  }
  return reached;
}

SWARF_KERNEL_INLINE Lowering cut_by_disc(const TileRays& rays, const SweepMap& map, double radius,
                                         double block, TileMaterial& material) {
  const PoseRows start = pose_rows(map.R0t, map.tip0), end = pose_rows(map.R1t, map.tip1);
  const double radius2 = radius * radius;
  int changed = 0, left = 0;
  for (int n = 0; n < kTileRays; ++n) {
    const double px = rays.px[n], py = rays.py[n], pz = rays.pz[n];
    const double nx = rays.nx[n], ny = rays.ny[n], nz = rays.nz[n];
    const PlaneHit a = plane_hit(start, px, py, pz, nx, ny, nz);
    const PlaneHit b = plane_hit(end, px, py, pz, nx, ny, nz);
    const double farthest2 = max_of(a.x * a.x + a.y * a.y, b.x * b.x + b.y * b.y);
    const double s = min_of(a.s, b.s), height = material.heights[n], owner = material.blocks[n];
    const bool plane = min_of(a.steepness, b.steepness) > kFlattest;
    const bool known = plane & (farthest2 <= radius2) & (s > -kNoteworthy);
    const bool lower = known & ((s < height) | ((s == height) & (block < owner)));
    left |= !known & (!plane | (s <= height + kBoundSlack));
    changed |= lower;
    material.heights[n] = lower ? s : height;
    material.blocks[n] = lower ? block : owner;
  }
  return {changed != 0, left != 0};
}

uint32_t planes_reach_baseline(const TileRays& rays, std::span<const SweepMap> maps, const double* tops) {
  return planes_reach(rays, maps, tops);
}

SWARF_X86_64_V3 uint32_t planes_reach_v3(const TileRays& rays, std::span<const SweepMap> maps,
                                         const double* tops) {
  return planes_reach(rays, maps, tops);
}

SWARF_X86_64_V4 uint32_t planes_reach_v4(const TileRays& rays, std::span<const SweepMap> maps,
                                         const double* tops) {
  return planes_reach(rays, maps, tops);
}

Lowering cut_by_disc_baseline(const TileRays& rays, const SweepMap& map, double radius, double block,
                              TileMaterial& material) {
  return cut_by_disc(rays, map, radius, block, material);
}

SWARF_X86_64_V3 Lowering cut_by_disc_v3(const TileRays& rays, const SweepMap& map, double radius,
                                        double block, TileMaterial& material) {
  return cut_by_disc(rays, map, radius, block, material);
}

SWARF_X86_64_V4 Lowering cut_by_disc_v4(const TileRays& rays, const SweepMap& map, double radius,
                                        double block, TileMaterial& material) {
  return cut_by_disc(rays, map, radius, block, material);
}

void tile_heights_baseline(const TileRays& rays, const SweepMap& map, double radius, TileHeights& out) {
  tile_heights(rays, map, radius, out);
}

SWARF_X86_64_V3 void tile_heights_v3(const TileRays& rays, const SweepMap& map, double radius,
                                     TileHeights& out) {
  tile_heights(rays, map, radius, out);
}

SWARF_X86_64_V4 void tile_heights_v4(const TileRays& rays, const SweepMap& map, double radius,
                                     TileHeights& out) {
  tile_heights(rays, map, radius, out);
}

}  // namespace

std::span<const DexelKernelVariant> dexel_kernel_variants() {
  static const std::vector<DexelKernelVariant> variants = runnable<DexelKernelVariant>(
      {"x86-64-v4", tile_heights_v4, planes_reach_v4, cut_by_disc_v4},
      {"x86-64-v3", tile_heights_v3, planes_reach_v3, cut_by_disc_v3},
      {"baseline", tile_heights_baseline, planes_reach_baseline, cut_by_disc_baseline});
  return variants;
}

}  // namespace swarf::stock
