#include "reports/driven_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/units.h"

namespace swarf::reports {
namespace {

using motion::DrivenStatistics;
using motion::DrivenTracePoint;

/// Points of a plot; longer traces are thinned to the least and the greatest of each part, so that no dip of
/// the speed is lost.
constexpr size_t kPlotPoints = 1200;

std::vector<std::array<double, 2>> thinned(const std::vector<DrivenTracePoint>& trace,
                                           double DrivenTracePoint::*value) {
  std::vector<std::array<double, 2>> points;
  const size_t part = std::max<size_t>(1, 2 * trace.size() / kPlotPoints);
  for (size_t i = 0; i < trace.size(); i += part) {
    const auto begin = trace.begin() + static_cast<ptrdiff_t>(i);
    const auto end = trace.begin() + static_cast<ptrdiff_t>(std::min(trace.size(), i + part));
    auto [low, high] = std::minmax_element(
        begin, end,
        [&](const DrivenTracePoint& a, const DrivenTracePoint& b) { return a.*value < b.*value; });
    if (high < low) std::swap(low, high);
    points.push_back({low->s_mm, (*low).*value});
    if (high != low) points.push_back({high->s_mm, (*high).*value});
  }
  return points;
}

Table comparison(const sim::Result& result) {
  Table table;
  table.title = "Driven by the surface, and by a CAM system's blocks";
  table.intro =
      "The same guides, cutter, feed and machine. CAM: the longest straight blocks within the tolerance, "
      "under "
      "look-ahead. Position error: distance of the cycles and of the middles of their chords from the exact "
      "positions of the tool.";
  table.columns = {{"Path"},
                   {"Blocks", "", true},
                   {"Program", "kB", true},
                   {"Time", "s", true},
                   {"Mean feed", "mm/s", true},
                   {"Position error", "µm", true},
                   {"rms", "µm", true},
                   {"Gouge", "µm", true},
                   {"Scallop max", "µm", true}};
  for (const sim::DrivenRow& row : result.driven_rows) {
    if (row.used) table.highlighted_row = static_cast<int>(table.rows.size());
    table.rows.push_back({row.name, fmt::format("{}", row.blocks),
                          fmt::format("{:.1f}", static_cast<double>(row.program_bytes) / 1024.0),
                          fmt::format("{:.2f}", row.time_s), fmt::format("{:.2f}", row.feed_mean_mm_s),
                          fmt::format("{:.4f}", um_from_mm(row.position_error_max_mm)),
                          fmt::format("{:.4f}", um_from_mm(row.position_error_rms_mm)),
                          fmt::format("{:.3f}", row.surface.gouge_max_um),
                          fmt::format("{:.2f}", row.surface.scallop_max_um)});
  }
  table.notes = {
      "The highlighted path is the one that this run has cut the stock with; its gouge is proven, that of "
      "the "
      "others is what the measuring rays meet."};
  return table;
}

std::string pass_shown(const DrivenStatistics& driven) {
  return driven.creases + driven.steps > 0 ? "The pass with the most corners."
                                           : "The first pass; no pass has a crease or a step.";
}

/// What happens at the corners that the passes have.
std::string corners_met(const DrivenStatistics& driven) {
  if (driven.creases + driven.steps == 0) return "";
  std::string text = driven.creases > 0 ? " Creases are ends of chords" : "";
  if (driven.steps > 0)
    text += text.empty() ? " Steps are climbed straight up" : ", steps are climbed straight up";
  return text + " (Kato et al., Fig. 3b and 5).";
}

Plot speed_plot(const DrivenStatistics& driven) {
  Plot plot;
  plot.title = "Speed and clamp speeds along a pass";
  plot.caption = pass_shown(driven) + (driven.clamped_cells > 0
                                           ? " Each clamp is met before it is reached (Kato et al., Fig. 4)."
                                           : " No clamp lies below the set feed.");
  plot.x_label = "way of the tip";
  plot.x_unit = "mm";
  plot.y_label = "speed";
  plot.y_unit = "mm/s";
  plot.y_from_zero = true;
  plot.series.push_back({"clamp", thinned(driven.trace, &DrivenTracePoint::clamp_mm_s)});
  plot.series.push_back({"speed", thinned(driven.trace, &DrivenTracePoint::feed_mm_s)});
  return plot;
}

Plot height_of_tip(const DrivenStatistics& driven) {
  Plot plot;
  plot.title = "The tip along the same pass";
  plot.caption = pass_shown(driven) + corners_met(driven);
  plot.x_label = "way of the tip";
  plot.x_unit = "mm";
  plot.y_label = "height";
  plot.y_unit = "mm";
  plot.series.push_back({"tip", thinned(driven.trace, &DrivenTracePoint::z_mm)});
  return plot;
}

}  // namespace

nlohmann::ordered_json driven_json(const sim::Result& result) {
  const DrivenStatistics& driven = *result.driven;
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const sim::DrivenRow& row : result.driven_rows) {
    rows.push_back({{"name", row.name},
                    {"used", row.used},
                    {"cam_tolerance_um", um_from_mm(row.cam_tolerance_mm)},
                    {"blocks", row.blocks},
                    {"program_bytes", row.program_bytes},
                    {"time_s", row.time_s},
                    {"feed_mean_mm_s", row.feed_mean_mm_s},
                    {"feed_lowest_mm_s", row.feed_lowest_mm_s},
                    {"position_error_max_um", um_from_mm(row.position_error_max_mm)},
                    {"position_error_rms_um", um_from_mm(row.position_error_rms_mm)},
                    {"gouge_max_um", row.surface.gouge_max_um},
                    {"scallop_max_um", row.surface.scallop_max_um}});
  }
  return {{"passes", driven.passes},
          {"cycles", driven.cycles},
          {"positions_ahead", driven.positions_ahead},
          {"creases", driven.creases},
          {"steps", driven.steps},
          {"clamped_cells", driven.clamped_cells},
          {"slowest_clamp_mm_s", driven.slowest_clamp_mm_s},
          {"chord_error_max_rel", driven.chord_error_max_rel},
          {"crease_miss_max_um", um_from_mm(driven.crease_miss_max_mm)},
          {"cycles_off_chord", driven.off_chord},
          {"cycles_above_clamp", driven.above_clamp},
          {"cycles_above_acceleration", driven.above_acceleration},
          {"cycles_above_jerk", driven.above_jerk},
          {"acceleration_max_mm_s2", driven.acceleration_max},
          {"jerk_max_mm_s3", driven.jerk_max},
          {"comparison", std::move(rows)}};
}

std::vector<std::pair<std::string, std::string>> driven_lines(const sim::Result& result) {
  const DrivenStatistics& driven = *result.driven;
  std::vector<std::pair<std::string, std::string>> lines{
      {"surface driven",
       fmt::format("{} passes, {} creases, {} steps; chords within {:.1e}, creases met within {:.1e} um",
                   driven.passes, driven.creases, driven.steps, driven.chord_error_max_rel,
                   um_from_mm(driven.crease_miss_max_mm))},
      {"clamps", fmt::format("{} cycles above a clamp, {} above the acceleration, {} above the jerk",
                             driven.above_clamp, driven.above_acceleration, driven.above_jerk)}};
  for (const sim::DrivenRow& row : result.driven_rows)
    lines.emplace_back(
        row.name, fmt::format("{} blocks, {:.2f} s, position error {:.4f} um, gouge {:.3f} um", row.blocks,
                              row.time_s, um_from_mm(row.position_error_max_mm), row.surface.gouge_max_um));
  return lines;
}

Topic driven_topic(const sim::Result& result) {
  Topic topic;
  topic.id = "driven";
  topic.name = "Surface driven";
  topic.title = "Driven by the surface";
  topic.tables.push_back(comparison(result));
  return topic;
}

std::vector<Plot> driven_plots(const sim::Result& result) {
  return {speed_plot(*result.driven), height_of_tip(*result.driven)};
}

}  // namespace swarf::reports
