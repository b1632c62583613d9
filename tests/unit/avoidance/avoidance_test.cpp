// CONTROL against the paper's tables, and its clamping search against the exhaustive one.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "avoidance/control.h"

namespace {

using namespace swarf;
using avoidance::Part;
using avoidance::Remedy;

const std::vector<Remedy> kA{Remedy::kMoveClamping}, kB{Remedy::kExtendTool},
    kAB{Remedy::kMoveClamping, Remedy::kExtendTool}, kNone;

/// Table 1 of Kruth et al., row by row; C and D are the user's.
TEST(Remedies, AreThoseOfTable1) {
  const std::vector<std::tuple<Part, Part, std::vector<Remedy>>> rows{
      {Part::kHead, Part::kWork, kB},         {Part::kHead, Part::kFixture, kB},
      {Part::kHead, Part::kTable, kAB},       {Part::kHead, Part::kStructure, kAB},
      {Part::kHolder, Part::kWork, kB},       {Part::kHolder, Part::kFixture, kB},
      {Part::kHolder, Part::kTable, kAB},     {Part::kCutter, Part::kWork, kNone},
      {Part::kCutter, Part::kFixture, kNone}, {Part::kCutter, Part::kTable, kA},
      {Part::kWork, Part::kTable, kA},        {Part::kWork, Part::kStructure, kA},
      {Part::kWork, Part::kArm, kA},          {Part::kHead, Part::kArm, kAB},
      {Part::kHolder, Part::kArm, kAB},       {Part::kCutter, Part::kArm, kA}};
  for (const auto& [a, b, expected] : rows) {
    SCOPED_TRACE(std::string(avoidance::part_name(a)) + " - " + avoidance::part_name(b));
    EXPECT_EQ(avoidance::remedies_of(a, b), expected);
    EXPECT_EQ(avoidance::remedies_of(b, a), expected);
  }
  EXPECT_EQ(avoidance::remedies_of_limit(true),
            (std::vector<Remedy>{Remedy::kMoveClamping, Remedy::kShortenTool}));
  EXPECT_TRUE(avoidance::remedies_of_limit(false).empty());
}

/// A case of scenes/kruth_table1 with other keys.
avoidance::Outcome outcome_of(const std::string& row, const std::vector<std::string>& keys) {
  const std::string file = SWARF_SOURCE_DIR "/scenes/kruth_table1/" + row + ".toml";
  const auto load = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = keys;
    all.insert(all.end(), more.begin(), more.end());
    return sim::load_job(file, all);
  };
  const sim::Job job = load({});
  Progress silent;
  return avoidance::control({&job, load}, silent);
}

/// Each position of the grid by itself. SWARF_WHOLE_GRID: of 9 x 9 x 3 positions, which takes minutes.
TEST(ClampingSearch, FindsTheOptimumOfTheExhaustiveOne) {
  const bool whole = std::getenv("SWARF_WHOLE_GRID") != nullptr;
  const std::vector<std::string> grid =
      whole ? std::vector<std::string>{"post.clamping.step_mm=[8.0, 8.0, 10.0]",
                                       "post.clamping.count=[9, 9, 3]"}
            : std::vector<std::string>{"post.clamping.step_mm=[12.0, 12.0, 10.0]",
                                       "post.clamping.count=[3, 5, 1]"};
  const auto found = outcome_of("table2_3_holder_arm", grid);
  ASSERT_TRUE(found.found);
  double best = std::numeric_limits<double>::infinity();
  size_t dropped = 0;
  for (const avoidance::Position& position : found.positions) {
    if (position.state == avoidance::PositionState::kNoFullTurn) {
      ++dropped;
      continue;
    }
    const Vec3& at = position.origin_M;
    const auto alone = outcome_of(
        "table2_3_holder_arm",
        {"post.clamping.count=[1, 1, 1]", "setup.work_origin_mm=[" + std::to_string(at.x()) + ", " +
                                              std::to_string(at.y()) + ", " + std::to_string(at.z()) + "]"});
    if (!alone.found) continue;
    EXPECT_GE(alone.positions.front().slides_mm, position.bound_mm - 1e-6) << at.transpose();
    best = std::min(best, alone.positions.front().slides_mm);
  }
  EXPECT_NEAR(found.positions[found.best].slides_mm, best, 1e-6);
  EXPECT_LT(found.simulations, found.positions.size()) << dropped << " without a full turn";
  if (whole)
    std::printf("%d simulations of %zu positions, %zu without a full turn; %.6f mm, exhaustive %.6f mm\n",
                static_cast<int>(found.simulations), found.positions.size(), dropped,
                found.positions[found.best].slides_mm, best);
}

TEST(ClampingSearch, NeedsFewSimulations) {
  const auto found = outcome_of("table2_3_holder_arm",
                                {"post.clamping.step_mm=[8.0, 8.0, 10.0]", "post.clamping.count=[9, 9, 3]"});
  ASSERT_TRUE(found.found);
  EXPECT_EQ(found.positions.size(), 243U);
  EXPECT_LE(found.simulations, 48U);  // a fifth of them
}

/// The quickest of all ways is no slower than the paper's backtracking, which is no slower than itself.
TEST(Routes, DynamicProgrammingIsNoSlower) {
  const auto found = outcome_of("table2_2_head_arm", {});
  ASSERT_TRUE(found.found);
  EXPECT_GT(found.best_time_s, 0.0);
  EXPECT_LE(found.best_time_s, found.backtrack_time_s + 1e-9);
  EXPECT_EQ(found.routes_dropped, 0);
}

TEST(Control, TellsTheLeastBadPositionWhereNothingHelps) {
  const auto outcome = outcome_of("row_13_rotary_limit", {});
  EXPECT_FALSE(outcome.found);
  for (const avoidance::Position& position : outcome.positions)
    EXPECT_EQ(position.state, avoidance::PositionState::kOffTravel) << position.why;
  const sim::Job job = sim::load_job(SWARF_SOURCE_DIR "/scenes/kruth_table1/row_13_rotary_limit.toml", {});
  const Diagnostics told = avoidance::diagnostics_of(outcome, job);
  ASSERT_TRUE(told.has_errors());
  EXPECT_EQ(told.list().front().code, "no-free-program");
  EXPECT_NE(told.list().front().text.find("axis B"), std::string::npos) << told.list().front().text;
  EXPECT_EQ(told.list().size(), 1 + outcome.positions.size());
}

}  // namespace
