// Free profiles: what cannot be the outline of a solid that a spindle turns.
#pragma once

#include <string>
#include <vector>

#include "cutter/cutter.h"

namespace swarf::cutter {

/// Every reason why the points are no outline, in words with numbers; empty when they are one. An outline
/// starts at (0, 0), never comes back to the axis before its end, never crosses itself and never falls: a
/// dished end cannot be cut by a union of convex solids of revolution. A dip below 1e-5 mm is taken for the
/// rounding of the written numbers.
std::vector<std::string> profile_problems(const std::vector<ProfilePoint>& profile);

}  // namespace swarf::cutter
