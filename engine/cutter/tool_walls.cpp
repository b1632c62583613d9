#include "cutter/tool_walls.h"

namespace swarf::cutter {

std::vector<ToolWall> tool_walls(const Cutter& c) {
  std::vector<ToolWall> walls;
  const double neck_end = c.flute_length_mm + c.neck_length_mm;
  const auto cylinder = [&](const char* part, double low, double high, double diameter) {
    if (low < high) walls.push_back({part, low, high, 0.5 * diameter, 0.5 * diameter});
  };
  cylinder("neck", c.flute_length_mm, neck_end, c.neck_diameter_mm);
  cylinder("shank", neck_end, c.length_mm, c.shank_diameter_mm);
  double low = c.length_mm;
  for (const ToolSection& s : c.holder) {
    walls.push_back({"holder", low, low + s.length_mm, 0.5 * s.diameter_mm, 0.5 * s.top_diameter_mm});
    low += s.length_mm;
  }
  return walls;
}

}  // namespace swarf::cutter
