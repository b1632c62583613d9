// The section on the pole of the rotary axes: what the program's blocks do there, and what would help.
#pragma once

#include "kinematics/machine_model.h"
#include "motion/judged/singularity_scan.h"
#include "reports/report_data.h"
#include "toolpath/tool_path.h"

namespace swarf::reports {

/// Figures of the block that deviates most, the worst blocks, its linearisation, its branches and turns.
/// `path` and `machine` are those of the scan.
Topic singularity_topic(const kinematics::MachineModel& machine, const toolpath::ToolPath& path,
                        const motion::SingularityScan& scan);

}  // namespace swarf::reports
