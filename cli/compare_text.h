// What swarf compare says: checks, table and JSON.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cli/compare_inputs.h"
#include "measure/alignment.h"
#include "measure/part_comparison.h"
#include "sim/judge/judge.h"

namespace swarf::cli {

/// Excess, gouge and the area that was not measured, against their limits.
std::vector<sim::Check> judge_comparison(const measure::ComparisonInput& input,
                                         const measure::PartComparison& result);

std::string comparison_json(const ComparedStock& stock, const ComparedDesign& design,
                            const measure::ComparisonInput& input, const measure::PartComparison& result,
                            const std::vector<sim::Check>& checks,
                            const std::optional<measure::Alignment>& aligned);

/// "moved by ..., turned by ... about ...: rms .. before, .. after".
std::string alignment_text(const measure::Alignment& aligned);

std::vector<std::pair<std::string, std::string>> comparison_rows(const ComparedStock& stock,
                                                                 const ComparedDesign& design,
                                                                 const measure::ComparisonInput& input,
                                                                 const measure::PartComparison& result);

}  // namespace swarf::cli
