// How far flank milling misses a ruled surface (theory 5, Chu et al.).
//
//      TC1 ----axis---- TC0            C0, C1   guide curves: S(u,v) = (1-v) C0(u) + v C1(u)
//       |                |             N0, N1   outward normals of S at (u,0) and (u,1)
//       r N1             r N0          TC0 = C0 + r N0,  TC1 = C1 + r N1: the paper's placement
//       |                |
//      C1 ----ruling--- C0             psi = angle(N0, N1): the twist of the ruling
//
// The cutter touches S at both guide curves and cuts r(1-cos(psi/2)) too deep half way (E18): a standing axis
// lies that much nearer to the middle of the ruling than r. Moving on, neighbouring poses and the chords of
// the blocks add to it.
//
// Conventions. Every error is the least of (distance of a surface point to the axis) - r in mm: negative
// means too deep. The axis is the segment between its guide points, the axis surface of a block the bilinear
// patch of theory 5, bounded by the guide points and by the ends of the pass; beyond it the cutter is round.
// The cutter stands on the side of the outward normal. Distances are to the nearest point of all blocks, not
// only to the block that a surface point belongs to.
#pragma once

#include <vector>

#include "surface/surface.h"

namespace swarf::measure {

/// The deepest place of one kind of motion.
struct FlankDepth {
  double error_mm = 0.0;    ///< least of distance - r
  double u = 0.0, v = 0.0;  ///< where on the surface
};

struct FlankRow {
  int blocks = 0;  ///< equal in u, their guide points move linearly
  FlankDepth envelope;
};

struct FlankError {
  double cutter_radius_mm = 0.0;
  double psi_max_rad = 0.0;
  double psi_max_u = 0.0;
  double twist_bound_mm = 0.0;     ///< r(1-cos(psi_max/2)) of E18: no feed and no block count goes below it
  double standing_error_mm = 0.0;  ///< every ruling against its own axis, standing: the deepest
  double standing_u = 0.0;
  FlankDepth continuous;       ///< the axis on both guide curves at every instant
  std::vector<FlankRow> rows;  ///< blocks 1, 2, 4, 8, 16, 32
};

/// True when S is linear in v: S_vv vanishes on a grid, to 1e-9 of the ruling's length.
bool is_ruled(const surface::Surface& surface);

/// Angle between the outward normals at both ends of a ruling, rad.
double ruling_twist(const surface::Surface& surface, double u);

/// The axis of the paper's placement stands at u: least of distance - r along the ruling, mm.
double standing_error(const surface::Surface& surface, double radius_mm, double u);

/// Envelope error of n blocks. The surface is searched on a grid of at least 257 x 33 points, and every local
/// minimum of it is followed down to 1e-9 mm. Exact distances make that grid tell: where the surface is d
/// away from the axis, the error between four points of the grid lies at most (cell diagonal)^2 / (8 d) below
/// the least of them (a distance bends down by at most 1/d), so no minimum deeper than that escapes.
FlankDepth block_envelope_error(const surface::Surface& surface, double radius_mm, int blocks);

/// The same with the axis on the guide curves at every instant: blocks without end.
FlankDepth continuous_envelope_error(const surface::Surface& surface, double radius_mm);

/// All of it. Needs is_ruled(surface), a normal at every guide point, and radius_mm > 0. The same bits for
/// any number of threads.
FlankError flank_error(const surface::Surface& surface, double radius_mm);

}  // namespace swarf::measure
