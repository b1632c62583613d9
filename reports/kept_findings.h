// findings.json of a finished run, read back.
#pragma once

#include <string>
#include <vector>

#include "sim/check.h"

namespace swarf::reports {

struct KeptFindings {
  std::vector<sim::Finding> list;
  std::vector<int> numbers;  ///< of each: its fault's in the page, from 1

  /// How many faults they are.
  int faults() const;
};

/// Of a run that has none, or was stopped before they were written: none. Throws InputError "broken-findings"
/// when the file is no list of findings with their numbers.
KeptFindings read_findings(const std::string& folder);

}  // namespace swarf::reports
