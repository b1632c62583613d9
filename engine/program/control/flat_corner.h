// The corner between two pieces of contour: where what rounds or cuts it begins and ends.
//
//        \  join
//         \____
//   ______/ r  |      RND: an arc of radius r that touches both pieces
//   leave       corner
#pragma once

#include <optional>
#include <string>

#include "base/frames.h"

namespace swarf::program::nc {

/// A straight piece or an arc, in the plane.
struct FlatPiece {
  Vec2 from = Vec2::Zero(), to = Vec2::Zero();
  bool is_arc = false;
  Vec2 centre = Vec2::Zero();
  bool counter_clockwise = false;
};

struct FlatCorner {
  Vec2 leave = Vec2::Zero(), join = Vec2::Zero();  ///< where the first piece ends and the second starts
  Vec2 centre = Vec2::Zero();                      ///< RND
  bool counter_clockwise = false;
};

/// By how much the way turns where the pieces meet, rad; to the left above 0.
double turn_at_corner(const FlatPiece& before, const FlatPiece& after);
/// The arc of radius r that touches both pieces, which meet at before.to = after.from. None and `why` where
/// there is none: the pieces run on smoothly or turn back, or are too short.
std::optional<FlatCorner> round_corner(const FlatPiece& before, const FlatPiece& after, double radius,
                                       std::string& why);
/// The straight cut at `length` from the corner on both pieces, which must be straight.
std::optional<FlatCorner> cut_corner(const FlatPiece& before, const FlatPiece& after, double length,
                                     std::string& why);

}  // namespace swarf::program::nc
