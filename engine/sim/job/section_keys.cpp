#include "sim/job/section_keys.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace swarf::sim {
namespace {

constexpr std::string_view kAxes = "xyz";
/// Whose half is taken away by "x=..", "y=..", "z=..": that before the views right, front and top.
constexpr std::array<double, 3> kBefore{1.0, -1.0, 1.0};

std::optional<SectionPlane> plane_of(const Vec3& point, const Vec3& normal) {
  if (!point.allFinite() || !normal.allFinite() || !(normal.norm() > 0.0)) return {};
  return SectionPlane{point, normal.normalized()};
}

/// "x=12.5"
std::optional<SectionPlane> across_axis(const std::string& text) {
  const size_t axis = text.size() > 2 && text[1] == '=' ? kAxes.find(text[0]) : kAxes.npos;
  if (axis == kAxes.npos) return {};
  char* end = nullptr;
  const double place = std::strtod(text.c_str() + 2, &end);
  if (end == text.c_str() + 2 || *end != '\0') return {};
  const auto k = static_cast<Eigen::Index>(axis);
  return plane_of(place * Vec3::Unit(k), kBefore[axis] * Vec3::Unit(k));
}

/// The axis that the normal lies along; none: it is oblique.
std::optional<Eigen::Index> axis_of(const SectionPlane& plane) {
  for (Eigen::Index k = 0; k < 3; ++k)
    if (std::abs(plane.normal_W[k]) == 1.0) return k;
  return {};
}

}  // namespace

std::optional<SectionPlane> section_named(const std::string& text) {
  if (const auto plane = across_axis(text)) return plane;
  Vec3 p, n;
  char more = 0;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf%c", &p.x(), &p.y(), &p.z(), &n.x(), &n.y(), &n.z(),
                  &more) == 6)
    return plane_of(p, n);
  return {};
}

std::string section_forms() {
  return "x=12.5, y=12.5 or z=12.5 (mm), or six numbers x,y,z,nx,ny,nz: a point of the plane and its normal";
}

std::optional<SectionPlane> read_section(ConfigTable& table) {
  if (table.has("section")) {
    const std::string words = table.text("section");
    const auto plane = section_named(words);
    if (!plane && !words.empty())
      table.error("bad-section", "section", fmt::format("'{}' is no plane", words),
                  "write " + section_forms());
    if (table.has("section_mm"))
      table.error("two-sections", "section_mm", "there are 'section' and 'section_mm'", "keep one of both");
    return plane;
  }
  if (!table.has("section_mm")) return {};
  const std::vector<Vec3> rows = table.points("section_mm");
  const auto plane = rows.size() == 2 ? plane_of(rows[0], rows[1]) : std::nullopt;
  if (!plane && !rows.empty())
    table.error("bad-section", "section_mm", "'section_mm' is no plane",
                "write [[x, y, z], [nx, ny, nz]]: a point of the plane, and where it points to is cut away");
  return plane;
}

std::string section_words(const SectionPlane& plane) {
  if (const auto k = axis_of(plane))
    return fmt::format("{} = {:g} mm", kAxes[static_cast<size_t>(*k)], plane.point_W[*k]);
  const Vec3 &p = plane.point_W, &n = plane.normal_W;
  return fmt::format("plane through {:g}, {:g}, {:g} mm, normal {:.3g}, {:.3g}, {:.3g}", p.x(), p.y(), p.z(),
                     n.x(), n.y(), n.z());
}

namespace {

/// Least and greatest height of the box above the plane.
std::pair<double, double> heights(const SectionPlane& plane, const Box& box) {
  const double middle = plane.normal_W.dot(box.centre() - plane.point_W);
  const double half = 0.5 * plane.normal_W.cwiseAbs().dot(box.size());
  return {middle - half, middle + half};
}

}  // namespace

bool divides(const SectionPlane& plane, const Box& box) {
  const auto [least, most] = heights(plane, box);
  return least < 0.0 && most > 0.0;
}

std::string extent_along(const SectionPlane& plane, const Box& box) {
  if (const auto k = axis_of(plane))
    return fmt::format("{} from {:g} to {:g} mm", kAxes[static_cast<size_t>(*k)], box.lower[*k],
                       box.upper[*k]);
  const auto [least, most] = heights(plane, box);
  return fmt::format("from {:g} to {:g} mm along the normal, counted from the plane", least, most);
}

void require_section(const SectionPlane& plane, const SourceLocation& where, const Box& stock_W) {
  if (divides(plane, stock_W)) return;
  throw InputError("section-misses", where,
                   fmt::format("the section {} misses the stock", section_words(plane)),
                   fmt::format("the stock reaches {}", extent_along(plane, stock_W)));
}

}  // namespace swarf::sim
