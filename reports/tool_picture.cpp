#include "reports/tool_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "cutter/profile.h"
#include "cutter/tool_walls.h"
#include "reports/html.h"

namespace swarf::reports {
namespace {

constexpr double kFinest = 0.1;  // px: no corner of a drawn arc is seen

struct OutlinePart {
  const char* css_class;
  std::vector<Vec2> side;  ///< (rho, z), upwards
};

std::vector<OutlinePart> outline_parts(const cutter::Cutter& tool, double px_per_mm) {
  std::vector<OutlinePart> parts{
      {"tool-flutes", cutter::sample_outline(cutter::outline(tool), kFinest / px_per_mm)}};
  OutlinePart shank{"tool-shank", {}};
  for (const cutter::ToolWall& wall : cutter::tool_walls(tool)) {
    if (wall.low >= tool.length_mm) break;
    shank.side.emplace_back(wall.low_radius, wall.low);
    shank.side.emplace_back(wall.high_radius, wall.high);
  }
  if (!shank.side.empty()) parts.push_back(shank);
  OutlinePart holder{"tool-holder", {}};
  double z = tool.length_mm;
  for (const cutter::ToolSection& section : tool.holder) {
    holder.side.emplace_back(0.5 * section.diameter_mm, z);
    z += section.length_mm;
    holder.side.emplace_back(0.5 * section.top_diameter_mm, z);
  }
  parts.push_back(holder);
  return parts;
}

}  // namespace

std::string tool_svg(const cutter::Cutter& tool) {
  double top = tool.length_mm, radius = tool.radius();
  for (const cutter::ToolSection& section : tool.holder) {
    top += section.length_mm;
    radius = std::max({radius, 0.5 * section.diameter_mm, 0.5 * section.top_diameter_mm});
  }
  const double scale = kToolPictureHeight / top,
               middle = scale * std::max(radius, 0.5 * tool.shank_diameter_mm);
  std::string paths;
  for (const OutlinePart& part : outline_parts(tool, scale)) {
    std::string right, left;
    for (const Vec2& p : part.side) {
      const double y = kToolPictureHeight - scale * p.y();
      right += fmt::format("{}{:.2f} {:.2f}", right.empty() ? "M" : "L", middle + scale * p.x(), y);
      left.insert(0, fmt::format("L{:.2f} {:.2f}", middle - scale * p.x(), y));
    }
    paths += fmt::format(R"(<path class="{}" d="{}{}Z"/>)", part.css_class, right, left);
  }
  return fmt::format(R"(<svg class="tool" role="img" aria-label="{}" width="{:.0f}" height="{:.0f}" )"
                     R"(viewBox="0 0 {:.2f} {:.0f}">{}</svg>)",
                     escape(cutter::call_name(tool)), 2.0 * middle, kToolPictureHeight, 2.0 * middle,
                     kToolPictureHeight, paths);
}

}  // namespace swarf::reports
