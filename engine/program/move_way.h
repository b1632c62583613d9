// How far the tip goes in a move, and where.
#pragma once

#include <Eigen/Geometry>

#include "program/moves.h"

namespace swarf::program {

/// Way of the tip, mm: arcs and helices along themselves, other moves between their ends.
double way_mm(const Move& move);

/// Box of the tip's way in W, mm: arcs with their bulge, other moves by their ends.
Eigen::AlignedBox3d extent_W(const Move& move);

}  // namespace swarf::program
