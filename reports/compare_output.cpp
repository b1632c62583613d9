#include "reports/compare_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/mesh_io.h"
#include "mesh/mesh_ops.h"
#include "render/camera.h"
#include "render/figures/colour.h"
#include "render/image_io.h"
#include "render/lettering.h"
#include "render/ray/still.h"
#include "reports/finding_pictures.h"
#include "reports/pending_folder.h"
#include "reports/pictures.h"
#include "reports/report_writer.h"

namespace swarf::reports {
namespace {

constexpr int kMapSamples = 16;
constexpr double kMapNoise = 5.0;  // of 255: StillOptions::noise

/// What the colours do not say by themselves.
std::vector<std::string> caption_of(const TriMesh& map, const std::string& title, double scale_um) {
  double low = 0.0, high = 0.0;
  bool unknown = false;
  for (const float um : map.deviation_um) {
    unknown = unknown || std::isnan(um);
    if (std::isnan(um)) continue;
    low = std::min(low, static_cast<double>(um));
    high = std::max(high, static_cast<double>(um));
  }
  std::vector<std::string> lines{title, fmt::format("{:+.3g} .. {:+.3g} µm", low, high)};
  if (std::max(-low, high) > scale_um)
    lines.emplace_back("strongest colours: at the scale's ends and beyond");
  if (unknown) lines.emplace_back("dark grey: not measured");
  return lines;
}

void write_map(PendingFolder& folder, TriMesh map, const std::string& name, const std::string& title,
               double scale_um) {
  render::colour_by_deviation(map, scale_um);
  mesh::save_mesh(folder.file(name + ".ply"), map);
  render::StillOptions options;  // as the stills of a run
  options.samples_per_pixel = kMapSamples;
  options.noise = kMapNoise;
  render::Image image = deviation_picture(map, scale_um, "iso", options, 0);
  render::draw_caption(image, caption_of(map, title, scale_um));
  render::save_png(image, folder.file(name + ".png"));
}

/// Each place on the surface that shows it.
void add_place_pictures(const PendingFolder& folder, const measure::PartComparison& result, double scale_um,
                        ReportData& page) {
  std::array<TriMesh, 2> maps{result.stock_map, result.design_map};
  for (TriMesh& map : maps) render::colour_by_deviation(map, scale_um);
  const double size = mesh::bounds(maps[1]).size().maxCoeff();
  for (size_t i = 0; i < page.findings.size(); ++i) {
    const measure::DeviationRegion& region = result.regions[i];
    const double own = std::sqrt(std::max(region.stock_area_mm2, region.design_area_mm2));
    page.findings[i].picture_png = folder.file(fmt::format("place_{}.png", i + 1));
    make_place_picture(maps[region.on_design ? 1 : 0], region.place, std::clamp(3.0 * own, 0.05 * size, size),
                       page.findings[i].picture_png);
  }
}

}  // namespace

void write_compare(const std::string& target, const ComparedPair& pair, const measure::ComparisonInput& input,
                   const measure::PartComparison& result, double scale_um, const std::string& metrics) {
  PendingFolder folder(target);
  const char* words = pair.revisions ? "the earlier stock" : "the design";
  write_map(folder, result.stock_map, "deviation", fmt::format("the stock, against {}", words), scale_um);
  write_map(folder, result.design_map, "design", fmt::format("{}, against the stock", words), scale_um);
  ReportData page = compare_page(pair, input, result, scale_um);
  page.hero_png = folder.file("deviation.png");
  page.hero_caption = "The stock, coloured by its deviation.";
  page.stills = {
      {folder.file("design.png"), fmt::format("{}, coloured by what the stock leaves of it.",
                                              pair.revisions ? "The earlier stock" : "The design")}};
  add_place_pictures(folder, result, scale_um, page);
  write_report(folder.file("report.html"), page);
  write_text(folder.file("metrics.json"), metrics);
  folder.move_into_place();
}

}  // namespace swarf::reports
