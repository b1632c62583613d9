// The constant-scallop planner: the cusp has the wanted height everywhere.
//
// On the normal, flat bottoms are tangent planes and the cusp is found exactly, in two like steps:
//
//        cusp, h above the surface           1. ridge r(t): the envelope of the planes of the previous
//             /\                                pass p stands h above the surface there
//       _____/  \_____                       2. next pass q(t): its plane at q stands h above the ridge
//      p     r        q                         at the ridge point where it is lowest
//
// The planes through a cusp point touch the surface on a small closed curve around it; p touches all these
// curves from one side, q from the other. So the method has no error of higher order in P.
// A ball, whatever its axis, is solved in the same two steps, exactly as well, with the ball in the place of
// the tangent plane. Leaned flat ends and bull noses take P from a formula at mid strip instead, iterated, as
// a smooth profile along the pass; a bull nose on the normal is its flat bottom.
#pragma once

#include "toolpath/grid_step.h"

namespace swarf::toolpath {

NextPass next_constant_scallop(const Area& area, const CubicSpline& previous);

/// Height above `point` along its unit `normal` that the flat bottoms of a pass on the normal leave, and the
/// parameter s of the bottom that does: the least of (p(s) - point).n(s) / (normal.n(s)) near the start s.
/// The search stays on the grid; `outside` says that it ended at its border.
struct EnvelopeHeight {
  double height_mm = 0.0;
  double s = 0.0;
  bool outside = false;
};
/// The same for the canal surface that a ball sweeps along a pass: the least x with |point + x normal - c(s)|
/// = r, c the ball's centre, r its radius.
EnvelopeHeight canal_height(const Area& area, const CubicSpline& pass, const Vec3& point, const Vec3& normal,
                            double s_start);
EnvelopeHeight envelope_height(const Area& area, const CubicSpline& pass, const Vec3& point,
                               const Vec3& normal, double s_start);

}  // namespace swarf::toolpath
