// --align and --best-fit of swarf compare.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/compare_inputs.h"
#include "measure/alignment.h"

namespace swarf::cli {

/// Moves the stock onto the design as the options say; none: neither was given. Throws InputError "bad-pair"
/// for a text that is no "X,Y,Z=X,Y,Z".
std::optional<measure::Alignment> align(const std::vector<std::string>& pairs, bool best_fit,
                                        const ComparedDesign& design, ComparedStock& stock);

}  // namespace swarf::cli
