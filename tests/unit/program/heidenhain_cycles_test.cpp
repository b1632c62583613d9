// Drilling cycles of Heidenhain programs: the sequence of depths, feeds and dwells.
#include "unit/program/heidenhain_support.h"

namespace swarf::program::heidenhain_cycles_test {
namespace {

const char* const kAbove = "TOOL CALL 1 Z S1000 F200\nL X+0 Y+0 Z+50 R0 FMAX M3\n";

std::string cycle_200(const std::string& q202, const std::string& more = "") {
  return "CYCL DEF 200 DRILLING ~\n  Q200=2 ;SET-UP CLEARANCE ~\n  Q201=-12 ;DEPTH ~\n  Q206=+150 ~\n  "
         "Q202=" +
         q202 + " ~\n  Q203=+3 ;SURFACE" + more + "\n";
}

TEST(HeidenhainCycles, PeckDrillingReturnsToTheSetUpClearance) {
  const NcRun run = klartext_clean(kAbove + cycle_200("5", " ~\n Q210=0.5 ~\n Q204=20 ~\n Q211=0.25") +
                                   "L X+10 Y+20 FMAX M99\n");
  // Surface 3: set-up clearance 5, depths -2, -7, -9; down again to 2 above the last depth.
  expect_heights(run, {50, 50, 5, -2, 5, 0, -7, 5, -5, -9, 5, 23});
  const std::vector<bool> feeds{false, false, false, true, false, false,
                                true,  false, false, true, false, false};
  for (size_t i = 0; i < feeds.size(); ++i) EXPECT_EQ(run.moves()[i].rapid, !feeds[i]) << i;
  EXPECT_NEAR(run.moves()[3].duration_s, 7.0 / 2.5, 1e-12);
  EXPECT_NEAR(run.moves()[5].dwell_s, 0.5, 1e-12);
  EXPECT_NEAR(run.moves()[10].dwell_s, 0.25, 1e-12);
  expect_tip(run.moves().back(), 10, 20, 23);
}

TEST(HeidenhainCycles, CallsBlockByBlockAndModal) {
  const NcRun run =
      klartext_clean(kAbove + cycle_200("12") +
                     "CYCL CALL\nCYCL CALL POS X+1 Y+1 FMAX M3\nL X+5 FMAX M89\nL Y+7 FMAX\nL X+9 FMAX "
                     "M99\nL X+20 FMAX\n");
  std::vector<std::pair<double, double>> holes;
  for (const NcMove& move : run.moves()) {
    if (!move.rapid) holes.emplace_back(move.to.tip_W.x(), move.to.tip_W.y());
  }
  EXPECT_EQ(holes, (std::vector<std::pair<double, double>>{{0, 0}, {1, 1}, {5, 1}, {5, 7}, {9, 7}}));
}

TEST(HeidenhainCycles, UniversalDrillingBreaksChipsAndShortensPecks) {
  const std::string cycle =
      "CYCL DEF 203 UNIVERSAL DRILLING Q200=2 Q201=-12 Q206=150 Q202=5 Q210=0 Q203=0 Q204=10 Q212=2 Q213=1 "
      "Q205=2 "
      "Q211=0 Q208=";
  const NcRun run = klartext_clean(kAbove + cycle + "0 Q256=0.5\nCYCL CALL\n");
  // Pecks 5, 3, 2, 2: a chip break, a retreat, a chip break, the depth.
  expect_heights(run, {50, 2, -5, -4.5, -8, 2, -6, -10, -9.5, -12, 2, 10});
  EXPECT_FALSE(run.moves()[5].rapid);  // Q208=0: out at Q206
  EXPECT_NEAR(run.moves()[5].duration_s, 10.0 / 2.5, 1e-12);
  const NcRun rapid = klartext_clean(kAbove + cycle + "MAX Q256=0.5\nCYCL CALL\n");
  EXPECT_TRUE(rapid.moves()[5].rapid);
  const NcRun other = klartext_clean(kAbove + cycle + "600 Q256=0.5\nCYCL CALL\n");
  EXPECT_NEAR(other.moves()[5].duration_s, 10.0 / 10.0, 1e-12);
}

TEST(HeidenhainCycles, DeepHoleDrillingBreaksChipsWithinAPeck) {
  const NcRun run =
      klartext_clean(std::string(kAbove) +
                     "CYCL DEF 205 UNIVERSAL PECKING ~\n Q200=2 ~\n Q201=-10 ~\n Q206=FAUTO ~\n Q202=6 ~\n "
                     "Q203=+0 ~\n Q204=5 ~\n Q212=0 ~\n Q205=0 ~\n Q258=0.5 ~\n Q259=0.5 ~\n Q257=2.5 ~\n "
                     "Q256=0.4 ~\n Q211=0 ~\n Q379=0 ~\n Q253=750\nCYCL CALL M3\n");
  expect_heights(run, {50, 2, -2.5, -2.1, -5, -4.6, -6, 2, -5.5, -8.5, -8.1, -10, 2, 5});
  EXPECT_NEAR(run.moves()[2].feed_mm_s, 200.0 / 60.0, 1e-12);
}

TEST(HeidenhainCycles, ReamingAndTapping) {
  const NcRun ream = klartext_clean(
      std::string(kAbove) +
      "CYCL DEF 201 REAMING Q200=2 Q201=-10 Q206=100 Q211=0.5 Q208=0 Q203=0 Q204=9\nCYCL CALL\n");
  expect_heights(ream, {50, 2, -10, 2, 9});
  EXPECT_FALSE(ream.moves()[3].rapid);
  EXPECT_NEAR(ream.moves()[3].dwell_s, 0.5, 1e-12);
  const NcRun tap =
      klartext_clean(std::string(kAbove) +
                     "CYCL DEF 207 RIGID TAPPING Q200=3 Q201=-8 Q239=+1.25 Q203=0 Q204=9\nCYCL CALL\n");
  expect_heights(tap, {50, 3, -8, 3, 9});
  EXPECT_NEAR(tap.moves()[2].duration_s, 11.0 / (1.25 * 1000.0 / 60.0), 1e-9);
  EXPECT_NEAR(tap.moves()[3].spindle_rpm, -1000.0, 1e-9);
  const NcRun old_tap =
      klartext_clean(std::string(kAbove) +
                     "CYCL DEF 206 TAPPING Q200=3 Q201=-8 Q206=1000 Q211=0 Q203=0 Q204=3\nCYCL CALL\n");
  expect_heights(old_tap, {50, 3, -8, 3});
}

TEST(HeidenhainCycles, OldCyclesStartWhereTheToolStands) {
  const NcRun run = klartext_clean(std::string(kAbove) +
                                   "L Z+2 FMAX\nCYCL DEF 1.0 PECKING\nCYCL DEF 1.1 SET UP 2\nCYCL DEF 1.2 "
                                   "DEPTH -10\nCYCL DEF 1.3 PECKG 6\n"
                                   "CYCL DEF 1.4 DWELL 0.5\nCYCL DEF 1.5 F 150\nCYCL CALL\n");
  expect_heights(run, {50, 2, -6, 2, -5.4, -10, 2});
  EXPECT_NEAR(run.moves().back().dwell_s, 0.5, 1e-12);
}

TEST(HeidenhainCycles, DrillsAlongTheNormalOfATiltedPlane) {
  const NcRun run = klartext_clean("TOOL CALL 2 Z S1000\nPLANE SPATIAL SPA+0 SPB+35 SPC+20 TURN FMAX\n" +
                                       cycle_200("12") + "L X+10 Y+20 Z+50 FMAX M3\nCYCL CALL\nM9\n",
                                   free_five_axis_setup());
  const Mat3 R = (Eigen::AngleAxisd(rad_from_deg(20), Vec3::UnitZ()) *
                  Eigen::AngleAxisd(rad_from_deg(35), Vec3::UnitY()))
                     .toRotationMatrix();
  bool drilled = false;
  for (const NcMove& move : run.moves()) {
    if (move.rapid) continue;
    drilled = true;
    EXPECT_NEAR((move.to.tip_W - R * Vec3(10, 20, -9)).norm(), 0.0, 1e-9);
    EXPECT_NEAR(((move.from.tip_W - move.to.tip_W).normalized() - R.col(2)).norm(), 0.0, 1e-9);
    EXPECT_NEAR((move.to.axis_W - R.col(2)).norm(), 0.0, 1e-9);
  }
  EXPECT_TRUE(drilled);
}

TEST(HeidenhainCycles, DwellOfCycleNine) {
  const NcRun run =
      klartext_clean("L X+1 FMAX\nCYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 1.5\nL X+2 FMAX\n");
  ASSERT_EQ(run.moves().size(), 2u);
  EXPECT_NEAR(run.moves()[1].dwell_s, 1.5, 1e-12);
}

}  // namespace
}  // namespace swarf::program::heidenhain_cycles_test
