// The iso-parametric planner: passes w = const, each step as long as its worst place allows.
#pragma once

#include <vector>

#include "toolpath/area.h"

namespace swarf::toolpath {

/// The constants w of all passes, from start_w to end_w exactly. A step may be as long as its greatest cusp
/// (exact R at mid strip) allows; as the last one would overshoot, all are shortened by one common factor, so
/// the cusps are lower than wanted by the same share everywhere and none exceeds it.
std::vector<double> isoparametric_passes(const Area& area);

}  // namespace swarf::toolpath
