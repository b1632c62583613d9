#include "reports/compare_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"
#include "mesh/mesh_ops.h"
#include "render/figures/colour.h"
#include "render/gltf/gltf_writer.h"
#include "reports/check_rows.h"
#include "reports/mesh_section.h"
#include "reports/pictures.h"

namespace swarf::reports {
namespace {

constexpr size_t kHistogramBars = 41;
constexpr size_t kCloseSections = 3;   // of the worst places
constexpr double kCloseWindow = 12.0;  // times the deviation: half of a close section's width
constexpr double kSectionMargin = 1.05;
constexpr double kCompareCreaseRad = 0.5;  // edges that turn by more are shaded as edges
constexpr double kSectionAspect = 0.56;    // height over width of a close section

std::string region_title(const ComparedPair& pair, const measure::DeviationRegion& region) {
  const char* what =
      pair.revisions ? (region.gouge ? "removed" : "added") : (region.gouge ? "gouge" : "excess");
  return fmt::format("{} {:.3f} µm, {:.3g} mm² of the {}{}", what, region.worst_um,
                     std::max(region.stock_area_mm2, region.design_area_mm2),
                     region.stock_area_mm2 >= region.design_area_mm2 ? "stock" : "design",
                     region.volume_mm3 ? fmt::format(", {:.4g} mm³", *region.volume_mm3) : "");
}

ReportFinding region_finding(const ComparedPair& pair, const measure::DeviationRegion& region) {
  ReportFinding finding;
  finding.code = pair.revisions ? (region.gouge ? "removed" : "added") : (region.gouge ? "gouge" : "excess");
  finding.severity = Severity::kError;
  finding.text = region_title(pair, region);
  finding.has_place = true;
  for (size_t k = 0; k < 3; ++k) finding.place_mm[k] = region.place[static_cast<Eigen::Index>(k)];
  return finding;
}

/// Area by the worst deviation of each cell, both ends open.
Plot histogram(const measure::PartComparison& result, double scale_um) {
  Plot plot;
  plot.title = "Area by deviation";
  plot.caption =
      "Of the stock's surface; a cell counts with the worst that was found in it, and what lies beyond the "
      "ends of the axis in the last bars.";
  plot.x_label = "deviation";
  plot.x_unit = "µm";
  plot.y_label = "area";
  plot.y_unit = "mm²";
  const double low = -2.0 * scale_um, width = 4.0 * scale_um / kHistogramBars;
  for (size_t i = 0; i < kHistogramBars; ++i)
    plot.bars.push_back(
        {low + static_cast<double>(i) * width, low + static_cast<double>(i + 1) * width, 0.0});
  const TriMesh& map = result.stock_map;
  for (const auto& t : map.triangles) {
    std::array<Vec3, 3> corner;
    float worst = 0.0F;
    for (size_t i = 0; i < 3; ++i) {
      corner[i] = Vec3(map.positions[t[i]][0], map.positions[t[i]][1], map.positions[t[i]][2]);
      const float um = map.deviation_um[t[i]];
      if (!std::isnan(um) && std::abs(um) > std::abs(worst)) worst = um;
    }
    const double at = std::clamp((static_cast<double>(worst) - low) / width, 0.0, kHistogramBars - 0.5);
    plot.bars[static_cast<size_t>(at)].value +=
        0.5 * (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm();
  }
  return plot;
}

Figure section_figure(const ComparedPair& pair, const measure::ComparisonInput& input,
                      const SectionPlane& plane, const std::string& title, const std::string& caption) {
  Figure figure;
  figure.title = title;
  figure.caption = caption;
  figure.legend = {{"series s0", pair.revisions ? "earlier" : "design"},
                   {"series s1", pair.revisions ? "now" : "stock"}};
  figure.svg =
      section_svg({{&input.design->mesh(), "series s0"}, {&input.stock->mesh(), "series s1"}}, plane);
  return figure;
}

/// The plane across an axis, with all of both parts in its window.
SectionPlane whole_plane(const measure::ComparisonInput& input, const Vec3& place, int across) {
  Box box = mesh::bounds(input.design->mesh());
  const Box stock = mesh::bounds(input.stock->mesh());
  box.lower = box.lower.cwiseMin(stock.lower);
  box.upper = box.upper.cwiseMax(stock.upper);
  SectionPlane plane;
  plane.right = across == 0 ? Vec3::UnitY() : Vec3::UnitX();
  plane.up = across == 2 ? Vec3::UnitY() : Vec3::UnitZ();
  plane.centre = place;
  // The ring is about the middle: the window reaches as far on both sides.
  const auto reach = [&](const Vec3& direction) {
    return kSectionMargin * std::max(direction.dot(box.upper - place), direction.dot(place - box.lower));
  };
  plane.half_width_mm = reach(plane.right);
  plane.half_height_mm = reach(plane.up);
  return plane;
}

/// Across the surface at the worst place, so near that the deviation is a good part of the window.
SectionPlane close_plane(const measure::ComparisonInput& input, const measure::DeviationRegion& region) {
  const Vec3 normal = input.design->at(region.place).normal;
  SectionPlane plane;
  plane.centre = region.place;
  plane.up = normal;
  const Vec3 beside = std::abs(normal.z()) < 0.9 ? Vec3::UnitZ() : Vec3::UnitX();
  plane.right = beside.cross(normal).normalized();
  plane.half_width_mm = kCloseWindow * std::max(region.worst_um, 1e-3) * kMicrometre;
  plane.half_height_mm = kSectionAspect * plane.half_width_mm;
  return plane;
}

std::string place_words(const Vec3& p) {
  return fmt::format("X {:.3f} Y {:.3f} Z {:.3f} mm", p.x(), p.y(), p.z());
}

Topic sections_topic(const ComparedPair& pair, const measure::ComparisonInput& input,
                     const measure::PartComparison& result) {
  Topic topic{"sections", "Sections", "Sections"};
  const Vec3 place =
      result.regions.empty() ? mesh::bounds(input.design->mesh()).centre() : result.regions[0].place;
  topic.intro = result.regions.empty()
                    ? "Through the middle; no place is beyond a limit."
                    : "Through the worst place, then close up: to scale in both directions.";
  constexpr std::array kAcross{"across X", "across Y", "across Z"};
  for (int i = 0; i < 3; ++i)
    topic.figures.push_back(
        section_figure(pair, input, whole_plane(input, place, i),
                       fmt::format("{}, at {:.3f} mm", kAcross[static_cast<size_t>(i)], place[i]), ""));
  for (size_t i = 0; i < std::min(kCloseSections, result.regions.size()); ++i)
    topic.figures.push_back(section_figure(
        pair, input, close_plane(input, result.regions[i]), fmt::format("Place {}, close", i + 1),
        region_title(pair, result.regions[i]) + " at " + place_words(result.regions[i].place)));
  return topic;
}

Table regions_table(const ComparedPair& pair, const measure::PartComparison& result) {
  Table table;
  table.title = pair.revisions ? "What changed" : "Regions beyond a limit";
  table.columns = {{"Place"},
                   {"What"},
                   {"Worst", "µm", true},
                   {"X", "mm", true},
                   {"Y", "mm", true},
                   {"Z", "mm", true},
                   {"Stock", "mm²", true},
                   {"Design", "mm²", true},
                   {"Volume", "mm³", true}};
  for (size_t i = 0; i < result.regions.size(); ++i) {
    const measure::DeviationRegion& r = result.regions[i];
    table.rows.push_back({fmt::format("{}", i + 1), region_finding(pair, r).code,
                          fmt::format("{:.3f}", r.worst_um), fmt::format("{:.3f}", r.place.x()),
                          fmt::format("{:.3f}", r.place.y()), fmt::format("{:.3f}", r.place.z()),
                          fmt::format("{:.3f}", r.stock_area_mm2), fmt::format("{:.3f}", r.design_area_mm2),
                          r.volume_mm3 ? fmt::format("{:.4g}", *r.volume_mm3) : "–"});
  }
  if (result.region_count > result.regions.size())
    table.notes = {fmt::format("The worst {} of {}.", result.regions.size(), result.region_count)};
  return table;
}

Table numbers_table(const ComparedPair& pair) {
  Table table;
  table.title = "Numbers";
  table.columns = {{"What"}, {"Value"}};
  for (const auto& [name, value] : pair.rows) table.rows.push_back({name, value});
  if (!pair.alignment.empty()) table.rows.push_back({"alignment", pair.alignment});
  if (pair.revisions)
    table.notes = {
        "Two stocks as their grids show them: each is off from its part by its own grid error, which is not "
        "added here."};
  return table;
}

/// The stock's cells with their deviation.
std::string compare_glb(TriMesh map, double scale_um) {
  mesh::compute_vertex_normals(map, kCompareCreaseRad);
  for (float& um : map.deviation_um)
    if (std::isnan(um)) um = 0.0F;
  render::GltfScene scene;
  render::GltfNode part{"stock", &map, {{1.0F, 1.0F, 1.0F}, 0.0F, 0.6F}, -1, {}, {}};
  part.extras = {{"role", "part"}};
  scene.nodes.push_back(part);
  scene.extras = {{"deviation_scale_below_um", scale_um}, {"deviation_scale_above_um", scale_um}};
  return render::glb_bytes(scene, render::GltfEncoding::kMeshopt);
}

/// Excess and gouge of two revisions are what was added and removed.
std::vector<sim::Check> named_checks(const ComparedPair& pair) {
  std::vector<sim::Check> checks = pair.checks;
  for (sim::Check& check : checks) {
    if (pair.revisions && check.name == "excess") check.subject = "Most added";
    if (pair.revisions && check.name == "gouge") check.subject = "Most removed";
  }
  return checks;
}

/// mm3; what meshes of both err by is no difference.
std::string volume_text(double mm3) {
  constexpr double kLeast = 1e-6;
  return std::abs(mm3) < kLeast ? "0" : fmt::format("{:.4g}", mm3);
}

KeyNumber extreme_number(const char* label, const measure::DeviationExtreme& extreme,
                         const sim::Check* check) {
  return {label, fmt::format("{:.3f}", extreme.um), "µm",
          fmt::format("proven below {:.3f} µm", extreme.bound_um),
          check == nullptr ? Tone::kNeutral : tone_of(*check)};
}

}  // namespace

ReportData compare_page(const ComparedPair& pair, const measure::ComparisonInput& input,
                        const measure::PartComparison& result, double scale_um) {
  ReportData data;
  data.title = pair.revisions ? "What changed" : "Stock against design";
  data.subtitle = pair.stock + " against " + pair.design;
  const std::vector<sim::Check> checks = named_checks(pair);
  data.verdict = verdict_of(checks);
  data.key_numbers = {
      extreme_number(pair.revisions ? "Most added" : "Highest excess", result.excess,
                     sim::find_check(pair.checks, "excess")),
      extreme_number(pair.revisions ? "Most removed" : "Deepest gouge", result.gouge,
                     sim::find_check(pair.checks, "gouge")),
      {"Within tolerance", fmt::format("{:.2f}", result.within_tolerance_pct), "%", "of the area of both"},
      {"Mean, absolute", fmt::format("{:.3f}", result.mean_abs_um), "µm",
       fmt::format("rms {:.3f} µm", result.rms_um)}};
  if (result.difference_mm3)
    data.key_numbers.push_back(
        {pair.revisions ? "Now less earlier" : "Stock less design", volume_text(*result.difference_mm3),
         "mm³",
         fmt::format("{} mm³ {}, {} mm³ {}", volume_text(*result.excess_mm3),
                     pair.revisions ? "added" : "too much", volume_text(*result.gouge_mm3),
                     pair.revisions ? "removed" : "missing")});
  for (size_t i = 0; i < std::min(kPicturedRegions, result.regions.size()); ++i)
    data.findings.push_back(region_finding(pair, result.regions[i]));
  data.viewer.part_glb = compare_glb(result.stock_map, scale_um);
  data.viewer.colour_bar = deviation_colour_bar(render::DeviationScale(scale_um));
  data.viewer.colour_bar.title =
      pair.revisions ? "Change from the earlier to the present stock" : "Deviation from the design";
  data.viewer.colour_bar.low_value = -scale_um;
  data.viewer.colour_bar.high_value = scale_um;
  data.plots = {histogram(result, scale_um)};
  data.tables = {numbers_table(pair)};
  if (!result.regions.empty()) data.tables.insert(data.tables.begin(), regions_table(pair, result));
  data.topics = {sections_topic(pair, input, result)};
  data.checks = check_rows(checks);
  data.reproduce = {pair.command};
  return data;
}

}  // namespace swarf::reports
