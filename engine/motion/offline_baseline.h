// Lin & Koren, Fig. 6: what off-line segmentation does to the tool's orientation, recomputed.
//
// The curve of Eq. (8), x = 10u^3 + 10u^2 + 10, y = 10u^2 + 10u, 0 <= u <= 1, is cut into straight segments
// in four ways. Along each segment the controller only knows the normals at its two ends and fills in the
// rest:
//   constant                the normal of the segment's start
//   linear in u             Eq. (7): n = n0 + (n1 - n0)(u - u0)/(u1 - u0), normalised
//   linear along the chord  the same with the fraction of the chord under the curve point
// The paper's .017 deg is the last of these (erratum E5), with 55 segments instead of 52 (E6).
#pragma once

#include <string>
#include <vector>

#include "base/frames.h"

namespace swarf::motion {

/// One way to segment the curve and the greatest errors over all of it.
struct Fig6Row {
  std::string segmentation;  ///< "equal du", "equal chord error", "equal arc length", "greedy, 1 um"
  int segments = 0;
  double chord_error_um = 0.0;    ///< greatest distance between curve and segments
  double linear_u_deg = 0.0;      ///< greatest orientation error, linear in u
  double linear_chord_deg = 0.0;  ///< linear along the chord
  double constant_deg = 0.0;      ///< constant
  std::vector<Vec2> curve;        ///< (u, orientation error in deg), linear along the chord, for plotting
};

/// The four rows of theory 1.4, in its order.
std::vector<Fig6Row> reproduce_fig6();

/// Where Eq. (11) moves the tool when the tilt is wrong by the paper's .017 deg, with its machine
/// (8, 96, 120) mm: norm of Rx(.017 deg) r - r, mm. The paper prints 45 um (erratum E8).
double fig6_position_error_mm();

}  // namespace swarf::motion
