// Corners that a word of a block rounds or cuts (RND=, CHR=, ,R ..): its piece of contour waits for the next
// one, both are made shorter, and what joins them goes between; then cutter compensation has its turn.
//
//   words -> line(), arc() -> take_piece() -> [held until the next piece] -> compensation -> moves
#pragma once

#include "program/control/control.h"

namespace swarf::program::nc {

/// The piece that is programmed next has this corner at its end. Sizes are of the program's coordinates.
void ask_corner(Control& control, const CornerWords& words);

/// A programmed piece, in order. "bad-corner" at the word where a corner cannot be: between other than feed
/// moves in the plane, where the pieces are too short, under G93.
void take_piece(Control& control, const Segment& segment);

/// A piece that was kept (CornerState::kept), with its corners: through cutter compensation to the machine.
/// The position holds again after flush().
void send_kept(Control& control, const Segment& segment);

/// No piece of contour follows: a modal corner is none, one that a block asks for is "bad-corner".
void release_corner(Control& control);

}  // namespace swarf::program::nc
