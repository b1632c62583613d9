#include "reports/heat_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "reports/html.h"
#include "reports/svg_plot.h"

namespace swarf::reports {
namespace {

constexpr double kMapWidth = 540.0, kMapHeight = 300.0;
constexpr double kMapLeft = 46.0, kMapRight = 78.0, kMapTop = 12.0, kMapBottom = 40.0;
constexpr double kBarWidth = 14.0;

struct Binned {
  int columns = 0, rows = 0;
  std::vector<double> values;
};

int bin_of(const std::vector<double>& places, size_t i, int bins) {
  const double width = places.back() - places.front();
  const double share = width > 0.0 ? (places[i] - places.front()) / width : 0.0;
  return std::clamp(static_cast<int>(share * bins), 0, bins - 1);
}

Binned binned(const HeatMap& map) {
  Binned out;
  out.columns = std::min(kCells, static_cast<int>(map.x.size()));
  out.rows = std::min(kCells, static_cast<int>(map.y.size()));
  out.values.assign(static_cast<size_t>(out.columns * out.rows), std::numeric_limits<double>::quiet_NaN());
  for (size_t iy = 0; iy < map.y.size(); ++iy) {
    for (size_t ix = 0; ix < map.x.size(); ++ix) {
      const double value = map.values[iy * map.x.size() + ix];
      const auto cell =
          static_cast<size_t>(bin_of(map.y, iy, out.rows) * out.columns + bin_of(map.x, ix, out.columns));
      double& held = out.values[cell];
      if (std::isnan(held) || std::abs(value) > std::abs(held)) held = value;
    }
  }
  return out;
}

std::string cells_svg(const HeatMap& map, double width, double height) {
  const Binned cells = binned(map);
  const double w = width / cells.columns, h = height / cells.rows;
  std::string out;
  for (int iy = 0; iy < cells.rows; ++iy) {
    for (int ix = 0; ix < cells.columns; ++ix) {
      const double value = cells.values[static_cast<size_t>(iy * cells.columns + ix)];
      const std::string colour = std::isnan(value) ? "#9a9a9a" : heat_colour(value / map.most);
      // A little wider than the cell: no seams between neighbours.
      out += fmt::format(R"(<rect x="{:.2f}" y="{:.2f}" width="{:.2f}" height="{:.2f}" fill="{}"/>)",
                         kMapLeft + ix * w, kMapTop + height - (iy + 1) * h, w + 0.3, h + 0.3, colour);
    }
  }
  return out;
}

std::string text_svg(double x, double y, const char* anchor, const std::string& words) {
  return fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}">{}</text>)", x, y, anchor,
                     escape(words));
}

std::string bar_svg(const HeatMap& map, double height) {
  constexpr int kSteps = 40;
  const double x = kMapWidth - kMapRight + 18.0;
  std::string out;
  for (int i = 0; i < kSteps; ++i)
    out += fmt::format(R"(<rect x="{:.1f}" y="{:.2f}" width="{:.1f}" height="{:.2f}" fill="{}"/>)", x,
                       kMapTop + height * (kSteps - 1 - i) / kSteps, kBarWidth, height / kSteps + 0.3,
                       heat_colour(2.0 * (i + 0.5) / kSteps - 1.0));
  for (const double share : {-1.0, 0.0, 1.0})
    out += text_svg(x + kBarWidth + 5.0, kMapTop + height * 0.5 * (1.0 - share) + 4.0, "start",
                    share == 0.0 ? "0" : fmt::format("{:+.3g}", share * map.most));
  return out;
}

}  // namespace

std::string heat_colour(double share) {
  const double s = std::clamp(share, -1.0, 1.0), t = std::abs(s);
  // From white to a deep blue or red, evenly.
  const std::array<double, 3> white{246.0, 246.0, 244.0};
  const std::array<double, 3> end =
      s < 0.0 ? std::array<double, 3>{18.0, 78.0, 170.0} : std::array<double, 3>{186.0, 40.0, 30.0};
  std::array<int, 3> rgb{};
  for (size_t k = 0; k < 3; ++k) rgb[k] = static_cast<int>(std::lround(white[k] + t * (end[k] - white[k])));
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

Figure heat_map_figure(const HeatMap& map) {
  const double width = kMapWidth - kMapLeft - kMapRight, height = kMapHeight - kMapTop - kMapBottom;
  std::string svg = fmt::format(
      R"(<svg class="plot" viewBox="0 0 {:.0f} {:.0f}" role="img" aria-label="{}">)", kMapWidth, kMapHeight,
      escape(fmt::format("{}: {} over {} and {}, colours from {:.3g} to {:.3g}", map.title, map.unit,
                         map.x_label, map.y_label, -map.most, map.most)));
  if (!map.x.empty() && !map.y.empty()) {
    svg += cells_svg(map, width, height) + bar_svg(map, height);
    for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const auto at = [&](const std::vector<double>& places) {
        return fmt::format("{:.3g}", places.front() + share * (places.back() - places.front()));
      };
      svg += text_svg(kMapLeft + share * width, kMapTop + height + 16.0, "middle", at(map.x));
      svg += text_svg(kMapLeft - 6.0, kMapTop + (1.0 - share) * height + 4.0, "end", at(map.y));
    }
  }
  svg += text_svg(kMapLeft + 0.5 * width, kMapHeight - 6.0, "middle", map.x_label);
  svg += text_svg(12.0, kMapTop + 0.5 * height, "middle", map.y_label);
  svg += text_svg(kMapWidth - 4.0, kMapHeight - 6.0, "end", map.unit);
  return {map.title, svg + "</svg>", map.caption};
}

}  // namespace swarf::reports
