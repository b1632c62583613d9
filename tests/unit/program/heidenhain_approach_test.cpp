// APPR and DEP: each point computed by hand.
#include <fmt/format.h>

#include "base/rng.h"
#include "unit/program/heidenhain_support.h"

namespace swarf::program {
namespace {

/// END8: radius 4. The tool stands in (-20, -20, 0) before the approach.
const char* const kBefore = "TOOL CALL 1 Z S1000\nL X-20 Y-20 R0 FMAX M3\n";

void expect_ends(const NcRun& run, size_t first, const std::vector<Vec3>& ends) {
  ASSERT_GE(run.moves().size(), first + ends.size()) << run.text();
  for (size_t i = 0; i < ends.size(); ++i) {
    const Vec3& tip = run.moves()[first + i].to.tip_W;
    EXPECT_NEAR((tip - ends[i]).norm(), 0.0, 1e-9) << "move " << first + i << ": " << tip.transpose();
  }
}

TEST(HeidenhainApproach, StraightAlongTheContour) {
  const NcRun run = klartext_clean(std::string(kBefore) +
                                   "APPR LT X+0 Y+0 Z-10 LEN15 RL F300\nL Y+30\nDEP LT LEN12.5 Z+5 F100\n");
  // t = +Y, RL: the cutter 4 mm to the left. First in the plane, then down, then along the contour.
  expect_ends(run, 1,
              {{-4, -15, 0}, {-4, -15, -10}, {-4, 0, -10}, {-4, 30, -10}, {-4, 42.5, -10}, {-4, 42.5, 5}});
  EXPECT_TRUE(run.moves()[1].rapid);  // as the block before it
  EXPECT_TRUE(run.moves()[2].rapid);
  EXPECT_NEAR(run.moves()[3].feed_mm_s, 5.0, 1e-12);
  EXPECT_NEAR(run.moves()[5].feed_mm_s, 100.0 / 60.0, 1e-12);
  ASSERT_EQ(run.moves().size(), 7u);
}

TEST(HeidenhainApproach, StraightAcrossTheContour) {
  const NcRun run = klartext_clean(std::string(kBefore) +
                                   "APPR LN X+0 Y+0 LEN15 RR F300\nL Y+30\nDEP LN LEN+20 F100\nL X+50\n");
  // RR: the cutter on the right, LEN and the radius from the contour.
  expect_ends(run, 1, {{19, 0, 0}, {4, 0, 0}, {4, 30, 0}, {24, 30, 0}, {50, 30, 0}});
}

// The manual's APPR CT: half a circle that ends along the contour; the rotation is that of R's sign and RL
// RR.
TEST(HeidenhainApproach, ArcOntoTheContour) {
  struct Case {
    const char* side;
    double radius, turn, beside, aux_x;
  };
  for (const Case& one : {Case{"RL", 10, 1, -4, -24}, Case{"RL", -10, -1, -4, 16}, Case{"RR", 10, -1, 4, 24},
                          Case{"RR", -10, 1, 4, -16}}) {
    const NcRun run =
        klartext_clean(std::string(kBefore) +
                       fmt::format("APPR CT X+0 Y+0 CCA180 R{:+} {} F300\nL Y+30\nDEP CT CCA90 R{:+}\n",
                                   one.radius, one.side, one.radius));
    const double out = one.radius > 0.0 ? one.beside / 4.0 * 10.0 : -one.beside / 4.0 * 10.0;
    expect_ends(run, 1,
                {{one.aux_x, 0, 0}, {one.beside, 0, 0}, {one.beside, 30, 0}, {one.beside + out, 40, 0}});
    const NcMove& arc = run.moves()[2];
    ASSERT_TRUE(arc.arc) << one.side;
    EXPECT_NEAR(arc.arc->normal_W.z(), one.turn, 1e-12) << one.side << one.radius;
    EXPECT_NEAR((arc.arc->centre_W - Vec3(one.beside + out, 0, 0)).norm(), 0.0, 1e-9);
    EXPECT_NEAR(arc.duration_s * 5.0, kPi * 10.0, 1e-9);
    ASSERT_TRUE(run.moves()[4].arc);
    EXPECT_NEAR(run.moves()[4].arc->normal_W.z(), one.turn, 1e-12);
  }
}

// LCT by hand: A = (-4, 0), centre (-9, 0), R = 5. From (-9, -13) the tangent touches where the distance 13,
// the radius 5 and the way 12 make a right triangle: H = centre + 5 (12, -5) / 13.
TEST(HeidenhainApproach, LineAndArc) {
  const NcRun run = klartext_clean(
      "TOOL CALL 1 Z S1000\nL X-9 Y-13 R0 FMAX M3\nAPPR LCT X+0 Y+0 Z-2 R5 RL F300\nL Y+30\n"
      "DEP LCT X-9 Y+43 R5 F600\n");
  const Vec3 centre(-9, 0, -2);
  const Vec3 H = centre + 5.0 / 13.0 * Vec3(12, -5, 0);
  expect_ends(run, 1, {{H.x(), H.y(), 0}, H, {-4, 0, -2}, {-4, 30, -2}});
  EXPECT_FALSE(run.moves()[1].rapid);  // at the feed of its own block
  EXPECT_NEAR(run.moves()[1].feed_mm_s, 5.0, 1e-12);
  EXPECT_NEAR((run.moves()[3].arc->centre_W - centre).norm(), 0.0, 1e-9);
  EXPECT_NEAR(run.moves()[3].arc->normal_W.z(), 1.0, 1e-12);
  const Vec3 G = Vec3(-9, 30, -2) + 5.0 / 13.0 * Vec3(12, 5, 0);
  expect_ends(run, 5, {G, {-9, 43, -2}});
}

// Each LCT touches: the line runs on into the arc, the arc into the contour, for every side and place.
TEST(HeidenhainApproach, LineAndArcTouchFromEverywhere) {
  Rng rng(7);
  const auto random = [&](double size) {
    return size * (2.0 * static_cast<double>(rng.next() % 10000) / 1e4 - 1.0);
  };
  for (int round = 0; round < 200; ++round) {
    const Vec3 from(random(80), random(80), 0), to(random(20), random(20), 0);
    const bool left = rng.next() % 2 == 0;
    const double R = 1.0 + static_cast<double>(rng.next() % 90) / 10.0;
    const Vec3 t = to.normalized(), n = (left ? 1.0 : -1.0) * Vec3(-t.y(), t.x(), 0), centre = (4.0 + R) * n;
    if ((from - centre).norm() < R + 0.01 || to.norm() < 1.0) continue;
    const std::string text = fmt::format(
        "TOOL CALL 1 Z S1000\nL X{:+.9f} Y{:+.9f} R0 FMAX M3\nAPPR LCT X+0 Y+0 R{} {} F300\nL X{:+.9f} "
        "Y{:+.9f}\nDEP LT LEN1\n",
        from.x(), from.y(), R, left ? "RL" : "RR", to.x(), to.y());
    const NcRun run = klartext_clean(text);
    ASSERT_GE(run.moves().size(), 4u) << text;
    const NcMove &line = run.moves()[1], &arc = run.moves()[2];
    ASSERT_TRUE(arc.arc) << text;
    const auto tangent = [&](const Vec3& at) {
      return Vec3(arc.arc->normal_W.cross(at - arc.arc->centre_W).normalized());
    };
    EXPECT_NEAR(((line.to.tip_W - line.from.tip_W).normalized() - tangent(line.to.tip_W)).norm(), 0.0, 1e-6)
        << text;
    EXPECT_NEAR((tangent(arc.to.tip_W) - t).norm(), 0.0, 1e-7) << text;
    EXPECT_NEAR((arc.to.tip_W - 4.0 * n).norm(), 0.0, 1e-7) << text;
    EXPECT_NEAR((arc.from.tip_W - arc.arc->centre_W).norm(), R, 1e-9) << text;
  }
}

// The manual's circle: APPR LCT onto a circle about the pole, whole circle, DEP LCT; cutter 5 at 50 mm.
TEST(HeidenhainApproach, OntoACircleAndInPolarCoordinates) {
  ControlSetup setup = three_axis_setup();
  const NcRun run = klartext_clean(
      "TOOL CALL 2 Z S3150\nCC X+50 Y+50\nL X-40 Y+50 Z+0 R0 FMAX M3\nAPPR LCT X+0 Y+50 R5 RL F300\nC X+0 "
      "DR-\n"
      "DEP LCT X-40 Y+50 R5 F1000\n",
      setup);
  ASSERT_EQ(run.moves().size(), 6u);
  // Clockwise from the left end: t = +Y, the cutter outside; the arc's centre (-10, 50).
  expect_ends(run, 2, {{-5, 50, 0}, {-5, 50, 0}});
  EXPECT_NEAR((run.moves()[3].arc->centre_W - Vec3(50, 50, 0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(run.moves()[3].duration_s * 5.0, 2.0 * kPi * 55.0, 1e-6);
  const NcRun polar = klartext_clean(
      "TOOL CALL 2 Z S3150\nCC X+50 Y+50\nL X-40 Y+50 Z+0 R0 FMAX M3\nAPPR PLCT PR+50 PA+180 R5 RL F300\nC "
      "X+0 DR-\n"
      "DEP PLCT PR+90 PA+180 R5 F1000\n",
      setup);
  ASSERT_EQ(polar.moves().size(), run.moves().size());
  for (size_t i = 0; i < run.moves().size(); ++i)
    EXPECT_NEAR((polar.moves()[i].to.tip_W - run.moves()[i].to.tip_W).norm(), 0.0, 1e-9) << i;
}

TEST(HeidenhainApproach, StraightWithoutCompensation) {
  const NcRun run = klartext_clean(
      "L X-20 R0 F600\nCC X+0 Y+0\nAPPR PLT PR+10 PA+90 LEN5 R0 F300\nL X+20 Y+10\nDEP LT LEN2\n");
  expect_ends(run, 1, {{-5, 10, 0}, {0, 10, 0}, {20, 10, 0}, {22, 10, 0}});
  EXPECT_NEAR(run.moves()[1].feed_mm_s, 10.0, 1e-12);  // the feed before it
  EXPECT_NEAR(run.moves()[2].feed_mm_s, 5.0, 1e-12);
}

// The corner behind the first piece is rounded as ever.
TEST(HeidenhainApproach, RoundingBehindTheFirstPiece) {
  const NcRun run = klartext_clean(std::string(kBefore) +
                                   "APPR LT X+0 Y+0 LEN15 RL F300\nL Y+30\nRND R6\nL X+30\nDEP LT LEN1\n");
  expect_ends(run, 1, {{-4, -15, 0}, {-4, 0, 0}, {-4, 24, 0}, {6, 34, 0}, {30, 34, 0}, {31, 34, 0}});
}

}  // namespace
}  // namespace swarf::program
