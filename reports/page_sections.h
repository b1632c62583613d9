// The sections of report.html, each a function from plain data to HTML; "" when there is nothing to show.
#pragma once

#include <string>
#include <vector>

#include "reports/report_data.h"

namespace swarf::reports {

std::string verdict_header(const ReportData& data);
std::string overview_section(const ReportData& data);
std::string findings_section(const ReportData& data);
std::string viewer_section(const Viewer3d& viewer);
std::string movie_section(const ReportData& data);
std::string stills_section(const std::vector<Still>& stills);
std::string plots_section(const std::vector<Plot>& plots);
std::string assumptions_section(const std::vector<Table>& tables);
std::string tables_section(const std::vector<Table>& tables);
std::string topic_section(const Topic& topic);
std::string paper_section(const ReportData& data);
std::string checks_section(const std::vector<Check>& checks);
std::string reproduce_section(const ReportData& data);

/// The drawings that the sections refer to by name: a tick, a cross, a triangle, a dash.
std::string symbol_sprite();

}  // namespace swarf::reports
