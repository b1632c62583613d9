// A field over two parameters in colours: blue below zero, red above, grey where there is none.
#pragma once

#include <string>
#include <vector>

#include "reports/report_data.h"

namespace swarf::reports {

/// values[iy * x.size() + ix]; NaN: none.
struct HeatMap {
  std::string title, caption;
  std::string x_label, y_label, unit;
  std::vector<double> x, y;  ///< rising
  std::vector<double> values;
  double most = 1.0;  ///< the colours run from -most to +most; values beyond take the last colour
};

/// At most kCells cells along either side; a cell that stands for several values shows the one farthest from
/// zero, so that no extreme is lost.
inline constexpr int kCells = 96;
Figure heat_map_figure(const HeatMap& map);

/// Share of the range from -1 to 1 as "#rrggbb".
std::string heat_colour(double share);

}  // namespace swarf::reports
