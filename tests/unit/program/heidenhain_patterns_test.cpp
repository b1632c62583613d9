// Point patterns and the cycles that leave the axis of the hole, by hand.
#include <fmt/format.h>

#include "unit/program/heidenhain_support.h"

namespace swarf::program::heidenhain_patterns_test {
namespace {

const char* const kAbove = "TOOL CALL 7 Z S1000 F200\nL X+0 Y+0 Z+50 R0 FMAX M3\n";
const char* const kDrill =
    "CYCL DEF 200 DRILLING ~\n Q200=2 ~\n Q201=-10 ~\n Q206=+150 ~\n Q202=+10 ~\n Q203=+0 ~\n Q204=20\n";

/// Where the feed moves end, in the plane, and their depths.
std::vector<Vec3> holes(const NcRun& run) {
  std::vector<Vec3> bottoms;
  for (const NcMove& move : run.moves()) {
    if (!move.rapid) bottoms.push_back(move.to.tip_W);
  }
  return bottoms;
}

void expect_points(const std::vector<Vec3>& found, const std::vector<Vec3>& expected,
                   const std::string& what) {
  ASSERT_EQ(found.size(), expected.size()) << what;
  for (size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR((found[i] - expected[i]).norm(), 0.0, 1e-9)
        << what << ", point " << i << ": " << found[i].transpose();
  }
}

TEST(HeidenhainPatterns, EachKindByHand) {
  const double s = std::sqrt(0.5);
  struct Case {
    std::string pattern;
    std::vector<Vec3> holes;
  };
  const std::vector<Case> cases{
      {"POS1 (X+25 Y+33.5 Z+0) ~\n POS2 (X-1 Y+2 Z+4)", {{25, 33.5, -10}, {-1, 2, -6}}},
      {"ROW1 (X+10 Y+20 D+8 NUM3 ROT+90 Z+0)", {{10, 20, -10}, {10, 28, -10}, {10, 36, -10}}},
      {"PAT1 (X+1 Y+2 DX+10 DY+5 NUMX2 NUMY2 ROT+0 ROTX+0 ROTY+0 Z+0)",
       {{1, 2, -10}, {11, 2, -10}, {11, 7, -10}, {1, 7, -10}}},
      {"PAT1 (X+0 Y+0 DX+10 DY+5 NUMX2 NUMY2 ROT+45 ROTX-45 ROTY+45 Z+1)",
       {{0, 0, -9}, {10, 0, -9}, {10 - 5, 0, -9}, {-5, 0, -9}}},
      {"FRAME1 (X+0 Y+0 DX+10 DY+5 NUMX3 NUMY3 ROT+0 ROTX+0 ROTY+0 Z+0)",
       {{0, 0, -10},
        {10, 0, -10},
        {20, 0, -10},
        {20, 5, -10},
        {0, 5, -10},
        {0, 10, -10},
        {10, 10, -10},
        {20, 10, -10}}},
      {"CIRC1 (X+25 Y+33 D80 START+45 NUM4 Z+0)",
       {{25 + 40 * s, 33 + 40 * s, -10},
        {25 - 40 * s, 33 + 40 * s, -10},
        {25 - 40 * s, 33 - 40 * s, -10},
        {25 + 40 * s, 33 - 40 * s, -10}}},
      {"PITCHCIRC1 (X+0 Y+0 D20 START+0 STEP-90 NUM2 Z+0)", {{10, 0, -10}, {0, -10, -10}}},
  };
  for (const Case& one : cases) {
    const NcRun run = klartext_clean(std::string(kAbove) + "PATTERN DEF ~\n " + one.pattern + "\n" + kDrill +
                                     "CYCL CALL PAT FMAX M8\n");
    expect_points(holes(run), one.holes, one.pattern);
    // Between the points the tool stays at the height of the call.
    for (const NcMove& move : run.moves()) {
      if ((move.to.tip_W - move.from.tip_W).head<2>().norm() > 1e-9) {
        EXPECT_NEAR(move.to.tip_W.z(), 50.0, 1e-9) << one.pattern;
      }
    }
  }
}

TEST(HeidenhainPatterns, CircleOfCycle220) {
  const std::string circle =
      "CYCL DEF 220 POLAR PATTERN ~\n Q216=+50 ~\n Q217=+60 ~\n Q244=80 ~\n Q245={} ~\n Q246={} ~\n Q247={} "
      "~\n Q241={} ~\n"
      " Q200=3 ~\n Q203=+5 ~\n Q204=30 ~\n Q301={} ~\n Q365=0\n";
  const auto run_of = [&](double from, double to, double step, int number, int high) {
    return klartext_clean(std::string(kAbove) + kDrill +
                          fmt::format(fmt::runtime(circle), from, to, step, number, high));
  };
  const NcRun whole = run_of(0, 360, 0, 4, 1);
  expect_points(holes(whole), {{90, 60, -5}, {50, 100, -5}, {10, 60, -5}, {50, 20, -5}}, "whole circle");
  const NcRun part = run_of(0, 180, 0, 3, 0);
  expect_points(holes(part), {{90, 60, -5}, {50, 100, -5}, {10, 60, -5}}, "half a circle");
  const NcRun steps = run_of(90, 360, -90, 2, 0);
  expect_points(holes(steps), {{50, 100, -5}, {90, 60, -5}}, "by steps");
  // Q301: between the points at the second set-up clearance, or at the first.
  const auto ways = [](const NcRun& run) {
    std::vector<double> heights;
    for (const NcMove& move : run.moves()) {
      if ((move.to.tip_W - move.from.tip_W).head<2>().norm() > 1e-9) heights.push_back(move.to.tip_W.z());
    }
    return heights;
  };
  EXPECT_EQ(ways(whole), (std::vector<double>{35, 35, 35, 35}));
  EXPECT_EQ(ways(part), (std::vector<double>{35, 8, 8}));
  EXPECT_NEAR(part.moves().back().to.tip_W.z(), 35.0, 1e-9);
}

TEST(HeidenhainPatterns, RowsOfCycle221GoToAndFro) {
  const NcRun run =
      klartext_clean(std::string(kAbove) + kDrill +
                     "CYCL DEF 221 CARTESIAN PATTERN Q225=+15 Q226=+10 Q237=+10 Q238=+8 Q242=3 Q243=2 "
                     "Q224=+90 Q200=2 Q203=0 Q204=20 Q301=1\n");
  expect_points(holes(run),
                {{15, 10, -10}, {15, 20, -10}, {15, 30, -10}, {7, 30, -10}, {7, 20, -10}, {7, 10, -10}},
                "221");
}

// 208 with the 6 mm tool in a bore of 10: the centre's path has a radius of 2, 12 mm down in helices of 2.5.
TEST(HeidenhainPatterns, BoreMilling) {
  const NcRun run =
      klartext_clean(std::string(kAbove) +
                     "CYCL DEF 208 BORE MILLING Q200=2 Q201=-10 Q206=600 Q334=2.5 Q203=0 Q204=5 Q335=10 "
                     "Q342=0 Q351=+1\nL X+20 Y+30 FMAX M99\n");
  const Vec3 centre(20, 30, 0);
  double helix = 0.0, lowest = 0.0;
  int whole = 0;
  for (const NcMove& move : run.moves()) {
    lowest = std::min(lowest, move.to.tip_W.z());
    if (!move.arc) continue;
    EXPECT_GT(move.arc->normal_W.z(), 0.0);  // climb milling inside: counter-clockwise
    const double rise = move.to.tip_W.z() - move.from.tip_W.z();
    if (std::abs(rise) > 1e-9) helix += std::sqrt(std::pow(move.duration_s * 10.0, 2) - rise * rise);
    const bool flat_circle = std::abs(rise) < 1e-9 && (move.to.tip_W - move.from.tip_W).norm() < 1e-9;
    if (!flat_circle) continue;
    ++whole;
    EXPECT_NEAR(move.to.tip_W.z(), -10.0, 1e-9);
    EXPECT_NEAR(((move.to.tip_W - centre).head<2>()).norm(), 2.0, 1e-9);
    EXPECT_NEAR(move.duration_s * 10.0, 4.0 * kPi, 1e-9);
  }
  EXPECT_EQ(whole, 1);
  EXPECT_NEAR(helix, 12.0 / 2.5 * 4.0 * kPi, 1e-6);
  EXPECT_NEAR(lowest, -10.0, 1e-12);
  expect_tip(run.moves().back(), 20, 30, 5);
  // A bore as wide as the tool is drilled.
  const NcRun drilled = klartext_clean(
      std::string(kAbove) + "CYCL DEF 208 B Q200=2 Q201=-10 Q206=600 Q334=2.5 Q203=0 Q335=6\nCYCL CALL\n");
  expect_heights(drilled, {50, 2, -10, 2});
}

TEST(HeidenhainPatterns, BoringFreesTheEdge) {
  const NcRun run =
      klartext_clean(std::string(kAbove) +
                     "CYCL DEF 202 BORING Q200=2 Q201=-10 Q206=100 Q211=0.5 Q208=250 Q203=0 Q204=30 "
                     "Q214=3 Q336=0\nCYCL CALL\n");
  ASSERT_EQ(run.moves().size(), 7u);
  expect_tip(run.moves()[2], 0, 0, -10);
  expect_tip(run.moves()[3], 0.2, 0, -10);
  EXPECT_NEAR(run.moves()[3].dwell_s, 0.5, 1e-12);
  EXPECT_EQ(run.moves()[3].spindle_rpm, 0.0);
  expect_tip(run.moves()[4], 0.2, 0, 2);
  EXPECT_NEAR(run.moves()[4].feed_mm_s, 250.0 / 60.0, 1e-12);
  expect_tip(run.moves()[5], 0.2, 0, 30);
  expect_tip(run.moves()[6], 0, 0, 30);
}

// The edge, Q252 = 15 above the tip, cuts from below: material 20 thick, counterbore 5 deep.
TEST(HeidenhainPatterns, BackBoring) {
  const NcRun run =
      klartext_clean(std::string(kAbove) +
                     "CYCL DEF 204 BACK BORING Q200=2 Q249=+5 Q250=20 Q251=3.5 Q252=15 Q253=750 Q254=200 "
                     "Q255=1 Q203=+20 Q204=50 Q214=1 Q336=+0\nCYCL CALL\n");
  const std::vector<Vec3> ends{{0, 0, 50},    {0, 0, 22},    {-3.5, 0, 22}, {-3.5, 0, -17},
                               {0, 0, -17},   {0, 0, -10},   {0, 0, -17},   {-3.5, 0, -17},
                               {-3.5, 0, 22}, {-3.5, 0, 70}, {0, 0, 70}};
  ASSERT_EQ(run.moves().size(), ends.size());
  for (size_t i = 0; i < ends.size(); ++i)
    EXPECT_NEAR((run.moves()[i].to.tip_W - ends[i]).norm(), 0.0, 1e-9) << i;
  EXPECT_EQ(run.moves()[3].spindle_rpm, 0.0);
  EXPECT_NEAR(run.moves()[5].spindle_rpm, 1000.0, 1e-9);
  EXPECT_NEAR(run.moves()[5].feed_mm_s, 200.0 / 60.0, 1e-12);
  EXPECT_NEAR(run.moves()[6].dwell_s, 1.0, 1e-12);
}

TEST(HeidenhainPatterns, CentringAndDeepHoles) {
  const NcRun centring = klartext_clean(
      std::string(kAbove) +
      "CYCL DEF 240 CENTERING Q200=2 Q343=+0 Q201=-3 Q344=-8 Q206=150 Q211=0.2 Q203=+0 Q204=9\nCYCL CALL\n");
  expect_heights(centring, {50, 2, -3, 2, 9});
  EXPECT_TRUE(centring.moves()[3].rapid);
  EXPECT_NEAR(centring.moves()[3].dwell_s, 0.2, 1e-12);
  const NcRun deep =
      klartext_clean(std::string(kAbove) +
                     "CYCL DEF 241 DEEP Q200=2 Q201=-80 Q206=150 Q211=0 Q203=+0 Q204=9 Q379=0 Q253=750 "
                     "Q208=1000 Q426=3 Q427=20 Q428=500 Q429=8 Q430=9 Q435=0\nCYCL CALL\n");
  expect_heights(deep, {50, 2, -80, 2, 9});
  EXPECT_NEAR(deep.moves()[2].spindle_rpm, 500.0, 1e-9);
  EXPECT_NEAR(deep.moves()[3].spindle_rpm, 20.0, 1e-9);
  EXPECT_NEAR(deep.moves()[3].feed_mm_s, 1000.0 / 60.0, 1e-12);
  EXPECT_NEAR(deep.moves()[2].feed_mm_s, 2.5, 1e-12);
}

}  // namespace
}  // namespace swarf::program::heidenhain_patterns_test
