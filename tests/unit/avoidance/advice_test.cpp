// Advice for the CAM system where only the path can help: each answer is known in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "avoidance/advice.h"
#include "base/units.h"
#include "support/program_run.h"

namespace {

using namespace swarf;
using avoidance::Advice;

Advice advice_for(const std::string& row, const std::vector<std::string>& keys = {}) {
  const std::string file = SWARF_SOURCE_DIR "/scenes/kruth_table1/" + row + ".toml";
  const auto load = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = keys;
    all.insert(all.end(), more.begin(), more.end());
    return sim::load_job(file, all);
  };
  const sim::Job job = load({});
  const avoidance::Task task{&job, load};
  Progress silent;
  return avoidance::advise(task, avoidance::control(task, silent), silent);
}

/// B would go to 110 and ends at 100: ten degrees less, at each of the four positions.
TEST(Advice, ARotaryLimitTakesItsExcess) {
  const Advice advice = advice_for("row_13_rotary_limit");
  ASSERT_TRUE(advice.free) << (advice.left ? advice.left->text : "");
  ASSERT_EQ(advice.blocks.size(), 4U);
  for (const avoidance::BlockChange& block : advice.blocks) {
    SCOPED_TRACE(block.line);
    EXPECT_NEAR(std::abs(deg_from_rad(block.change.tilt_rad)), 10.0, 2.0 * Advice::kResolutionDeg);
    EXPECT_GE(std::abs(deg_from_rad(block.change.tilt_rad)), 10.0 - 1e-6);
    EXPECT_EQ(block.change.lead_rad, 0.0);
    EXPECT_EQ(block.change.lift_mm, 0.0);
    EXPECT_NE(block.frees.find("axis B"), std::string::npos) << block.frees;
  }
}

/// The holder's rim beside the wall: R cos(psi) - L sin(psi) = d, psi counted from the wall's face.
TEST(Advice, ATiltJustClearsALeaningWall) {
  const double R = 20.0, L = 25.0, d = 10.0, wall = 10.0;
  const double psi = std::acos(d / std::hypot(R, L)) - std::atan2(L, R);
  const double expected = deg_from_rad(psi) - wall;
  const Advice advice = advice_for("path_1_holder_wall");
  ASSERT_TRUE(advice.free) << (advice.left ? advice.left->text : "");
  // The cut's two positions; the rapid behind them leaves the wall upright, and may take a change of its own.
  ASSERT_GE(advice.blocks.size(), 2U);
  for (size_t i = 0; i < 2; ++i) {
    const avoidance::BlockChange& block = advice.blocks[i];
    const double tilt = deg_from_rad(block.change.tilt_rad);  // to the left of +Y, away from the wall
    EXPECT_GE(tilt, expected - 1e-4) << block.line;
    EXPECT_LE(tilt, expected + 2.0 * Advice::kResolutionDeg) << block.line;
    EXPECT_NE(block.frees.find("wall"), std::string::npos) << block.frees;
  }
}

/// The same wall, and a block on the other side, 120 high at x = -W: the holder's side comes to its edge at W
/// = 75 tan(t) + 20 / cos(t). What is free lies between the two, and small angles and large ones are blocked.
/// The cut alone, without the rapid behind it, which takes a change of its own.
TEST(Advice, ATiltIsFoundBetweenAWallAndABlock) {
  std::string cl = test::read_text(SWARF_SOURCE_DIR "/scenes/kruth_table1/path_1_holder_wall.cl");
  cl.erase(cl.rfind("RAPID\n"), cl.rfind("SPINDL/OFF") - cl.rfind("RAPID\n"));
  const std::filesystem::path file = test::fresh_folder("advice_between") / "cut.cl";
  test::write_text(file, cl);
  const double psi = std::acos(10.0 / std::hypot(20.0, 25.0)) - std::atan2(25.0, 20.0);
  const double least = deg_from_rad(psi) - 10.0;
  const double t = rad_from_deg(least + 0.3), W = 75.0 * std::tan(t) + 20.0 / std::cos(t);
  const std::string block =
      "{name = \"block\", box_mm = [[-120, -60, 0], [" + std::to_string(-W) + ", 60, 120]]}";
  const Advice advice = advice_for(
      "path_1_holder_wall", {"cl=\"" + file.string() + "\"", "stock.box_mm=[[-30, -25, 0], [0, 25, 42]]",
                             "fixture=[{name = \"wall\", mesh = \"path_1_wall.stl\"}, " + block + "]"});
  ASSERT_TRUE(advice.free) << (advice.left ? advice.left->text : "");
  ASSERT_EQ(advice.blocks.size(), 2U);
  for (const avoidance::BlockChange& one : advice.blocks) {
    const double tilt = deg_from_rad(one.change.tilt_rad);
    EXPECT_GE(tilt, least - 1e-4) << one.line;
    EXPECT_LE(tilt, least + 2.0 * Advice::kResolutionDeg) << one.line;
  }
  std::filesystem::remove_all(file.parent_path());
}

/// The way from x = -50, z = 38 to x = 10 passes over a stop 45 high from x = 10 on by the edge of R 5: its
/// end is lifted by 7 mm at 55 of 60.
TEST(Advice, AStopIsPassedOver) {
  const Advice advice = advice_for("row_08_cutter_fixture");
  ASSERT_TRUE(advice.free) << (advice.left ? advice.left->text : "");
  ASSERT_EQ(advice.blocks.size(), 1U);
  EXPECT_GE(advice.blocks.front().change.lift_mm, 7.0 * 60.0 / 55.0);
  EXPECT_LE(advice.blocks.front().change.lift_mm, 7.0 * 60.0 / 55.0 + 2.0 * Advice::kLiftResolutionMm);
}

/// Half a millimetre into the plane, of which 10 um are allowed: no lean helps a tip that is too deep.
TEST(Advice, AGougeOfTheTipIsLifted) {
  const Advice advice = advice_for("row_07_cutter_finished_part");
  ASSERT_TRUE(advice.free) << (advice.left ? advice.left->text : "");
  ASSERT_EQ(advice.blocks.size(), 2U);
  for (const avoidance::BlockChange& block : advice.blocks) {
    EXPECT_GE(block.change.lift_mm, 0.49 - 1e-5) << block.line;
    EXPECT_LE(block.change.lift_mm, 0.49 + 2e-4 + 2.0 * Advice::kLiftResolutionMm)
        << block.line;  // margin of the proof
    EXPECT_EQ(block.change.lead_rad, 0.0);
    EXPECT_EQ(block.change.tilt_rad, 0.0);
  }
}

/// What is free already is left alone, to the last byte.
TEST(Advice, AFreeProgramIsLeftAlone) {
  const Advice advice = advice_for("row_05_holder_fixture");
  ASSERT_TRUE(advice.free);
  EXPECT_TRUE(advice.blocks.empty());
  EXPECT_EQ(advice.looks, 1U);
}

}  // namespace
