// Table 2 and the results of So et al. beside ours.
#pragma once

#include <vector>

#include "kinematics/machine_model.h"
#include "motion/judged/singularity_scan.h"
#include "papers/paper_row.h"

namespace swarf::papers {

/// True when the program holds the block of their Table 2 and the machine has the axes X Y Z A C.
bool runs_so_block(const kinematics::MachineModel& machine, const motion::SingularityScan& scan);

/// Every printed figure of the paper and what this run computes for it; none unless runs_so_block().
std::vector<PaperRow> so_paper_rows(const kinematics::MachineModel& machine,
                                    const motion::SingularityScan& scan);

}  // namespace swarf::papers
