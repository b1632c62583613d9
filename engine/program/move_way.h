// How far the tip goes in a move, and where, and how long a program may take.
#pragma once

#include <Eigen/Geometry>

#include "program/moves.h"

namespace swarf::program {

/// Way of the tip, mm: arcs and helices along themselves, other moves between their ends.
double way_mm(const Move& move);

/// Box of the tip's way in W, mm: arcs with their bulge, other moves by their ends.
Eigen::AlignedBox3d extent_W(const Move& move);

/// Longer programs are not driven (motion/cycles/cycle_stream.h); as programmed, accelerations left out.
inline constexpr double kHoursMax = 1000.0;

}  // namespace swarf::program
