// From a run to the report's data: which numbers, tables, plots and checks it shows.
#pragma once

#include <string>
#include <vector>

#include "reports/report_data.h"
#include "sim/simulation.h"

namespace swarf::reports {

/// Files that the report takes in; empty paths leave their section out.
struct RunFiles {
  std::vector<Still> stills;
  std::string movie, part_glb, machine_glb;
  double part_error_mm = 0.0;    ///< of the decimated part.glb
  double animation_scale = 1.0;  ///< program seconds per second of the glTF animation
};

/// `rendered`: false when the user switched the pictures off, which the report then says.
ReportData report_data(const sim::Job& job, const sim::Result& result, const RunFiles& files, bool rendered);

/// The ten lines that the terminal shows at the end: label, value with unit.
std::vector<std::pair<std::string, std::string>> summary_lines(const sim::Job& job,
                                                               const sim::Result& result);

}  // namespace swarf::reports
