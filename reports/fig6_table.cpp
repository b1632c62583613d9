#include "reports/fig6_table.h"

#include <fmt/format.h>

#include "motion/offline_baseline.h"

namespace swarf::reports {

Table fig6_table() {
  Table table;
  table.title = "Fig. 6: the curve of Eq. (8) cut into line segments";
  table.columns = {{"Segmentation"},
                   {"Segments", "", true},
                   {"Chord error", "µm", true},
                   {"Linear in u (Eq. 7)", "deg", true},
                   {"Linear along the chord", "deg", true},
                   {"Constant", "deg", true}};
  for (const motion::Fig6Row& row : motion::reproduce_fig6()) {
    table.rows.push_back({row.segmentation, fmt::format("{}", row.segments),
                          fmt::format("{:.4f}", row.chord_error_um), fmt::format("{:.6f}", row.linear_u_deg),
                          fmt::format("{:.6f}", row.linear_chord_deg),
                          fmt::format("{:.2f}", row.constant_deg)});
  }
  table.notes = {
      "Columns three to five: largest orientation error inside a segment, by how the orientation is "
      "interpolated."};
  return table;
}

Plot fig6_plot() {
  Plot plot;
  plot.title = "Fig. 6: orientation error of off-line segments, curve of Eq. (8)";
  plot.caption = "Orientation linear along the chord, which is what the paper's 0.017 deg belongs to (E5).";
  plot.x_label = "curve parameter u";
  plot.y_label = "orientation error";
  plot.y_unit = "deg";
  for (const motion::Fig6Row& row : motion::reproduce_fig6()) {
    Series series{fmt::format("{}, {} segments", row.segmentation, row.segments), {}};
    for (const Vec2& point : row.curve) series.points.push_back({point.x(), point.y()});
    plot.series.push_back(std::move(series));
  }
  return plot;
}

}  // namespace swarf::reports
