// Which cycles the frames of a shot show.
#include "reports/storyboard.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace swarf::reports {
namespace {

using sim::MovieSpeed;

/// Two hours of tool 0, ten seconds of tool 1 between two long rapids, half an hour of tool 2; 1 ms.
std::vector<Stretch> long_program() {
  return {{0, 7200000, 0, 0, true},
          {7200000, 7260000, 1, 1, false},
          {7260000, 7270000, 2, 1, true},
          {7270000, 7900000, 3, 1, false},
          {7900000, 9700000, 4, 2, true}};
}

const Stretch& stretch_at(const std::vector<Stretch>& list, size_t cycle) {
  return *std::find_if(list.begin(), list.end(), [&](const Stretch& s) { return cycle < s.end; });
}

TEST(Storyboard, EveryToolIsSeenAtWorkAndNothingElse) {
  const std::vector<Stretch> program = long_program();
  const std::vector<size_t> frames = spread_frames(program, MovieSpeed::kCutting, 600);
  ASSERT_EQ(frames.size(), 600U);
  EXPECT_TRUE(std::is_sorted(frames.begin(), frames.end()));
  std::map<int, int> by_tool;
  for (const size_t k : frames) {
    ASSERT_TRUE(stretch_at(program, k).cutting) << k;
    ++by_tool[stretch_at(program, k).tool];
  }
  // The least that a tool gets is its even share of kToolShare.
  for (int tool = 0; tool < 3; ++tool) EXPECT_GE(by_tool[tool], 600 * sim::kToolShare / 3 - 1) << tool;
  EXPECT_EQ(frames.back(), 9699999U);
}

TEST(Storyboard, TimeIsEvenAndBlocksAreEven) {
  const std::vector<Stretch> two{{100, 1100, 0, 0, true}, {1100, 1110, 1, 0, true}};
  const std::vector<size_t> time = spread_frames(two, MovieSpeed::kTime, 101);
  EXPECT_EQ(time.front(), 109U);  // the last cycle of the first hundredth
  EXPECT_EQ(time.back(), 1109U);
  for (size_t f = 1; f < time.size(); ++f) EXPECT_EQ(time[f] - time[f - 1], 10U) << f;
  const std::vector<size_t> block = spread_frames(two, MovieSpeed::kBlock, 20);
  EXPECT_EQ(std::count_if(block.begin(), block.end(), [](size_t k) { return k < 1100; }), 10);
}

TEST(Storyboard, NoFramesWhereNothingIsCutAndMoreFramesThanCycles) {
  EXPECT_TRUE(spread_frames({{0, 100, 0, 0, false}}, MovieSpeed::kCutting, 10).empty());
  const std::vector<size_t> frames = spread_frames({{5, 7, 0, 0, true}}, MovieSpeed::kTime, 10);
  ASSERT_EQ(frames.size(), 10U);
  EXPECT_EQ(frames.front(), 5U);
  EXPECT_EQ(frames.back(), 6U);
}

}  // namespace
}  // namespace swarf::reports
