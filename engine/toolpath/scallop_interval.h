// Scallop height and path interval in closed form (Lin & Koren 1996, Eq. 1 and 2, and their generalisation).
//
//        |<------ P ------>|          flat bottoms are tangent planes at p1 and p2; they meet h above the
//     ___p1       ^h       p2___      surface, half way. P is the chord between the contact points.
//
// Convex curvatures are positive, 1/mm; lengths are mm; K is the shape matrix in an orthonormal tangent
// frame. An infinite radius (zero curvature) is legal everywhere: a flat end leaves no scallop on a plane.
#pragma once

#include "base/frames.h"

namespace swarf::toolpath {

/// Chord between adjacent passes of a flat end on the normal of a circle of radius R that leaves the scallop
/// h: P = (2R/(R+h)) sqrt(2Rh + h^2) (Lin & Koren, Eq. 2).
double chord_for_scallop(double radius_mm, double scallop_mm);

/// The scallop that a chord leaves, h = R (1/cos(theta) - 1) with sin(theta) = P/2R (Eq. 1). Needs P < 2R.
double scallop_for_chord(double radius_mm, double chord_mm);

/// Longest chord at which a flat end of this diameter still reaches the cusp: D R/(R+h). (The paper's P <= D
/// is too lax, erratum E2.)
double reach_limit(double diameter_mm, double radius_mm, double scallop_mm);

/// Scallop at which chord_for_scallop meets reach_limit: sqrt(R^2 + (D/2)^2) - R.
double largest_reachable_scallop(double diameter_mm, double radius_mm);

/// Curvature across the feed, c'Kc with c perpendicular to the unit feed t: the paper's 1/R. Exact for a
/// principal feed, else it makes the interval too small.
double cross_curvature(const Mat2& K, const Vec2& unit_feed);

/// det M / (t'Mt), the curvature that counts between passes along t: the envelope of the tool bottoms leaves
/// h = (P^2/8) det M/(t'Mt). For a flat end on the normal M = K, and this is 1/R with R = kappa_t/K_G
/// (erratum E3). Computed as c'Mc - (t'Mc)^2/(t'Mt), which stays finite when the feed is straight (t'Mt = 0).
double strip_curvature(const Mat2& M, const Vec2& unit_feed);

/// Ratio by which the touching point of the cusp lies farther away than half the chord, because the tool that
/// cuts it stands along the direction conjugate to the feed: sqrt(1 + (t'Kc/t'Kt)^2) >= 1.
double conjugate_stretch(const Mat2& K, const Vec2& unit_feed);

/// How the tool axis leans: by `angle` away from the normal, towards the direction that lies `yaw` to the
/// left of the feed. rad.
struct Lean {
  double angle = 0.0;
  double yaw = 0.0;
  bool on_normal() const { return angle == 0.0; }
};

/// Which side of the feed two adjacent passes see each other on. The rim of a leaned tool bends away from the
/// lean, so with yaw the two flanks of a cusp differ; when the passes run the same way they balance each
/// other.
enum class RimSides {
  kBalanced,  ///< same direction of travel, or no yaw
  kBothLeft,  ///< opposite directions (zigzag), the strip lies to the left of both
  kBothRight,
};

/// What a leaned tool feels of the shape matrix: m towards the lean, c square to it.
struct LeanedCurvature {
  double across = 0.0;  ///< c'Kc, 1/mm; concave < 0
  double twist = 0.0;   ///< c'Km, 1/mm
};
LeanedCurvature leaned_curvature(const Mat2& K, const Vec2& unit_feed, const Lean& lean);

/// Leaned flat end of radius r. The rim point that is x away from the contact along c lies b = r (1 -
/// sqrt(1-y)) cos(phi) back from it, y = x^2/r^2; it stands r sin(phi) (1 - sqrt(1-y)) above the tangent
/// plane, and the surface falls c'Kc x^2/2 - c'Km x b away below it:
///     r sin(phi) (1 - sqrt(1-y)) + c'Kc x^2/2 -+ c'Km x b = h,      P = 2 (x cos(omega) -+ b sin(omega))
/// with the upper sign for a strip on the left of both passes, and neither term when they balance. Exact on a
/// plane; for small h it is P = sqrt(8 h R), 1/R = det M/(t'Mt) = 1/R_eff + c'Kc/cos^2(omega), with the
/// radius of the swept cross section R_eff = r cos^2(omega)/sin(phi). The chord for h, and the h that a chord
/// leaves; x ends at the rim, x = r.
double leaned_chord(const LeanedCurvature& curvature, double scallop_mm, const Lean& lean, double radius_mm,
                    RimSides sides);
double leaned_scallop(const LeanedCurvature& curvature, double chord_mm, const Lean& lean, double radius_mm,
                      RimSides sides);

/// Ball of radius r on a circle of curvature k (convex > 0), exact: the chord between contacts that leaves h,
/// P^2 = 4 q (2 - q k^2) with q = h (2r - h)/(2 (1 + rk)(1 + hk)), and the h that a chord leaves (theory 1.1,
/// free of cancellation where k tends to 0). A chord beyond ball_reach leaves NaN. Need rk > -1.
double ball_chord(double curvature, double scallop_mm, double radius_mm);
double ball_scallop(double curvature, double chord_mm, double radius_mm);
/// Chord at which the cusp stands at the height of the ball's equator: 2r/(1 + rk).
double ball_reach(double curvature, double radius_mm);
/// The circle on which two passes of a ball leave what they leave on the surface K along this feed: with M =
/// 1/r + K it is det M/(t'Mt) - 1/r.
double ball_curvature(const Mat2& K, const Vec2& unit_feed, double radius_mm);

}  // namespace swarf::toolpath
