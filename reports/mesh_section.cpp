#include "reports/mesh_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "render/lettering.h"

namespace swarf::reports {
namespace {

constexpr double kSectionWidth = 640.0;  // px
constexpr double kBarShare = 0.3;        // of the width: the bar is no longer

std::string length_text(double mm) {
  return mm < 0.1 ? fmt::format("{:g} µm", 1e3 * mm) : fmt::format("{:g} mm", mm);
}

/// Where the sides of the triangle go through the plane.
std::optional<std::array<Vec3, 2>> cut_triangle(const std::array<Vec3, 3>& corner, const Vec3& point,
                                                const Vec3& normal) {
  std::array<double, 3> height{};
  for (size_t i = 0; i < 3; ++i) height[i] = normal.dot(corner[i] - point);
  std::array<Vec3, 2> ends;
  size_t found = 0;
  for (size_t i = 0; i < 3 && found < 2; ++i) {
    const size_t next = (i + 1) % 3;
    if ((height[i] < 0.0) == (height[next] < 0.0)) continue;
    ends[found++] = corner[i] + (corner[next] - corner[i]) * (height[i] / (height[i] - height[next]));
  }
  if (found < 2) return {};
  return ends;
}

}  // namespace

std::vector<std::array<Vec3, 2>> section_pieces(const TriMesh& mesh, const Vec3& point, const Vec3& normal) {
  std::vector<std::array<Vec3, 2>> pieces;
  for (const auto& t : mesh.triangles) {
    std::array<Vec3, 3> corner;
    for (size_t i = 0; i < 3; ++i) {
      const auto& p = mesh.positions[t[i]];
      corner[i] = Vec3(p[0], p[1], p[2]);
    }
    if (const auto ends = cut_triangle(corner, point, normal)) pieces.push_back(*ends);
  }
  return pieces;
}

namespace {

std::string lines_in_plane(const TriMesh& mesh, const SectionPlane& plane, double scale) {
  const Vec3 normal = plane.right.cross(plane.up);
  const double reach = std::hypot(plane.half_width_mm, plane.half_height_mm);
  std::string path;
  for (const std::array<Vec3, 2>& ends : section_pieces(mesh, plane.centre, normal)) {
    std::array<double, 4> at{};
    double nearest = INFINITY;
    for (size_t i = 0; i < 2; ++i) {
      const Vec3 from = ends[i] - plane.centre;
      at[2 * i] = scale * (from.dot(plane.right) + plane.half_width_mm);
      at[2 * i + 1] = scale * (plane.half_height_mm - from.dot(plane.up));
      nearest = std::min(nearest, from.norm());
    }
    if (nearest > reach + (ends[1] - ends[0]).norm()) continue;  // outside of the window
    path += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", at[0], at[1], at[2], at[3]);
  }
  return path;
}

}  // namespace

std::string section_svg(const std::vector<SectionMesh>& meshes, const SectionPlane& plane) {
  const double scale = 0.5 * kSectionWidth / plane.half_width_mm;
  const double height = 2.0 * scale * plane.half_height_mm;
  std::string out =
      fmt::format(R"(<svg class="section" viewBox="0 0 {:.0f} {:.0f}" role="img">)", kSectionWidth, height);
  for (const SectionMesh& one : meshes)
    out +=
        fmt::format(R"(<path class="{}" d="{}"/>)", one.css_class, lines_in_plane(*one.mesh, plane, scale));
  out += fmt::format(R"(<circle class="place" cx="{:.1f}" cy="{:.1f}" r="9"/>)", 0.5 * kSectionWidth,
                     0.5 * height);
  const double bar = render::round_length(2.0 * kBarShare * plane.half_width_mm);
  out += fmt::format(
      R"(<path class="scale-bar" d="M12 {0:.1f}v8h{1:.1f}v-8"/><text x="18" y="{2:.1f}">{3}</text></svg>)",
      height - 20.0, scale * bar, height - 20.0, length_text(bar));
  return out;
}

}  // namespace swarf::reports
