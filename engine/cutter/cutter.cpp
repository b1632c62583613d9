#include "cutter/cutter.h"

#include <fmt/format.h>

#include <cmath>

namespace swarf::cutter {

std::vector<std::string> validate(const Cutter& c) {
  std::vector<std::string> problems;
  const auto positive = [&](double value, const char* name) {
    if (!(value > 0.0 && std::isfinite(value))) {
      problems.push_back(fmt::format("{} must be above 0 mm and finite, it is {:g}", name, value));
    }
  };
  positive(c.diameter_mm, "diameter_mm");
  positive(c.flute_length_mm, "flute_length_mm");
  positive(c.shank_diameter_mm, "shank_diameter_mm");
  positive(c.length_mm, "length_mm");
  positive(c.holder_diameter_mm, "holder_diameter_mm");
  positive(c.holder_length_mm, "holder_length_mm");
  if (c.corner_radius_mm != 0.0) {
    problems.push_back(fmt::format(
        "corner_radius_mm is {:g}: this version cuts with flat end mills (corner_radius_mm = 0) only",
        c.corner_radius_mm));
  }
  if (c.flute_length_mm > c.length_mm) {
    problems.push_back(fmt::format("flute_length_mm {:g} is longer than the tool, length_mm {:g}",
                                   c.flute_length_mm, c.length_mm));
  }
  return problems;
}

}  // namespace swarf::cutter
