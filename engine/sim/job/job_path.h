// The tool path of a job, whatever its program is.
#pragma once

#include <optional>

#include "sim/job/scene.h"
#include "toolpath/nc_path.h"
#include "toolpath/tool_path.h"

namespace swarf::sim {

struct JobPath {
  toolpath::ToolPath path;
  std::optional<toolpath::NcReading> nc;  ///< what an NC program says besides its moves
};

/// The scene's own path: planned on the surfaces, or the blocks of the CL or NC program. Throws InputError
/// when it cannot be planned; what is only worth a warning goes to `diagnostics`.
JobPath job_path(const Job& job, Diagnostics& diagnostics);

/// The same by another planner; a path of blocks is what it is.
toolpath::ToolPath path_by(const Job& job, toolpath::Planner planner, Diagnostics& diagnostics);

}  // namespace swarf::sim
