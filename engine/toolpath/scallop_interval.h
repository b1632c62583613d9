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

/// Radius of the cross section swept by a leaned tool: (rc + r/sin(phi)) cos^2(omega) + rc sin^2(omega), with
/// rc the corner radius (0: flat end) and r the radius of the circle of corner centres.
double effective_radius(double radius_mm, double corner_radius_mm, const Lean& lean);

/// det M/(t'Mt) with M = T + K for a flat end of radius r: strip_curvature on the normal; leaned, the rim is
/// infinitely curved towards the lean, and the limit is (c'Kc)/cos^2(omega) + 1/R_eff with c across the lean.
double relative_curvature(const Mat2& K, const Vec2& unit_feed, const Lean& lean, double radius_mm);

/// Chord for scallop h of a leaned flat end over the relative curvature: sqrt(8h/curvature), times
/// sqrt(1 - h/(2 r sin(phi))), which makes it exact on a plane (the swept rim is an ellipse) and keeps it on
/// the safe side elsewhere. The rim reaches no farther than 2 r cos(omega), which bounds the result.
double leaned_chord(double relative_curvature, double scallop_mm, const Lean& lean, double radius_mm);

}  // namespace swarf::toolpath
