// The greatest value that a convex measure takes along a smooth curve, proven.
//
// Along the chord of any piece [a,b] of the curve a convex measure f (distance to a line, to a segment, to a
// point; height over a plane) is at most max(f(a), f(b)). The curve leaves its chord by at most
// (b-a)^2/8 max|x''|, and f changes by at most its Lipschitz constant times that. So
//
//     f <= max(f(a), f(b)) + (b-a)^2/8 K     on [a,b],   K = Lipschitz constant * max|x''|.
//
//  1. Pieces whose bound does not exceed the best value found are dropped; the others are halved.
//  2. Where the slope of f changes from rising to falling between the ends of a piece, the exact derivative
//     is solved in that bracket: the best value is a true maximum, not the best of some samples.
//  3. It ends when no piece is left whose bound exceeds the best value by the tolerance: none was missed.
#pragma once

#include <functional>

namespace swarf::kinematics {

/// The measure at one place and its derivative by u; the slope may be 0 where the measure has a kink of its
/// own at its least value (a point on the line).
struct MeasureAt {
  double value = 0.0, slope = 0.0;
};

struct Peak {
  double u = 0.0;
  double value = 0.0;
  double proven = 0.0;  ///< no value on [0,1] exceeds this; above `value` by at most the tolerance
};

/// The greatest value of a convex measure over [0,1]. `bend`: K above, finite. `tolerance`: above 0, in the
/// unit of the measure. Of equal values the one with the least u.
Peak greatest(const std::function<MeasureAt(double u)>& measure, double bend, double tolerance);

}  // namespace swarf::kinematics
