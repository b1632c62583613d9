// Neck, shank and holder stand on each other without gaps.
#include "cutter/tool_walls.h"

#include <gtest/gtest.h>

#include <string>

namespace swarf::cutter {
namespace {

TEST(ToolWalls, StackFromTheFlutesUpwards) {
  Cutter c;
  c.neck_diameter_mm = 8.0;
  c.neck_length_mm = 15.0;
  c.shank_diameter_mm = 12.0;
  c.holder = {{20, 30, 10}, {40, 40, 50}};
  const std::vector<ToolWall> walls = tool_walls(c);
  ASSERT_EQ(walls.size(), 4U);
  const char* names[] = {"neck", "shank", "holder", "holder"};
  const double heights[] = {25, 40, 60, 70, 120}, low[] = {4, 6, 10, 20}, high[] = {4, 6, 15, 20};
  for (size_t i = 0; i < walls.size(); ++i) {
    EXPECT_EQ(std::string(walls[i].part), names[i]);
    EXPECT_EQ(walls[i].low, heights[i]);
    EXPECT_EQ(walls[i].high, heights[i + 1]);
    EXPECT_EQ(walls[i].low_radius, low[i]);
    EXPECT_EQ(walls[i].high_radius, high[i]);
  }
}

TEST(ToolWalls, LeaveOutWhatHasNoLength) {
  Cutter c;
  c.flute_length_mm = c.length_mm;
  ASSERT_EQ(tool_walls(c).size(), 1U);
  EXPECT_EQ(std::string(tool_walls(c)[0].part), "holder");
}

}  // namespace
}  // namespace swarf::cutter
