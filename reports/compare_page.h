// The page of `swarf compare`: verdict, worst places with pictures, 3D view, histogram, sections.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "measure/part_comparison.h"
#include "reports/report_data.h"
#include "sim/check.h"

namespace swarf::reports {

/// What was compared, and what to call it.
struct ComparedPair {
  std::string stock, design;  ///< as given
  /// Two stocks: the design is an earlier one, and what stands out was added.
  bool revisions = false;
  std::string alignment;  ///< how the stock was moved before; "": not at all
  std::vector<sim::Check> checks;
  std::vector<std::pair<std::string, std::string>> rows;  ///< what the console says
  std::string command;
};

/// Regions that get a card and a picture, the worst first.
inline constexpr size_t kPicturedRegions = 10;

/// Everything but what lies in files: stills and pictures of findings stay empty.
ReportData compare_page(const ComparedPair& pair, const measure::ComparisonInput& input,
                        const measure::PartComparison& result, double scale_um);

}  // namespace swarf::reports
