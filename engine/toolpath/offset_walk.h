// The next pass at a given chord from the previous one (Lin & Koren, section 2).
//
//            q = S(t,w)          For every t of the grid find w and the foot s on the previous pass p with
//           /|                     (q - p(s)).p'(s) = 0     q lies in the plane perpendicular to the pass
//        P / |                     |q - p(s)| = P(s)        at the wanted chord
//   ------x--------> p(s)        by Newton in (s,w). Working back from q gives the graph w(t) at once.
#pragma once

#include <functional>

#include "toolpath/grid_step.h"

namespace swarf::toolpath {

/// Chord wanted from the previous pass at s, mm; it must vary slowly along the pass.
using ChordRule = std::function<double(double s)>;

/// Offsets a pass.
GridPoints offset_walk(const Area& area, const CubicSpline& previous, const ChordRule& chord);

}  // namespace swarf::toolpath
