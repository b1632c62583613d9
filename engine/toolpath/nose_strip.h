// Strips between passes of a leaned bull nose, from the tool itself instead of a parabola.
//
//         \     /  \     /        On the paraboloid of curvature K the tool stands in contact along two
//         straight
//          \_A_/ C  \_B_/         lines; the cusp C is the highest point between them that neither has met:
//      ------------------------    least distance over the stand along the line, exact for the tool.
//           |<--- P -->|
//
// The corner's circle turns below the bottom where the tool stands a little before or behind the cusp. So a
// lean of few degrees makes the second order (theory 1.1: M = T + K) miss the cusp's height by percents.
#pragma once

#include "toolpath/contact_end.h"
#include "toolpath/scallop_interval.h"

namespace swarf::toolpath {

/// Chord between passes along the unit feed t that leaves the scallop h on a surface of shape matrix K
/// (convex > 0, 1/mm), mm; twice the radius where the tool clears more than that. Needs a corner radius.
double nose_chord(const Mat2& K, const Vec2& unit_feed, double scallop_mm, const Lean& lean,
                  const ContactEnd& end, RimSides sides);

/// The scallop that a chord leaves, mm.
double nose_scallop(const Mat2& K, const Vec2& unit_feed, double chord_mm, const Lean& lean,
                    const ContactEnd& end, RimSides sides);

}  // namespace swarf::toolpath
