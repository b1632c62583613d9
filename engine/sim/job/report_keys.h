// The [report] table of a scene: whose job it is, for the head of the page.
#pragma once

#include <string>

#include "base/config.h"

namespace swarf::sim {

/// As the scene says it; "": not said, and not shown.
struct ReportSettings {
  std::string logo_file;  ///< PNG
  SourceLocation logo_where;
  std::string job, part_number, customer, date, approval;
};

/// Empty where the table is not there. `logo` is as written: relative to the scene.
ReportSettings read_report(ConfigTable table);

}  // namespace swarf::sim
