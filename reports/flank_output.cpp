#include "reports/flank_output.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/units.h"

namespace swarf::reports {
namespace {

using FlankJson = nlohmann::ordered_json;
using sim::FlankFigures;

FlankJson place_json(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

FlankJson heights_json(const sim::FlankHeights& heights) {
  return {{"least_um", um_from_mm(heights.least_mm)},
          {"greatest_um", um_from_mm(heights.greatest_mm)},
          {"least_at_mm", place_json(heights.least_W)}};
}

FlankJson guide_json(const flank::GuideFigures& guide) {
  FlankJson json{{"length_mm", guide.length_mm}};
  if (std::isfinite(guide.radius_min_mm)) {
    json["radius_min_mm"] = guide.radius_min_mm;
    json["radius_min_u"] = guide.radius_min_u;
  }
  return json;
}

Table placement_table(const FlankFigures& figures) {
  Table table;
  table.title = "Placements of the axis";
  table.intro = fmt::format(
      "The greatest error of the envelope over all rulings, whose normals turn by up to {:.4f} deg. The "
      "paper's placement cannot go below {:.3f} µm, whatever the feed (E18).",
      deg_from_rad(figures.twist_max_rad), um_from_mm(figures.twist_bound_mm));
  table.columns = {{"Placement"}, {"Error", "µm", true}, {"at u", "", true}, {"at v", "", true}};
  for (const sim::FlankPlacementRow& row : figures.placements) {
    if (row.used) table.highlighted_row = static_cast<int>(table.rows.size());
    table.rows.push_back({row.name, fmt::format("{:.4f}", um_from_mm(row.worst.mm)),
                          fmt::format("{:.4f}", row.worst.u), fmt::format("{:.3f}", row.worst.v)});
  }
  table.notes = {
      "Below 0: too deep. Published: on both guide curves (Chu et al., Eq. 2). Balanced: lifted off "
      "at both ends. Minimax: turned about the normal too, the least maximum of every ruling."};
  return table;
}

Table envelope_table(const FlankFigures& figures) {
  Table table;
  table.title = "Envelope: predicted and cut";
  table.intro = fmt::format(
      "Predicted from the poses in closed form, at the {} measuring rays that a flank meets ({} meet none, "
      "or "
      "only an end of one, and are not compared). The cut rays differ from the prediction by at most {:.4f} "
      "µm.",
      figures.rays_compared, figures.rays_elsewhere, um_from_mm(figures.difference_max_mm));
  table.columns = {{"Motion"}, {"Deepest", "µm", true}, {"Highest", "µm", true}};
  const auto add = [&](const char* name, const sim::FlankHeights& heights) {
    table.rows.push_back({name, fmt::format("{:.4f}", um_from_mm(heights.least_mm)),
                          fmt::format("{:.4f}", um_from_mm(heights.greatest_mm))});
  };
  add("as the blocks ask", figures.blocks_left);
  add("as the control's cycles make it", figures.cycles_left);
  return table;
}

Table feed_table(const FlankFigures& figures) {
  Table table;
  table.title = "Feed";
  table.intro =
      "The same blocks at the speeds of each rule, under the same axis limits; errors are those of the "
      "chords of "
      "all cycles, the placement's included.";
  table.columns = {{"Rule"},
                   {"Time", "s", true},
                   {"Mean feed", "mm/s", true},
                   {"Deepest", "µm", true},
                   {"Highest", "µm", true}};
  for (const sim::FlankFeedRow& row : figures.feeds) {
    if (row.used) table.highlighted_row = static_cast<int>(table.rows.size());
    table.rows.push_back({row.name, fmt::format("{:.3f}", row.time_s),
                          fmt::format("{:.2f}", row.feed_mean_mm_s),
                          fmt::format("{:.4f}", um_from_mm(row.least_mm)),
                          fmt::format("{:.4f}", um_from_mm(row.greatest_mm))});
  }
  return table;
}

}  // namespace

FlankJson flank_milling_json(const sim::Result& result) {
  const FlankFigures& figures = *result.flank_milling;
  FlankJson placements = FlankJson::object(), feeds = FlankJson::array();
  for (const sim::FlankPlacementRow& row : figures.placements)
    placements[row.name] = {{"error_um", um_from_mm(row.worst.mm)}, {"u", row.worst.u}, {"v", row.worst.v}};
  for (const sim::FlankFeedRow& row : figures.feeds)
    feeds.push_back({{"name", row.name},
                     {"time_s", row.time_s},
                     {"feed_mean_mm_s", row.feed_mean_mm_s},
                     {"least_um", um_from_mm(row.least_mm)},
                     {"greatest_um", um_from_mm(row.greatest_mm)},
                     {"used", row.used}});
  return {{"surfaces", figures.surfaces},
          {"passes", figures.passes},
          {"blocks", figures.blocks},
          {"plan_s", figures.plan_seconds},
          {"twist_max_deg", deg_from_rad(figures.twist_max_rad)},
          {"twist_bound_um", um_from_mm(figures.twist_bound_mm)},
          {"guides", {guide_json(figures.guides[0]), guide_json(figures.guides[1])}},
          {"curve_feed_1um_1ms_mm_s", figures.feed_1um_mm_s},
          {"curve_feed_5um_1ms_mm_s", figures.feed_5um_mm_s},
          {"placements", placements},
          {"blocks_left", heights_json(figures.blocks_left)},
          {"cycles_left", heights_json(figures.cycles_left)},
          {"rays_compared", figures.rays_compared},
          {"rays_not_compared", figures.rays_elsewhere},
          {"prediction_error_max_um", um_from_mm(figures.difference_max_mm)},
          {"prediction_error_at_mm", place_json(figures.difference_W)},
          {"feeds", feeds}};
}

std::vector<std::pair<std::string, std::string>> flank_lines(const sim::Result& result) {
  const FlankFigures& figures = *result.flank_milling;
  std::string placements;
  for (const sim::FlankPlacementRow& row : figures.placements)
    placements += fmt::format("{}{} {:.3f} um{}", placements.empty() ? "" : ", ", row.name,
                              um_from_mm(row.worst.mm), row.used ? " (used)" : "");
  std::vector<std::pair<std::string, std::string>> lines{
      {"flank milling",
       fmt::format("{} passes over {} ruled surfaces, {} blocks; twist {:.4f} deg", figures.passes,
                   figures.surfaces, figures.blocks, deg_from_rad(figures.twist_max_rad))},
      {"placements", placements},
      {"envelope",
       fmt::format(
           "predicted {:.3f} to {:.3f} um by blocks, {:.3f} to {:.3f} um by cycles; rays differ from it by "
           "{:.4f} um at most ({} compared, {} not)",
           um_from_mm(figures.blocks_left.least_mm), um_from_mm(figures.blocks_left.greatest_mm),
           um_from_mm(figures.cycles_left.least_mm), um_from_mm(figures.cycles_left.greatest_mm),
           um_from_mm(figures.difference_max_mm), figures.rays_compared, figures.rays_elsewhere)}};
  for (const sim::FlankFeedRow& row : figures.feeds)
    lines.emplace_back("feed " + row.name, fmt::format("{:.3f} s, chords {:.3f} to {:.3f} um{}", row.time_s,
                                                       um_from_mm(row.least_mm), um_from_mm(row.greatest_mm),
                                                       row.used ? " (used)" : ""));
  return lines;
}

Topic flank_topic(const sim::Result& result) {
  Topic topic;
  topic.id = "flank-milling";
  topic.name = "Flank milling";
  topic.title = "Flank milling of ruled surfaces";
  const FlankFigures& figures = *result.flank_milling;
  topic.tables = {placement_table(figures), envelope_table(figures), feed_table(figures)};
  return topic;
}

std::vector<Plot> flank_plots(const sim::Result& result) {
  Plot plot;
  plot.title = "Envelope error along the surface";
  plot.caption =
      "Deepest and highest place of each ruling of the first surface: predicted from the poses, and met by "
      "the "
      "measuring rays in the cut.";
  plot.x_label = "u";
  plot.y_label = "height over the design";
  plot.y_unit = "µm";
  using Row = sim::FlankProfileRow;
  const auto series = [&](const char* name, double Row::*value) {
    std::vector<std::array<double, 2>> points;
    for (const Row& row : result.flank_milling->profile) points.push_back({row.u, um_from_mm(row.*value)});
    plot.series.push_back({name, points});
  };
  series("deepest, predicted", &Row::predicted_least_mm);
  series("highest, predicted", &Row::predicted_greatest_mm);
  series("deepest, cut", &Row::measured_least_mm);
  series("highest, cut", &Row::measured_greatest_mm);
  return {plot};
}

}  // namespace swarf::reports
