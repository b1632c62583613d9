#include "reports/compare_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mesh/mesh_io.h"
#include "mesh/mesh_ops.h"
#include "render/camera.h"
#include "render/figures/colour.h"
#include "render/image_io.h"
#include "render/lettering.h"
#include "render/ray/still.h"
#include "reports/pending_folder.h"
#include "reports/pictures.h"

namespace swarf::reports {
namespace {

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
  render::Image image = deviation_picture(map, scale_um, "iso", {});
  render::draw_caption(image, caption_of(map, title, scale_um));
  render::save_png(image, folder.file(name + ".png"));
}

}  // namespace

void write_compare(const std::string& target, TriMesh stock, TriMesh design, double scale_um,
                   const std::string& metrics) {
  PendingFolder folder(target);
  write_map(folder, std::move(stock), "deviation", "the stock, against the design", scale_um);
  write_map(folder, std::move(design), "design", "the design, against the stock", scale_um);
  write_text(folder.file("metrics.json"), metrics);
  folder.move_into_place();
}

}  // namespace swarf::reports
