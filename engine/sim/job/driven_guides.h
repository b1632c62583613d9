// What a driven path meets along its guides, told before its first cycle. The tool is set down on lines
// kGuideLook_mm apart; what lies between two is judged by the cycles themselves.
#pragma once

#include "base/diagnostics.h"
#include "sim/job/scene.h"
#include "toolpath/elements.h"

namespace swarf::sim {

inline constexpr double kGuideLook_mm = 0.5;

/// Errors and warnings about the driven passes of a path:
///   guide-misses-part   an error: the tool rests on nothing
///   guide-beyond-part   nothing of the part lies under the axis: the tool rolls over the part's end (a fixed
///                       axis; one that follows the part must have the part under it, or is refused)
///   part-gap-wide       an error without floor_mm: patches under a guide leave a gap into which the tip
///                       sinks by more than the chord's tolerance
///   part-gap, part-step patches under a guide that do not meet: the tool rides over it, or climbs it
///   driven-travel       an axis would leave its travel, or a pose has no axis values
/// Gaps and steps are those of whole patches: faces of CAD files are told as they are read (part-gap).
void look_along_guides(const Job& job, const toolpath::Elements& elements, Diagnostics& diagnostics);

}  // namespace swarf::sim
