#include "reports/svg_plot.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/rng.h"

namespace swarf::reports {
namespace {

using Points = std::vector<std::array<double, 2>>;

TEST(Ticks, AreRoundAndCoverTheRange) {
  const Ticks ticks = round_ticks(0.0, 10.31, 5);
  EXPECT_EQ(ticks.step, 2.0);
  EXPECT_EQ(ticks.values, (std::vector<double>{0, 2, 4, 6, 8, 10, 12}));
}

TEST(Ticks, EveryRangeGetsStepsOfOneTwoOrFive) {
  Rng rng(7);
  for (int i = 0; i < 2000; ++i) {
    const double scale = std::pow(10.0, rng.uniform(-9.0, 9.0));
    const double low = rng.uniform(-1.0, 1.0) * scale, high = low + rng.uniform(1e-3, 1.0) * scale;
    const int wanted = 3 + i % 6;
    const Ticks ticks = round_ticks(low, high, wanted);
    const double lead = ticks.step / std::pow(10.0, std::floor(std::log10(ticks.step) + 1e-9));
    const bool round = std::abs(lead - 1) < 1e-9 || std::abs(lead - 2) < 1e-9 || std::abs(lead - 5) < 1e-9;
    const double slack = 1e-8 * ticks.step;
    EXPECT_TRUE(round && ticks.values.front() <= low + slack && ticks.values.back() >= high - slack &&
                ticks.values.size() >= 2 && ticks.values.size() <= static_cast<size_t>(2 * wanted + 2))
        << "round_ticks(" << fmt::format("{}, {}, {}", low, high, wanted) << ") gave step " << ticks.step
        << " and " << ticks.values.size() << " ticks";
  }
}

TEST(Ticks, ARangeOfNoWidthIsWidened) {
  for (const double value : {0.0, 50.0, -3.0}) {
    const Ticks ticks = round_ticks(value, value, 5);
    EXPECT_LT(ticks.values.front(), value);
    EXPECT_GT(ticks.values.back(), value);
  }
  // One unit in the last place of a constant feed: a step of that size would not change a double.
  const Ticks noise = round_ticks(3000.0, std::nextafter(3000.0, 4000.0), 5);
  EXPECT_LT(noise.values.size(), 12U);
  EXPECT_GT(noise.step, 1.0);
}

TEST(Ticks, TextHasTheDigitsOfItsStep) {
  EXPECT_EQ(tick_text(0.30000000000000004, 0.1), "0.3");
  EXPECT_EQ(tick_text(-2.0, 1.0), "−2");
  EXPECT_EQ(tick_text(-1e-17, 0.5), "0.0");
  EXPECT_EQ(tick_text(0.05, 0.05), "0.05");
  EXPECT_EQ(tick_text(12500.0, 500.0), "12\u2009500");
  EXPECT_EQ(tick_text(-1234567.0, 1.0), "−1\u2009234\u2009567");
  EXPECT_EQ(tick_text(1000.0, 200.0), "1000");
}

TEST(Decimate, KeepsEveryPeakAndBothEnds) {
  constexpr int kPoints = 200000, kColumns = 800;
  Rng rng(11);
  Points points;
  for (int i = 0; i < kPoints; ++i) points.push_back({i * 1e-3, rng.uniform(-1.0, 1.0)});
  points[123456][1] = 50.0;  // one tick of 200 s
  points[77777][1] = -50.0;
  const Points thin = decimate(points, kColumns);
  EXPECT_LE(thin.size(), 4U * (kColumns + 1));
  EXPECT_EQ(thin.front(), points.front());
  EXPECT_EQ(thin.back(), points.back());
  EXPECT_NE(std::ranges::find(thin, points[123456]), thin.end());
  EXPECT_NE(std::ranges::find(thin, points[77777]), thin.end());
  EXPECT_TRUE(std::ranges::is_sorted(thin, {}, [](const auto& point) { return point[0]; }));
}

TEST(Decimate, EveryColumnKeepsItsExtremes) {
  Rng rng(5);
  Points points;
  for (int i = 0; i < 5000; ++i) points.push_back({static_cast<double>(i), rng.uniform(0.0, 1.0)});
  const Points thin = decimate(points, 50);
  for (int column = 0; column < 50; ++column) {
    const auto in_column = [&](const auto& p) {
      return static_cast<int>(std::floor(p[0] / 4999.0 * 50)) == column;
    };
    double highest = 0.0, highest_kept = 0.0;
    for (const auto& p : points) highest = in_column(p) ? std::max(highest, p[1]) : highest;
    for (const auto& p : thin) highest_kept = in_column(p) ? std::max(highest_kept, p[1]) : highest_kept;
    EXPECT_EQ(highest, highest_kept) << "column " << column;
  }
}

TEST(Decimate, LeavesFewPointsAndClosedCurvesAlone) {
  const Points few = {{0, 1}, {1, 5}, {2, -1}};
  EXPECT_EQ(decimate(few, 800), few);
  Points circle;
  for (int i = 0; i <= 3000; ++i) circle.push_back({std::cos(i * 0.01), std::sin(i * 0.01)});
  EXPECT_EQ(decimate(circle, 100).size(), circle.size());
}

TEST(Decimate, NotANumberBreaksTheLine) {
  Plot plot;
  plot.title = "Feed";
  plot.series = {{"", {{0, 0}, {1, 1}, {2, std::numeric_limits<double>::quiet_NaN()}, {3, 1}, {4, 0}}}};
  const std::string svg = plot_svg(plot);
  const std::string data = svg.substr(svg.find("series s0"));
  EXPECT_EQ(std::ranges::count(data.substr(0, data.find("/>")), 'M'), 2);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

Plot histogram() {
  Plot plot;
  plot.title = "Ridges <all>";
  plot.x_label = "Height";
  plot.x_unit = "µm";
  plot.y_label = "Count";
  plot.bars = {{9.0, 9.5, 3}, {9.5, 10.0, 40}, {10.0, 10.5, 0}};
  plot.limits = {{10.5, "limit", true}};
  return plot;
}

TEST(PlotSvg, DrawsBarsFromZeroWithUnitsAndLimit) {
  const std::string svg = plot_svg(histogram());
  EXPECT_EQ(svg.find("<rect", svg.find("<rect", svg.find("<rect") + 1) + 1), std::string::npos)
      << "an empty bin needs no bar";
  EXPECT_NE(svg.find("Height (µm)"), std::string::npos);
  EXPECT_NE(svg.find(">limit</text>"), std::string::npos);
  EXPECT_NE(svg.find("Ridges &lt;all&gt;"), std::string::npos);
  EXPECT_EQ(svg.find("<all>"), std::string::npos);
}

TEST(PlotSvg, TakesThePowerOfTenOutOfSmallNumbers) {
  Plot plot;
  plot.title = "Error";
  plot.x_label = "Time";
  plot.x_unit = "s";
  plot.y_label = "Error";
  plot.y_unit = "mm";
  plot.series = {{"", {{0, 0}, {1, 3e-13}}}};
  EXPECT_NE(plot_svg(plot).find("Error (×10⁻¹⁵ mm)"), std::string::npos);
}

TEST(PlotSvg, EmptyPlotStillHasAxes) {
  Plot plot;
  plot.title = "Nothing yet";
  const std::string svg = plot_svg(plot);
  EXPECT_NE(svg.find("class=\"base\""), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

}  // namespace
}  // namespace swarf::reports
