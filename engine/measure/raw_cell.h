// What the raw stock, where it is no box, says about a whole cell of the design: where its columns certainly
// hold no material, and where they certainly held some. Internal to the proof of a root cell (root_proof.h).
//
//   1. A ball about a point with the radius of its distance is all material or all air. Balls along the
//   cell's
//      middle column tell where the surface is no nearer than the cell is wide.
//   2. Nearer than that: of a ball that holds the columns, the part beyond every piece of the surface in it,
//   in
//      one direction, is convex and free of surface, so it is all air or all material; one place tells which.
//      Its border is off by the square of the ball's radius where the surface is curved, and by nothing where
//      it is flat. The same goes for what lies below all faces in the ball at once, which settles edges that
//      stand out of the material, and for what lies above all of them, at edges that run into it.
// What neither settles is left to be proven otherwise, or stays open.
#pragma once

#include <optional>

#include "measure/height_bounds.h"
#include "stock/raw/raw_shape.h"

namespace swarf::measure {

/// Height above which the columns meet no raw material up to `top_mm`.
double raw_air_above(const DesignCell& cell, const stock::RawShape& raw, double top_mm);

/// Heights from which on the columns are free of raw material up to `air_mm`, as outside_from() gives them
/// for the face of a box.
std::optional<CornerHeights> raw_outside(const DesignCell& cell, const stock::RawShape& raw, double air_mm);

/// Height up to which all columns of the cell held raw material from the design on; less than 0: no place of
/// the cell lacks more (stock::RawColumn).
double raw_stood(const DesignCell& cell, const stock::RawShape& raw);

}  // namespace swarf::measure
