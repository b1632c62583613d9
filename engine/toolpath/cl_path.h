// A CL program as a tool path: one block per move, in its order.
#pragma once

#include <span>

#include "base/diagnostics.h"
#include "program/cl/program.h"
#include "toolpath/tool_path.h"

namespace swarf::toolpath {

/// The tip turns off by more than this: what follows is another pass, and cusps between the two are measured.
inline constexpr double kPassCorner_rad = 0.785;

/// Every move of the program becomes one element; a move that changes nothing becomes none. A pass ends at a
/// rapid, at another tool and at a corner of more than kPassCorner_rad. Rapids follow kTcp where the law is
/// kEnds.
///   tools   BlockMove::tool for each of ClProgram::tools; empty: whatever is loaded is tool 0
/// Diagnostics: "arc-needs-tcp" for an arc under another law, "axis-reversed" for a block that turns the axis
/// by half a turn under a law that then does not say which way.
ToolPath cl_path(const program::ClProgram& program, BlockLaw law, Diagnostics& diagnostics,
                 std::span<const int> tools = {});

}  // namespace swarf::toolpath
