// Cutter radius compensation against contours moved aside by hand.
#include <cmath>

#include "unit/program/nc_support.h"

namespace swarf::program {
namespace {

// T1 has a diameter of 8 mm: the cutter goes 4 mm aside.
TEST(NcContour, SquareFromOutside) {
  const NcRun run =
      linuxcnc("T1 M6 G43 F600\nG0 X-20 Y0\nG42 G1 X0\nX30\nY30\nX0\nY-10\nG40 G1 X-20 Y-10\nM2\n");
  ASSERT_EQ(run.text(), "");
  const std::vector<Vec3> ends = {{-20, 0, 0}, {0, -4, 0}, {30, -4, 0}, {34, 0, 0},   {34, 30, 0},
                                  {30, 34, 0}, {0, 34, 0}, {-4, 30, 0}, {-4, -10, 0}, {-20, -10, 0}};
  ASSERT_EQ(run.moves().size(), ends.size());
  for (size_t i = 0; i < ends.size(); ++i) {
    expect_tip(run.moves()[i], ends[i].x(), ends[i].y(), ends[i].z());
    if (i > 0) {
      EXPECT_NEAR((run.moves()[i].from.tip_W - ends[i - 1]).norm(), 0.0, 1e-9) << i;
    }
  }
  ASSERT_TRUE(run.moves()[3].arc);
  EXPECT_NEAR((run.moves()[3].arc->centre_W - Vec3(30, 0, 0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((run.moves()[3].arc->normal_W - Vec3(0, 0, 1)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(run.moves()[3].duration_s, 0.5 * kPi * 4.0 / 10.0, 1e-9);
}

TEST(NcContour, SquareFromInside) {
  const NcRun run =
      linuxcnc("T1 M6 G43 F600\nG0 X15 Y15\nG41 G1 X15 Y0\nX30\nY30\nX0\nY0\nX15\nG40 G1 X15 Y15\nM2\n");
  ASSERT_EQ(run.text(), "");
  // The lead-in ends across itself, (19, 0); its corner to the first side is an inner one: (19, 4).
  const std::vector<Vec3> ends = {{15, 15, 0}, {19, 4, 0}, {26, 4, 0}, {26, 26, 0},
                                  {4, 26, 0},  {4, 4, 0},  {15, 4, 0}, {15, 15, 0}};
  ASSERT_EQ(run.moves().size(), ends.size());
  for (size_t i = 0; i < ends.size(); ++i) expect_tip(run.moves()[i], ends[i].x(), ends[i].y(), 0);
}

TEST(NcContour, CircleFromBothSides) {
  for (const bool inside : {true, false}) {
    const NcRun run = linuxcnc(std::string("T1 M6 G43 F600\nG0 X20 Y-30\n") + (inside ? "G41" : "G42") +
                               " G1 X20 Y0\nG3 X20 Y0 I-20 J0\nG1 Y30\nG40 G1 X20 Y50\nM2\n");
    ASSERT_EQ(run.text(), "");
    const double r = inside ? 16.0 : 24.0;
    ASSERT_GE(run.moves().size(), 3u);
    expect_tip(run.moves()[1], r, 0, 0);
    ASSERT_TRUE(run.moves()[2].arc);
    expect_tip(run.moves()[2], r, 0, 0);
    EXPECT_NEAR((run.moves()[2].arc->centre_W).norm(), 0.0, 1e-9);
    EXPECT_NEAR(run.moves()[2].duration_s, 2 * kPi * r / 10.0, 1e-9);
  }
}

TEST(NcContour, LineMeetsArcInAnInnerCorner) {
  // Along X, then a quarter circle about (30, 10) that starts at (20, 10): the line ends where its offset y =
  // 4 meets the arc's offset. Going up from (20, 0) to (20, 10) first, so that the corner at (20, 0) is
  // inner.
  const NcRun run = linuxcnc(
      "T1 M6 G43 F600\nG0 X-20 Y0\nG41 G1 X0\nX20\nY10\nG2 X30 Y20 I10 J0\nG1 X50\nG40 G1 X60 Y30\nM2\n");
  ASSERT_EQ(run.text(), "");
  expect_tip(run.moves()[2], 16, 4, 0);
  expect_tip(run.moves()[3], 16, 10, 0);
  ASSERT_TRUE(run.moves()[4].arc);
  expect_tip(run.moves()[4], 30, 24, 0);
}

TEST(NcContour, DepthMovesStandInTheirCorner) {
  const NcRun run = linuxcnc("T1 M6 G43 F600\nG0 X-20 Y0 Z5\nG42 G1 X0\nX30\nZ-2\nY30\nG40 G1 Y60 X60\nM2\n");
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 7u);
  expect_tip(run.moves()[3], 30, -4, -2);
  expect_tip(run.moves()[4], 34, 0, -2);
  expect_tip(run.moves()[5], 34, 30, -2);
  expect_tip(run.moves()[6], 60, 60, -2);
}

TEST(NcContour, WhatGougesIsRefused) {
  EXPECT_EQ(linuxcnc("T1 M6 G43 F600\nG0 X-20 Y0\nG41 G1 X0\nX3\nY2\nX0\n").first_error(),
            "compensation-gouge 4:1");
  EXPECT_EQ(linuxcnc("T1 M6 G43 F600\nG0 X-20 Y0\nG41 G1 X0\nG3 X0 Y6 I0 J3\nX-9\n").first_error(),
            "compensation-gouge 4:4");
  EXPECT_EQ(linuxcnc("T1 M6 G43 F600\nG0 X-2 Y0\nG41 G1 X0\n").first_error(), "compensation-entry 3:8");
  EXPECT_EQ(linuxcnc("T1 M6 G43 F600\nG41 G3 X0 Y0 I20\n").first_error(), "compensation-entry 2:8");
}

}  // namespace
}  // namespace swarf::program
