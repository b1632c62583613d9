// Closed ways in the plane of a milling cycle, and how its infeeds are shared out.
#pragma once

#include <vector>

#include "base/frames.h"

namespace swarf::program::nc::siemens {

/// A straight or circular piece; it starts where the one before it ends.
struct OutlinePiece {
  Vec2 to = Vec2::Zero();
  Vec2 centre = Vec2::Zero();
  int turn = 0;  ///< +1 counter-clockwise about `centre`, -1 clockwise, 0 straight
};

/// mm, in the frame of the cycle. `pieces` come back to `start`; those without length are left out.
struct Outline {
  Vec2 start = Vec2::Zero();
  std::vector<OutlinePiece> pieces;
};

/// Counter-clockwise from the middle of the side at +x. A half of 0: the line to the other end and back.
/// `radius` is cut down to the shorter half.
Outline rounded_rectangle(double half_length, double half_width, double radius);

/// A band of half width `half_width` about the arc of `radius` about the origin from `from_rad` to `to_rad`,
/// round at both ends. Counter-clockwise from the middle of the round end at `from_rad`. `half_width` 0: the
/// arc to its other end and back.
Outline round_band(double radius, double half_width, double from_rad, double to_rad);

/// The same way in the other sense.
Outline reversed(const Outline& outline);

/// `count` equal infeeds from `from` to `to`: the height of each.
std::vector<double> infeeds(double from, double to, int count);

}  // namespace swarf::program::nc::siemens
