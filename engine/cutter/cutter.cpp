#include "cutter/cutter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/units.h"
#include "cutter/profile.h"

namespace swarf::cutter {
namespace {

constexpr std::array<const char*, 9> kNames{"flat",    "ball",     "bull_nose", "taper",  "drill",
                                            "chamfer", "woodruff", "apt",       "profile"};

/// What the shape adds to diameter and corner radius.
std::string extra(const Cutter& c) {
  switch (c.shape) {
    case Shape::kTaper:
      return fmt::format(", {:g}° a side", deg_from_rad(c.taper_rad));
    case Shape::kDrill:
      return fmt::format(", point {:g}°", deg_from_rad(c.point_angle_rad));
    case Shape::kChamfer:
      return fmt::format(", point {:g}°, tip D {:g} mm", deg_from_rad(c.point_angle_rad), c.tip_diameter_mm);
    case Shape::kApt:
      return fmt::format(", alpha {:g}°, beta {:g}°", deg_from_rad(c.alpha_rad), deg_from_rad(c.beta_rad));
    case Shape::kProfile:
      return fmt::format(", {} corners", c.profile.size());
    default:
      return "";
  }
}

}  // namespace

const char* shape_name(Shape shape) {
  return kNames.at(static_cast<size_t>(shape));
}

std::vector<std::string> shape_names() {
  return {kNames.begin(), kNames.end()};
}

double gauge_length(const Cutter& cutter) {
  if (cutter.gauge_length_mm) return *cutter.gauge_length_mm;
  double length = cutter.length_mm;
  for (const ToolSection& section : cutter.holder) length += section.length_mm;
  return length;
}

std::string call_name(const Cutter& cutter) {
  if (cutter.number == 0) return cutter.name.empty() ? "the tool" : cutter.name;
  return cutter.name.empty() ? fmt::format("T{}", cutter.number)
                             : fmt::format("T{} ({})", cutter.number, cutter.name);
}

std::string describe(const Cutter& c) {
  const std::string corner =
      c.corner_radius_mm > 0.0 ? fmt::format(", corner radius {:g} mm", c.corner_radius_mm) : "";
  std::string shape = shape_name(c.shape);
  std::replace(shape.begin(), shape.end(), '_', ' ');
  return fmt::format("{}, D {:g} mm{}{}, flutes {:g} mm, length {:g} mm", shape, c.diameter_mm, corner,
                     extra(c), c.flute_length_mm, c.length_mm);
}

}  // namespace swarf::cutter
