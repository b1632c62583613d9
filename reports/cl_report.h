// What the report says of a CL program: who wrote it, and what was taken as given.
#pragma once

#include <vector>

#include "reports/report_data.h"
#include "sim/job/scene.h"

namespace swarf::reports {

/// Writer, statements, start and each remark of the reader (CUTCOM, ORIGIN, TRANS, systems).
FactGroup cl_facts(const program::ClProgram& program);

/// Words that were read and have no effect on the geometry, for "not simulated"; empty when there is none.
std::vector<Check> cl_checks(const program::ClProgram& program);

}  // namespace swarf::reports
