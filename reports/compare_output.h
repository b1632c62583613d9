// What `swarf compare -o DIR` leaves: a page, the deviation map as mesh and picture, and its numbers.
#pragma once

#include <string>

#include "reports/compare_page.h"

namespace swarf::reports {

/// The file that marks a folder as a result of `swarf compare`.
inline constexpr const char* kCompareMark = "deviation.ply";

/// report.html, deviation.ply and .png (the stock), design.ply and .png, a picture of each of the worst
/// places and metrics.json, the folder replaced whole. `scale_um` is the colour scale's half width.
void write_compare(const std::string& folder, const ComparedPair& pair, const measure::ComparisonInput& input,
                   const measure::PartComparison& result, double scale_um, const std::string& metrics_json);

}  // namespace swarf::reports
