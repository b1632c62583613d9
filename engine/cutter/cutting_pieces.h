// The cutting part as the stock engine takes it: a union of convex solids of revolution.
//
//        |  B |__            At a reflex corner (*) the outline turns into the material. There the pieces
//        part, |    :  |           and each goes on straight into the other until it would leave the
//        material: A
//        |----*--'           reaches up inside B, and B's lower face lies inside A. So the border between two
//        | A  |              pieces is well inside one of them, and min over pieces of F stays negative
//        there.
#pragma once

#include <vector>

#include "cutter/convex_piece.h"
#include "cutter/cutter.h"

namespace swarf::cutter {

/// Hollow arcs are cut into chords that leave the arc by no more than this, on the outer side.
inline constexpr double kChordTolerance = 0.5e-3;  // mm

/// Flutes only; the cutter must be without problems (validate). A convex outline is one exact piece; others
/// are exact unions but for hollow arcs, see chord_error_mm.
std::vector<ConvexPiece> cutting_pieces(const Cutter& cutter);

/// Greatest distance by which the pieces stand out of the cutter's outline, mm: 0 without hollow arcs. The
/// pieces are never too small, so that no gouge is missed.
double chord_error_mm(const Cutter& cutter);

}  // namespace swarf::cutter
