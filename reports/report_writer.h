// One self-contained report.html from plain data: opens from disk, loads nothing from anywhere.
#pragma once

#include <string>

#include "reports/report_data.h"

namespace swarf::reports {

/// The page as text. Pictures, movie, glTF and the 3D viewer are inside it; equal data and files give equal
/// bytes. Throws InputError when a file named in `data` cannot be read.
std::string render_report(const ReportData& data);

/// render_report() into `path`, by way of a temporary file beside it that is renamed when complete, so that a
/// run that is killed leaves the last good report. Throws InputError when the file cannot be written.
void write_report(const std::string& path, const ReportData& data);

}  // namespace swarf::reports
