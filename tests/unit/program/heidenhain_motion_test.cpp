// L, arcs, corners, compensation and splines of Heidenhain programs against closed forms.
#include "base/rng.h"
#include "unit/program/heidenhain_support.h"

namespace swarf::program {
namespace {

double turned_by(const NcMove& move) {
  const Vec3 a = move.from.tip_W - move.arc->centre_W, b = move.to.tip_W - move.arc->centre_W;
  const double angle = std::atan2(a.cross(b).dot(move.arc->normal_W), a.dot(b));
  return angle > 1e-9 ? angle : angle + 2.0 * kPi;
}

TEST(HeidenhainMotion, LinesWithModalFeedAndRapids) {
  const NcRun run = klartext_clean(
      "L X+10 Y-5.5 R0 FMAX M3\nL IX+2 Z-1 F600\nL IY+1,5\nL X+0 FMAX\nL Z-3\nL Z-3 F300\nL Z+0\n");
  ASSERT_EQ(run.moves().size(), 6u);
  expect_tip(run.moves()[0], 10, -5.5, 0);
  EXPECT_TRUE(run.moves()[0].rapid);
  expect_tip(run.moves()[1], 12, -5.5, -1);
  EXPECT_NEAR(run.moves()[1].duration_s, std::sqrt(5.0) / 10.0, 1e-12);
  expect_tip(run.moves()[2], 12, -4, -1);
  EXPECT_TRUE(run.moves()[3].rapid);
  EXPECT_FALSE(run.moves()[4].rapid);  // FMAX holds in its block, F600 is back
  EXPECT_NEAR(run.moves()[4].feed_mm_s, 10.0, 1e-12);
  EXPECT_NEAR(run.moves()[5].feed_mm_s, 5.0, 1e-12);
}

TEST(HeidenhainMotion, InchProgramsCountInchesAndTenthsOfThemAMinute) {
  const NcRun run = klartext_clean("L X+1 F100\n", three_axis_setup(), "INCH");
  ASSERT_EQ(run.moves().size(), 1u);
  expect_tip(run.moves()[0], 25.4, 0, 0);
  EXPECT_NEAR(run.moves()[0].duration_s, 6.0, 1e-9);  // 10 inches a minute
}

TEST(HeidenhainMotion, CirclesAboutThePole) {
  const NcRun run =
      klartext_clean("L X+10 F600\nCC X+0 Y+0\nC X+0 Y+10 DR+\nC X+10 Y+0 DR-\nCC IX-5\nC X+10 Y+0 DR+\n");
  ASSERT_EQ(run.moves().size(), 4u);
  const double quarter = 0.5 * kPi * 10.0;
  EXPECT_NEAR(run.moves()[1].duration_s * 10.0, quarter, 1e-9);
  EXPECT_NEAR(run.moves()[2].duration_s * 10.0, quarter, 1e-9);
  EXPECT_NEAR((run.moves()[1].arc->normal_W - Vec3::UnitZ()).norm(), 0.0, 1e-12);
  EXPECT_NEAR((run.moves()[2].arc->normal_W + Vec3::UnitZ()).norm(), 0.0, 1e-12);
  EXPECT_NEAR(run.moves()[3].duration_s * 10.0, 2.0 * kPi * 5.0, 1e-9);  // whole circle
  EXPECT_NEAR((run.moves()[3].arc->centre_W - Vec3(5, 0, 0)).norm(), 0.0, 1e-12);
}

// The four arcs of one radius between two points: R below 0 takes the long way, DR the side.
TEST(HeidenhainMotion, FourArcsByRadius) {
  for (const int turn : {1, -1}) {
    for (const double radius : {10.0, -10.0}) {
      const std::string text =
          "CR X+10 Y+10 R" + std::to_string(radius) + (turn > 0 ? " DR+" : " DR-") + " F600\n";
      const NcRun run = klartext_clean(text);
      ASSERT_EQ(run.moves().size(), 1u) << text;
      const double angle = radius > 0.0 ? 0.5 * kPi : 1.5 * kPi;
      EXPECT_NEAR(run.moves()[0].duration_s * 10.0, 10.0 * angle, 1e-9) << text;
      EXPECT_NEAR(turned_by(run.moves()[0]), angle, 1e-12) << text;
      EXPECT_NEAR(run.moves()[0].arc->normal_W.z(), turn, 1e-12) << text;
    }
  }
}

TEST(HeidenhainMotion, TangentialArc) {
  const NcRun run = klartext_clean("L X+10 F600\nCT X+20 Y+10\nL Y+30\n");
  ASSERT_EQ(run.moves().size(), 3u);
  EXPECT_NEAR((run.moves()[1].arc->centre_W - Vec3(10, 10, 0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(turned_by(run.moves()[1]), 0.5 * kPi, 1e-9);
}

TEST(HeidenhainMotion, PolarLinesAndHelices) {
  const NcRun run = klartext_clean(
      "CC X+5 Y+5\nLP PR+10 PA+0 Z+2 F600\nLP IPA+90\nLP PR+20\nLP IPR-10 PA+0 Z+0\nCP IPA+900 IZ-10 DR+\n"
      "CP PA+0 DR-\n");
  ASSERT_EQ(run.moves().size(), 8u);
  expect_tip(run.moves()[0], 15, 5, 2);
  expect_tip(run.moves()[1], 5, 15, 2);
  expect_tip(run.moves()[2], 5, 25, 2);
  expect_tip(run.moves()[3], 15, 5, 0);
  double way = 0.0;
  for (size_t i = 4; i < 7; ++i) way += run.moves()[i].duration_s * 10.0;
  EXPECT_NEAR(way, std::hypot(5.0 * kPi * 10.0, 10.0), 1e-9);  // 2.5 turns, 10 down
  expect_tip(run.moves()[6], -5, 5, -10);
  EXPECT_NEAR(turned_by(run.moves()[7]), kPi, 1e-12);
}

TEST(HeidenhainMotion, RoundedAndCutCorners) {
  const NcRun run = klartext_clean("L X+20 F600\nRND R5 F300\nL Y+20\nCHF 3\nL X+0\nRND R2\nL Y+0\n");
  ASSERT_EQ(run.moves().size(), 7u);
  expect_tip(run.moves()[0], 15, 0, 0);
  expect_tip(run.moves()[1], 20, 5, 0);
  ASSERT_TRUE(run.moves()[1].arc);
  EXPECT_NEAR(run.moves()[1].duration_s * 5.0, 0.5 * kPi * 5.0, 1e-9);  // its own feed
  EXPECT_NEAR(run.moves()[2].feed_mm_s, 10.0, 1e-12);
  expect_tip(run.moves()[2], 20, 17, 0);
  expect_tip(run.moves()[3], 17, 20, 0);
  expect_tip(run.moves()[4], 2, 20, 0);
  expect_tip(run.moves()[5], 0, 18, 0);
  expect_tip(run.moves()[6], 0, 0, 0);
}

// The rounding of a line and an arc touches both: distances from the centre are the radius, and the
// centre lies at R - r (inside) from the arc's.
TEST(HeidenhainMotion, RoundingBetweenLineAndArc) {
  const NcRun run = klartext_clean("L X+10 F600\nRND R1\nCC X+16 Y+8\nC X+16 Y+18 DR-\n");
  ASSERT_EQ(run.moves().size(), 3u) << run.text();
  const Vec3 centre = run.moves()[1].arc->centre_W;
  EXPECT_NEAR((centre - run.moves()[1].from.tip_W).norm(), 1.0, 1e-9);
  EXPECT_NEAR((centre - run.moves()[1].to.tip_W).norm(), 1.0, 1e-9);
  EXPECT_NEAR(std::abs(centre.y()), 1.0, 1e-9);
  EXPECT_NEAR(std::abs((centre - Vec3(16, 8, 0)).norm() - 10.0), 1.0, 1e-9);
}

TEST(HeidenhainMotion, RadiusCompensationWithDelta) {
  const NcRun run = klartext_clean(
      "TOOL CALL 1 Z S1000 DR+0.5\nL X-20 Y+0 FMAX\nL X+0 Y+0 RL F600\nL Y+30\nL X+40\nL X+60 R0\n");
  // 4 mm radius and 0.5 mm allowance, left of the travel.
  std::vector<Vec3> ends;
  for (const NcMove& move : run.moves()) ends.push_back(move.to.tip_W);
  ASSERT_GE(ends.size(), 4u);
  EXPECT_NEAR((ends[1] - Vec3(-4.5, 0, 0)).norm(), 0.0, 1e-9);
  bool corner = false;
  for (const Vec3& end : ends) corner = corner || std::abs(end.y() - 34.5) < 1e-9;
  EXPECT_TRUE(corner);
  EXPECT_NEAR((ends.back() - Vec3(60, 30, 0)).norm(), 0.0, 1e-9);
}

TEST(HeidenhainMotion, MachineCoordinatesAndRetraction) {
  const NcRun run = klartext_clean(
      "CYCL DEF 7.0 DATUM\nCYCL DEF 7.1 X+100\nL X+1 FMAX\nL X+1 FMAX M91\nL X+1 FMAX\nM140 MB50\n"
      "L M140 MB25 F300\n");
  ASSERT_EQ(run.moves().size(), 5u);
  expect_tip(run.moves()[0], 101, 0, 0);
  expect_tip(run.moves()[1], 1, 0, 0);
  expect_tip(run.moves()[2], 101, 0, 0);
  expect_tip(run.moves()[3], 101, 0, 50);
  EXPECT_TRUE(run.moves()[3].rapid);
  EXPECT_NEAR(run.moves()[4].duration_s, 5.0, 1e-9);
}

// X(t) = K3 t^3 + K2 t^2 + K1 t + X with t from 1 to 0: every point lies on the curve, its chords within the
// tolerance, and the last is the end.
TEST(HeidenhainMotion, SplinePointsLieOnTheirPolynomials) {
  Rng rng(32);
  for (int round = 0; round < 20; ++round) {
    double k[2][3], end[2];
    std::string words;
    for (int i = 0; i < 2; ++i) {
      end[i] = std::round((rng.next() % 2000) / 1e2) - 10.0;
      for (double& one : k[i]) one = static_cast<double>(static_cast<long>(rng.next() % 2000) - 1000) / 100.0;
    }
    char line[400];
    std::snprintf(line, sizeof line,
                  "L X%+.6f Y%+.6f F600\nSPL X%+.6f Y%+.6f ~\n K3X%+.6f K2X%+.6fE+0 K1X%+.6f ~\n K3Y%+.6f "
                  "K2Y%+.6f E1 K1Y%+.6f\n",
                  end[0] + k[0][0] + k[0][1] + k[0][2], end[1] + k[1][0] + k[1][1] + k[1][2], end[0], end[1],
                  k[0][2], k[0][1], k[0][0], k[1][2], 0.1 * k[1][1], k[1][0]);
    const NcRun run = klartext_clean(line);
    ASSERT_GE(run.moves().size(), 2u) << line;
    const auto at = [&](double t, int i) { return end[i] + t * (k[i][0] + t * (k[i][1] + t * k[i][2])); };
    // Half a chord's sag at most: compare with a dense sampling of the polynomial.
    for (size_t n = 1; n < run.moves().size(); ++n) {
      const Vec3 p = run.moves()[n].to.tip_W;
      double nearest = 1e9;
      for (int s = 0; s <= 20000; ++s) {
        const double t = s / 20000.0;
        nearest = std::min(nearest, std::hypot(at(t, 0) - p.x(), at(t, 1) - p.y()));
      }
      ASSERT_LT(nearest, 2.5e-3) << line;  // the sampling's own step
    }
    expect_tip(run.moves().back(), end[0], end[1], 0);
  }
}

// A parabola in closed form: y = x^2 from (1, 1) to (0, 0), length sqrt(5)/2 + asinh(2)/4.
TEST(HeidenhainMotion, SplineParabolaHasItsLength) {
  const NcRun run = klartext_clean("L X+1 Y+1 F60\nSPL X+0 Y+0 K3X+0 K2X+0 K1X+1 K3Y+0 K2Y+1 K1Y+0\n");
  double way = 0.0;
  for (size_t n = 1; n < run.moves().size(); ++n) {
    const Vec3 p = run.moves()[n].to.tip_W;
    EXPECT_NEAR(p.y(), p.x() * p.x(), 1e-12);
    way += run.moves()[n].duration_s;  // 1 mm/s
  }
  EXPECT_NEAR(way, 0.5 * std::sqrt(5.0) + 0.25 * std::asinh(2.0), 2e-4);
}

TEST(HeidenhainMotion, ToolsByNumberAndNameWithLengths) {
  const NcRun run = klartext_clean(
      "TOOL DEF 7\nTOOL CALL \"DRILL6\" Z S2000 F250 DL+1\nL Z+0 FAUTO M13\nL Z-5 R0 FMAX\nTOOL CALL S500\n"
      "L Z+0 FMAX\n");
  ASSERT_EQ(run.moves().size(), 3u);
  EXPECT_EQ(run.moves()[0].tool, 2);
  EXPECT_NEAR(run.moves()[0].spindle_rpm, 2000.0, 1e-9);
  // DL of 1 mm: the tip of the table's tool stands 1 mm higher than programmed.
  EXPECT_NEAR(run.moves()[1].to.tip_W.z(), -4.0, 1e-9);
  EXPECT_NEAR(run.moves()[2].spindle_rpm, 500.0, 1e-9);
  EXPECT_NEAR(run.moves()[0].feed_mm_s, 250.0 / 60.0, 1e-12);
}

TEST(HeidenhainMotion, BlanksCommentsAndStopsAreKept) {
  const NcRun run = klartext_clean(
      "BLK FORM 0.1 Z X+0 Y+0 Z-20\nBLK FORM 0.2 X+100 Y+100 Z+0\n* - ROUGHING\nL X+1 FMAX ; go\nSTOP M8\n");
  std::string words;
  for (const NcNote& note : run.sink.notes) words += note.word + " ";
  EXPECT_EQ(words, "BLK FORM BLK FORM ; ; M8 ");
  EXPECT_EQ(run.summary.functions, (std::vector<std::string>{"STOP", "M8"}));
}

TEST(HeidenhainMotion, FeedPerRevolutionAndTolerance) {
  const NcRun run = klartext_clean(
      "TOOL CALL 1 Z S600\nCYCL DEF 32.0 TOLERANCE\nCYCL DEF 32.1 T0.05\nL X+10 F0.2 M3 M136\nL X+0 F60 "
      "M137\n");
  ASSERT_EQ(run.moves().size(), 2u);
  EXPECT_NEAR(run.moves()[0].duration_s, 10.0 / (0.2 * 600.0 / 60.0), 1e-9);
  EXPECT_NEAR(run.moves()[0].corner_tolerance_mm, 0.05, 1e-12);
  EXPECT_NEAR(run.moves()[1].duration_s, 10.0, 1e-9);
}

/// A whole circle of radius 20 about X25 Z25 at Y25 with the tool axis Z: the sense is counted about +Y, from
/// Z to X.
TEST(HeidenhainArcs, CircleAcrossTheWorkingPlane) {
  const NcRun run = klartext_clean(
      "TOOL CALL 1 Z S1000\nL X+45 Y+25 Z+25 R0 FMAX M3\nCC X+25 Z+25\nC X+45 Z+25 DR+ F200\nC X+25 Z+45 "
      "DR-\n"
      "L Z+60\nCC Y+25 Z+40\nC Y+5 Z+40 DR+\n");
  const auto& moves = run.moves();
  ASSERT_EQ(moves.size(), 5u);
  ASSERT_TRUE(moves[1].arc && moves[2].arc && moves[4].arc);
  EXPECT_LT((moves[1].arc->normal_W - Vec3::UnitY()).norm(), 1e-12);
  EXPECT_LT((moves[1].arc->centre_W - Vec3(25, 25, 25)).norm(), 1e-9);
  expect_tip(moves[1], 45, 25, 25);
  EXPECT_LT((moves[2].arc->normal_W + Vec3::UnitY()).norm(), 1e-12);
  expect_tip(moves[2], 25, 25, 45);
  EXPECT_LT((moves[4].arc->normal_W - Vec3::UnitX()).norm(), 1e-12);
  expect_tip(moves[4], 25, 5, 40);
}

TEST(HeidenhainArcs, WhatDoesNotGoWithACircleAcrossThePlaneIsRefused) {
  const std::string head = "TOOL CALL 1 Z S1000\nL X+45 Y+25 Z+25 R0 FMAX M3\n";
  EXPECT_EQ(klartext(head + "CC X+25 Y+1 Z+25\n").first_error(), "unexpected-word 4:3");
  EXPECT_EQ(klartext(head + "CC Z+25\n").first_error(), "unexpected-word 4:3");
  EXPECT_EQ(klartext(head + "CC X+25 Z+25\nC X+45 Y+3 Z+25 DR+ F200\n").first_error(),
            "unsupported-word 5:8");
  EXPECT_EQ(klartext(head + "CC X+25 Z+25\nLP PR+10 PA+0 F200\n").first_error(), "unsupported-word 5:1");
  EXPECT_EQ(klartext(head + "CC X+25 Z+25\nC X+45 Z+25 DR+ RL F200\n").first_error(),
            "compensation-plane 5:1");
  EXPECT_EQ(klartext(head + "CYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1 X\nCC X+25 Z+25\n").first_error(),
            "unsupported-word 6:3");
}

}  // namespace
}  // namespace swarf::program
