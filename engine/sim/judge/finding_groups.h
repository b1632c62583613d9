// Findings as a person reads them: what has one cause at one place is one fault with its range.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sim/check.h"

namespace swarf::sim {

/// One fault. `members` are indices of the findings, the worst first, the others as they came.
struct FindingGroup {
  std::vector<size_t> members;
  int first_line = 0, last_line = 0;  ///< of the program; 0: not tied to lines
};

/// Each finding is in one group. Two findings are one fault when code, severity, check, cause and file are
/// the same, and
///   both have a place        their places are within the greater reach of the two, or linked by others that
///                            are;
///   neither has              no more than kLinesApart lines of the program lie between their ranges.
/// Groups by risk: errors before warnings and notes; then what breaks the machine, the tool, the part, the
/// time (risk_of); then the deeper; then the program's order.
std::vector<FindingGroup> group_findings(std::span<const Finding> findings);

/// Lines between two blocks of one fault: comments, and blocks that are well between two that are not.
inline constexpr int kLinesApart = 3;

/// The greater, the sooner to be looked at: 5 machine and spindle, 4 tool and holder in the stock, 3 the
/// part, 2 motion that the machine cannot follow, 1 what is open or a fault of the program itself, 0 the
/// rest.
int risk_of(const Finding& finding);

}  // namespace swarf::sim
