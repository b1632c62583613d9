// From a run to the report's data: which numbers, tables, plots and checks it shows.
#pragma once

#include <string>
#include <vector>

#include "reports/path_view.h"
#include "reports/report_data.h"
#include "sim/simulation.h"

namespace swarf::reports {

/// What the report takes in; what is empty leaves its section out.
struct RunFiles {
  std::vector<Still> stills;
  std::vector<std::string> finding_pngs;  ///< paths, of the page's first findings; empty: none
  std::string movie;                      ///< path
  std::string part_glb, machine_glb;      ///< bytes, for the page's own reader
  double part_error_mm = 0.0;             ///< of the decimated part
  double animation_scale = 1.0;           ///< program seconds per second of the glTF animation
  double shown_from_s = 0.0;              ///< program time at which animation and movie begin
  Way way;                                ///< of the program
};

/// `rendered`: false when the user switched the pictures off, which the report then says.
ReportData report_data(const sim::Job& job, const sim::Result& result, const RunFiles& files, bool rendered);

/// The ten lines that the terminal shows at the end: label, value with unit.
std::vector<std::pair<std::string, std::string>> summary_lines(const sim::Job& job,
                                                               const sim::Result& result);

}  // namespace swarf::reports
