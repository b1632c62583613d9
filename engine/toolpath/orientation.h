// Lead and tilt: from the two programmed angles to the lean of the tool.
#pragma once

#include "toolpath/scallop_interval.h"

namespace swarf::toolpath {

/// Lean of the axis of pose_in_contact: axis = cos(lead) (cos(tilt) n + sin(tilt) l) + sin(lead) f with n the
/// normal, f the feed, l = n x f (left of the feed). Angles in rad.
Lean lean_of(double lead_rad, double tilt_rad);

}  // namespace swarf::toolpath
