// What swarf compare says: checks, table and JSON.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cli/compare_inputs.h"
#include "cli/compare_pieces.h"
#include "measure/alignment.h"
#include "measure/part_comparison.h"
#include "sim/judge/judge.h"

namespace swarf::cli {

/// Excess, gouge and the area that was not measured, against their limits, and loose pieces.
std::vector<sim::Check> judge_comparison(const measure::ComparisonInput& input,
                                         const measure::PartComparison& result, const ComparedPieces& pieces);

std::string comparison_json(const ComparedStock& stock, const ComparedDesign& design,
                            const measure::ComparisonInput& input, const measure::PartComparison& result,
                            const std::vector<sim::Check>& checks,
                            const std::optional<measure::Alignment>& aligned, const ComparedPieces& pieces);

/// "moved by ..., turned by ... about ...: rms .. before, .. after".
std::string alignment_text(const measure::Alignment& aligned);

std::vector<std::pair<std::string, std::string>> comparison_rows(const ComparedStock& stock,
                                                                 const ComparedDesign& design,
                                                                 const measure::ComparisonInput& input,
                                                                 const measure::PartComparison& result,
                                                                 const ComparedPieces& pieces);

}  // namespace swarf::cli
