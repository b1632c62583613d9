// How high a cell of a patch can stop the tip at most.
//
// The underside w(|x|) is convex: for every slope vector q it lies above a plane, w(|x|) >= q.x - lift(|q|),
// so with n = (-q, 1)
//
//     f = z - w(|x|)  <=  n.p + lift(|q|)         over the whole patch, whatever q is,            (1)
//
// and n.p is bounded over a cell by its quadratic. At a contact p*, where n is normal to the surface, that is
// the tangent plane: exact where the part is convex. Where it is hollow, w rises above its own plane faster
// than the surface leaves it; with a = e.(x - x*) out from the axis and b = t.(x - x*) round it
//
//     w(|x|) >= w* + q.(x - x*) + (mu_r a^2 + mu_t b^2) / 2        over the cell,
//     f      <= f* + n.(p - p*) - (mu_r a^2 + mu_t b^2) / 2                                       (2)
//
// which is a quadratic form in (u,v): where it has no positive eigenvalue, f* is the cell's maximum.
// mu from the convexity of w alone, with D the least 2 (w(s) - w* - q (s - rho*)) / (s - rho*)^2 over the
// cell:
//   mu_r = D over s = e.x, mu_t = w'(least e.x) / max|x|:  w(s) >= w(e.x) + w'(e.x) (s - e.x), where
//          s - e.x >= b^2 / (2 max|x|)
//   mu_r = mu_t = m = min(D over s = |x|, q/rho*):  |x - x*|^2 = s^2 + rho*^2 - 2 rho* e.x, so that what is
//   to be
//          shown is linear in e.x, worst at e.x = s since q >= m rho*, and is D >= m there
//   on the point of a drill of slope k: mu_r = mu_t = 2 (k - |q|) / max|x|
#pragma once

#include "position/patch_footing.h"

namespace swarf::position {

/// A plane under the tool, to bound f by (1); with `modulus` a paraboloid, to bound it by (2) over all
/// patches with the least mu of the whole tool: f <= n.p + offset - modulus |x - foot|^2 / 2.
struct Support {
  Vec3 normal_W = Vec3::Zero();  ///< n; its component along the tool's axis is 1
  double length = 0.0;           ///< |n|
  double offset = 0.0;           ///< mm
  double modulus = 0.0;          ///< 1/mm
  Vec2 foot = Vec2::Zero();      ///< x*
};
Support support_plane(const ToolProfile& profile, const GuideLine& line, const Vec2& slope);
/// Of the contact `at`.
Support support_paraboloid(const ToolProfile& profile, const GuideLine& line, const Footing& at);

/// The greatest f that the support allows over the cell, mm; no lower than needed to see that it is at most
/// `enough`.
double support_bound(const PatchCell& cell, const Support& support, const GuideLine& line, double enough);

/// By what the cell's sphere, `known` (of a contact found before; may be null) and a plane of the cell's own
/// allow, mm: -infinity where the cutter cannot touch it. No lower than needed to see that it is at most
/// `enough`.
double cell_bound(const PatchCell& cell, const ToolProfile& profile, const GuideLine& line,
                  const Support* known, double enough);

/// How much higher than `at.height` f may be anywhere in the cell, by (2); mm, >= 0. `at` lies in the cell
/// and under the tool; the cell is one of its patch.
double excess_bound(const PatchCell& cell, const Footing& at, const ToolProfile& profile,
                    const GuideLine& line);

/// Whether f rises all over the cell, one of a patch, in one direction of the parameters: whatever part of
/// the cell belongs to the work piece, f is greatest on the edges of that part, not inside. With D the way
/// that the place goes, and e the direction out from the axis,
///     df = D.z - w'(rho; e.D)  >=  least D.z - max(w'(greatest rho) m, w'(least rho) m),  m = greatest e.D
/// with the extent of D by the bends.
bool rises_everywhere(const PatchCell& cell, const ToolProfile& profile, const GuideLine& line);

/// Whether the whole cell, one of a patch, lies beyond the rim of the tool. `nearest` is a place of the cell:
/// the nearer to the axis it is among them, the more it shows, by the quadratic form of the squared distance.
bool beyond_rim(const PatchCell& cell, const Footing& nearest, const ToolProfile& profile,
                const GuideLine& line);

}  // namespace swarf::position
