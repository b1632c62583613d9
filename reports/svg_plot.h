// Plots as inline SVG: lines with limits, and histograms. Colours come from the page's style sheet, so that a
// plot follows the light and the dark theme.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "reports/report_data.h"

namespace swarf::reports {

/// Round numbers at steps of 1, 2 or 5 times a power of ten that cover [low, high]: the first is <= low and
/// the last >= high, with about `wanted` steps. A range of no width (below 1e-9 of its
/// values) is widened around its value.
struct Ticks {
  double step = 1.0;
  std::vector<double> values;
};
Ticks round_ticks(double low, double high, int wanted);

/// A tick's number with just the digits that its step needs; no "-0", thousands parted by thin spaces.
std::string tick_text(double value, double step);

/// Thins points whose x never falls: of each of `columns` equal columns the first, lowest, highest and last
/// point stay, in their order, so that every peak survives. Points with a NaN stay as breaks. Points whose x
/// falls somewhere (a closed curve) come back as they are.
std::vector<std::array<double, 2>> decimate(const std::vector<std::array<double, 2>>& points, int columns);

/// <svg> with axes, round ticks, units and a spoken description. Lines that are too near to tell apart at the
/// size of a screen are thinned by decimate().
std::string plot_svg(const Plot& plot);

}  // namespace swarf::reports
