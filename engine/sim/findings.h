// From measures to findings: each broken limit with its block, time and what would help.
#pragma once

#include <vector>

#include "sim/simulation.h"

namespace swarf::sim {

/// Every limit of [accept], every travel and speed limit of the machine, and the built-in checks.
std::vector<Finding> find_faults(const Job& job, const Result& result);

}  // namespace swarf::sim
