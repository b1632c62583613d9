// The section on the pole of the rotary axes: what the program's blocks do there, and what would help.
#pragma once

#include "motion/judged/singularity_scan.h"
#include "papers/so_study.h"
#include "reports/report_data.h"
#include "toolpath/tool_path.h"

namespace swarf::reports {

/// Figures of the block that deviates most, the worst blocks, its linearisation, its branches and turns.
/// `path` is that of the scan, `study` that of its worst block.
Topic singularity_topic(const toolpath::ToolPath& path, const motion::SingularityScan& scan,
                        const papers::BlockStudy& study);

}  // namespace swarf::reports
