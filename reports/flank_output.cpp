#include "reports/flank_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/units.h"
#include "reports/flank_choices.h"
#include "reports/heat_map.h"

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

/// Infinite feeds, where the axis stands, are left out.
FlankJson c_feed_json(const FlankFigures& figures) {
  FlankJson json{{"u", 0.6}};
  const auto add = [&](const char* key, double mm_s) {
    if (std::isfinite(mm_s)) json[key] = mm_s;
  };
  add("by_speed_mm_s", figures.c_feed.by_speed);
  add("by_acceleration_mm_s", figures.c_feed.by_acceleration);
  add("least_mm_s", figures.c_feed_least.mm_s);
  json["least_u"] = figures.c_feed_least.u;
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
  table.columns = {
      {"Motion"}, {"Deepest", "µm", true}, {"Highest", "µm", true}, {"Adds at most", "µm", true}};
  const auto add = [&](const char* name, const sim::FlankHeights& heights, const std::string& added) {
    table.rows.push_back({name, fmt::format("{:.4f}", um_from_mm(heights.least_mm)),
                          fmt::format("{:.4f}", um_from_mm(heights.greatest_mm)), added});
  };
  add("on the axis surface itself: the placement", figures.placed, "");
  add("as the blocks ask", figures.blocks_left, fmt::format("{:.4f}", um_from_mm(figures.blocks_add_mm)));
  add("as the control's cycles make it", figures.cycles_left,
      fmt::format("{:.4f}", um_from_mm(figures.cycles_add_mm)));
  const Vec3& p = figures.cycles_left.most_W();
  table.notes = {
      fmt::format("The cycles err most at ({:.3f}, {:.3f}, {:.3f}) mm, in element {} of the path. \"Adds\" "
                  "is the greatest change of any ray against the row above.",
                  p.x(), p.y(), p.z(), figures.worst_element)};
  return table;
}

/// Greatest height of both fields of a surface, um: one scale for both.
double scale_of(const sim::FlankMap& map) {
  double most = 0.0;
  for (const std::vector<double>* field : {&map.predicted_mm, &map.cut_mm})
    for (const double h : *field)
      if (std::isfinite(h)) most = std::max(most, std::abs(um_from_mm(h)));
  return most > 0.0 ? most : 1.0;
}

std::vector<Figure> map_figures(const FlankFigures& figures) {
  std::vector<Figure> out;
  for (size_t s = 0; s < figures.maps.size(); ++s) {
    const sim::FlankMap& map = figures.maps[s];
    HeatMap heat{"", "", "u", "v", "µm", map.u, map.v, {}, scale_of(map)};
    const auto add = [&](const char* what, const std::vector<double>& field, const char* caption) {
      heat.title = fmt::format("Surface {}: {}", s + 1, what);
      heat.caption = caption;
      heat.values.clear();
      for (const double h : field) heat.values.push_back(um_from_mm(h));
      out.push_back(heat_map_figure(heat));
    };
    add("envelope as predicted", map.predicted_mm,
        "Height over the design of the exact envelope of the poses. Grey: no flank comes near.");
    add("envelope as cut", map.cut_mm,
        "The measuring rays in the cut stock, in the same colours. Grey: nothing was cut.");
  }
  return out;
}

Table rotary_table(const FlankFigures& figures) {
  Table table;
  table.title = "What a C axis leaves of the feed (limits of Ma et al.)";
  table.intro =
      "A machine with A and C whose tool lies along the rulings, its tip on guide curve 0: the feed of the "
      "tip at "
      "which C turns at .8 rad/s, and at which its acceleration at even feed is .5 rad/s².";
  table.columns = {{"Place"}, {"by speed", "mm/s", true}, {"by acceleration", "mm/s", true}};
  table.rows = {{"u = 0.6", fmt::format("{:.4f}", figures.c_feed.by_speed),
                 fmt::format("{:.4f}", figures.c_feed.by_acceleration)},
                {fmt::format("least, u = {:.4f}", figures.c_feed_least.u),
                 fmt::format("{:.4f}", figures.c_feed_least.mm_s), ""}};
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

FlankJson flank_milling_json(const sim::Job& job, const sim::Result& result) {
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
  FlankJson json = {{"surfaces", figures.surfaces},
                    {"passes", figures.passes},
                    {"blocks", figures.blocks},
                    {"plan_s", figures.plan_seconds},
                    {"twist_max_deg", deg_from_rad(figures.twist_max_rad)},
                    {"twist_bound_um", um_from_mm(figures.twist_bound_mm)},
                    {"guides", {guide_json(figures.guides[0]), guide_json(figures.guides[1])}},
                    {"curve_feed_1um_1ms_mm_s", figures.feed_1um_mm_s},
                    {"curve_feed_5um_1ms_mm_s", figures.feed_5um_mm_s},
                    {"c_limited_feed", c_feed_json(figures)},
                    {"placements", placements},
                    {"placed", heights_json(figures.placed)},
                    {"blocks_add_um", um_from_mm(figures.blocks_add_mm)},
                    {"cycles_add_um", um_from_mm(figures.cycles_add_mm)},
                    {"worst_element", figures.worst_element},
                    {"blocks_left", heights_json(figures.blocks_left)},
                    {"cycles_left", heights_json(figures.cycles_left)},
                    {"rays_compared", figures.rays_compared},
                    {"rays_not_compared", figures.rays_elsewhere},
                    {"prediction_error_max_um", um_from_mm(figures.difference_max_mm)},
                    {"prediction_error_at_mm", place_json(figures.difference_W)},
                    {"feeds", feeds}};
  add_choices(job, figures, json);
  return json;
}

std::vector<std::pair<std::string, std::string>> flank_lines(const sim::Job& job, const sim::Result& result) {
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
  for (auto& line : choice_lines(job, figures)) lines.push_back(std::move(line));
  return lines;
}

Topic flank_topic(const sim::Job& job, const sim::Result& result) {
  Topic topic;
  topic.id = "flank-milling";
  topic.name = "Flank milling";
  topic.title = "Flank milling of ruled surfaces";
  const FlankFigures& figures = *result.flank_milling;
  topic.tables = {placement_table(figures), envelope_table(figures), feed_table(figures)};
  if (std::isfinite(figures.c_feed_least.mm_s)) topic.tables.push_back(rotary_table(figures));
  for (Table& table : choice_tables(job, figures)) topic.tables.push_back(std::move(table));
  topic.figures = map_figures(figures);
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
