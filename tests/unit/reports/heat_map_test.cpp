#include "reports/heat_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace swarf::reports {
namespace {

size_t count(const std::string& text, const std::string& word) {
  size_t found = 0;
  for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
  return found;
}

HeatMap flat(size_t columns, size_t rows) {
  HeatMap map{"A map", "", "u", "v", "µm", {}, {}, {}, 2.0};
  for (size_t i = 0; i < columns; ++i) map.x.push_back(static_cast<double>(i));
  for (size_t i = 0; i < rows; ++i) map.y.push_back(static_cast<double>(i));
  map.values.assign(columns * rows, 0.0);
  return map;
}

TEST(HeatMap, ColoursAreWhiteAtZeroAndSaturateAtTheEnds) {
  EXPECT_EQ(heat_colour(0.0), "#f6f6f4");
  EXPECT_EQ(heat_colour(1.0), heat_colour(7.0));
  EXPECT_EQ(heat_colour(-1.0), heat_colour(-7.0));
  EXPECT_NE(heat_colour(1.0), heat_colour(-1.0));
}

TEST(HeatMap, NoExtremeIsLostWhereCellsStandForMany) {
  HeatMap map = flat(1000, 700);
  map.values[123 * 1000 + 456] = -2.0;
  map.values[600 * 1000 + 10] = 2.0;
  const std::string svg = heat_map_figure(map).svg;
  // Once in the map, and in the last step of the bar nearly so.
  EXPECT_EQ(count(svg, heat_colour(-1.0)), 1U);
  EXPECT_EQ(count(svg, heat_colour(1.0)), 1U);
}

TEST(HeatMap, WhatIsNotThereIsGrey) {
  HeatMap map = flat(4, 3);
  map.values[5] = std::numeric_limits<double>::quiet_NaN();
  const std::string svg = heat_map_figure(map).svg;
  EXPECT_EQ(count(svg, "#9a9a9a"), 1U);
  EXPECT_EQ(count(svg, "<svg"), 1U);
  EXPECT_NE(svg.find("role=\"img\""), std::string::npos);
}

}  // namespace
}  // namespace swarf::reports
