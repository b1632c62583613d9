// From the judge's list to findings: where and when each check that does not hold is broken, and what would
// help.
#pragma once

#include <vector>

#include "sim/run/result.h"

namespace swarf::sim {

/// Of Result::checks: at least one error for each check that fails or is not proven, none for any other.
std::vector<Finding> find_faults(const Job& job, const Result& result);

}  // namespace swarf::sim
