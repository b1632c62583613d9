// Mirror images, scaling, polar coordinates, tool offsets and reference points of Fanuc programs against
// closed forms.
#include <fmt/format.h>

#include <cmath>

#include "base/rng.h"
#include "unit/program/nc_support.h"

namespace swarf::program::nc_fanuc_transform_test {
namespace {

NcRun fanuc(const std::string& text, const ControlSetup& setup = three_axis_setup()) {
  return run_text(text, Dialect::kFanuc, setup);
}

TEST(NcFanucTransform, MirrorReversesArcsAndCompensation) {
  const NcRun run = fanuc(
      "G51.1 X10\nG00 X12 Y0\nG02 X14 Y2 I2 J0 F100\nG91 G01 X1\nG90 G51.1 Y0\nG00 X12 Y5\n"
      "G02 X14 Y7 R2\nG50.1 X0\nG00 X12 Y5\nG50.1 Y0\nG00 X12 Y5\nM30\n");
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 7u);
  expect_tip(run.moves()[0], 8, 0, 0);
  expect_tip(run.moves()[1], 6, 2, 0);
  ASSERT_TRUE(run.moves()[1].arc);
  EXPECT_NEAR((run.moves()[1].arc->centre_W - Vec3(6, 0, 0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(run.moves()[1].arc->normal_W.z(), 1.0, 1e-12);  // one axis mirrored: counter-clockwise
  expect_tip(run.moves()[2], 5, 2, 0);
  expect_tip(run.moves()[3], 8, -5, 0);
  expect_tip(run.moves()[4], 6, -7, 0);
  EXPECT_NEAR(run.moves()[4].arc->normal_W.z(), -1.0, 1e-12);  // both: clockwise as written
  expect_tip(run.moves()[5], 12, -5, 0);
  expect_tip(run.moves()[6], 12, 5, 0);
}

/// A mirrored compensated contour is the mirror image of the compensated contour.
TEST(NcFanucTransform, MirroredContourIsTheImage) {
  const std::string contour =
      "G00 X-20 Y-20\nG41 D1 G01 X0 Y0 F100\nY30\nX20\nG02 X30 Y20 R10\nG01 Y0\nX-10\nG40 G00 X-30 "
      "Y-20\nM30\n";
  const NcRun plain = fanuc(contour), mirrored = fanuc("G51.1 X0\n" + contour);
  ASSERT_EQ(plain.text(), "");
  ASSERT_EQ(mirrored.text(), "");
  ASSERT_EQ(plain.moves().size(), mirrored.moves().size());
  for (size_t i = 0; i < plain.moves().size(); ++i) {
    const Vec3 to = plain.moves()[i].to.tip_W;
    expect_tip(mirrored.moves()[i], -to.x(), to.y(), to.z());
    if (plain.moves()[i].arc) {
      EXPECT_NEAR(plain.moves()[i].arc->normal_W.z(), -mirrored.moves()[i].arc->normal_W.z(), 1e-12);
    }
  }
}

TEST(NcFanucTransform, ScalingAboutACentre) {
  const NcRun run = fanuc(
      "G00 X10 Y10 Z8\nG51 X0 Y0 Z0 P2.0\nG00 X10 Y10 Z4\nG02 X20 Y20 I10 F100\nG91 G01 X-5\nG90 G50\n"
      "G51 P0.5\nG00 X31\nG50\nG51 X0 Y0 Z0 I-1.0 J0.5 K1.\nG01 X4 Y4\nG50\nG00 X1 Y1\nM30\n");
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 7u);
  expect_tip(run.moves()[1], 20, 20, 8);
  expect_tip(run.moves()[2], 40, 40, 8);
  EXPECT_NEAR((run.moves()[2].arc->centre_W - Vec3(40, 20, 8)).norm(), 0.0, 1e-12);
  expect_tip(run.moves()[3], 30, 40, 8);
  expect_tip(run.moves()[4], 30.5, 40, 8);  // about the present position
  expect_tip(run.moves()[5], -4, 2, 8);
  expect_tip(run.moves()[6], 1, 1, 8);
}

TEST(NcFanucTransform, ScalingLeavesPecksAndCutterAlone) {
  const NcRun run = fanuc("G00 X0 Y0 Z20\nG51 X0 Y0 Z0 P2.\nG99 G83 X5 Z-4 R1 Q3 F100\nG80\nM30\n");
  ASSERT_EQ(run.text(), "");
  std::vector<double> depths;
  for (const NcMove& move : run.moves()) {
    if (!move.rapid) depths.push_back(move.to.tip_W.z());
  }
  EXPECT_EQ(depths, (std::vector<double>{-1, -4, -7, -8}));
  EXPECT_NEAR(run.moves().back().to.tip_W.x(), 10.0, 1e-12);
}

/// The manual's order: mirror image, scaling, rotation; the centre of the rotation is moved along.
TEST(NcFanucTransform, MirrorScaleAndTurnInTheManualsOrder) {
  Rng rng(51);
  for (int round = 0; round < 50; ++round) {
    const auto number = [&] { return std::round(200 * (rng.uniform() - 0.5)) / 4; };
    const double mx = number(), cx = number(), cy = number(), s = 0.25 * (1 + std::floor(12 * rng.uniform()));
    const double rx = number(), ry = number(), angle = 5 * std::floor(72 * rng.uniform()), x = number(),
                 y = number();
    const std::string text = fmt::format(
        "G51.1 X{}\nG51 X{} Y{} Z0 P{:.2f}\nG68 X{} Y{} R{}\nG00 X{} Y{} Z1\nG69\nG50\nG50.1 X0\nM30\n", mx,
        cx, cy, s, rx, ry, angle, x, y);
    const NcRun run = fanuc(text);
    ASSERT_EQ(run.text(), "") << text;
    const auto map = [&](double px, double py) {
      return Vec3(cx + s * (2 * mx - px - cx), cy + s * (py - cy), 0);
    };
    const Vec3 p = map(x, y), c = map(rx, ry);
    const double turn = rad_from_deg(-angle);  // one axis mirrored: the turn goes the other way
    const Vec3 d = p - c;
    expect_tip(run.moves().back(), c.x() + std::cos(turn) * d.x() - std::sin(turn) * d.y(),
               c.y() + std::sin(turn) * d.x() + std::cos(turn) * d.y(), s, 1e-9);
  }
}

/// The manual's example: holes on a circle, angles absolute, then incremental.
TEST(NcFanucTransform, PolarBoltCircle) {
  // Z and R stay what they were under G90, and repeats go on by the angle.
  for (const char* const angles : {"Y150\nY270\n", "G91 Y120\nY120\n", "G91 Y120 K2\n"}) {
    const NcRun run = fanuc(std::string("G00 Z50\nG17 G90 G16\nG99 G81 X100 Y30 Z-20 R-5 F200\n") + angles +
                            "G15 G80\nM30\n");
    std::vector<Vec3> holes;
    for (const NcMove& move : run.moves()) {
      if (!move.rapid) holes.push_back(move.to.tip_W);
    }
    ASSERT_EQ(holes.size(), 3u) << run.text();
    for (size_t i = 0; i < 3; ++i) {
      const double a = rad_from_deg(30 + 120.0 * static_cast<double>(i));
      EXPECT_NEAR(holes[i].x(), 100 * std::cos(a), 1e-12);
      EXPECT_NEAR(holes[i].y(), 100 * std::sin(a), 1e-12);
      EXPECT_NEAR(holes[i].z(), -20.0, 1e-12);
    }
  }
}

TEST(NcFanucTransform, PolarFollowsPlaneInchAndLocalZero) {
  // G18: radius on Z, angle on X, from Z towards X. Angles are degrees in inch programs too.
  const NcRun run = fanuc("G20 G52 Z1\nG18 G16\nG00 Z2 X90 Y1\nG15\nG17 G16\nX2 Y90\nM30\n");
  ASSERT_EQ(run.text(), "");
  expect_tip(run.moves()[0], 50.8, 25.4, 25.4);
  expect_tip(run.moves()[1], 0, 50.8, 25.4);
  const NcRun arc = fanuc("G16\nG00 X10 Y0\nG03 X10 Y90 R10 F100\nG15\nM30\n");
  ASSERT_EQ(arc.text(), "");
  EXPECT_NEAR(arc.moves()[1].arc->centre_W.norm(), 0.0, 1e-12);
}

TEST(NcFanucTransform, ToolOffsetsOfTheProgram) {
  // H12 is no tool of the table: G10 gives it. Wear is added; G91 adds to what stands there.
  const NcRun run = fanuc(
      "T2 M06\nG10 L10 P12 R40\nG10 L11 P12 R0.5\nG43 H12 G00 Z0\nG91 G10 L10 P12 R2\nG90 G43 H12 G00 Z0\n"
      "G10 L11 P2 R-0.25\nG43 H2 Z0\n#1=#11012+#10012\nG49 G00 X#1\nM30\n");
  ASSERT_EQ(run.first_error(), "");
  ASSERT_EQ(run.moves().size(), 4u);
  // The tool is 50 mm long, whatever H says: the tip stands by the difference away.
  expect_tip(run.moves()[0], 0, 0, 40.5 - 50);
  expect_tip(run.moves()[1], 0, 0, 42.5 - 50);
  expect_tip(run.moves()[2], 0, 0, -0.25);
  EXPECT_NEAR(run.moves()[3].to.tip_W.x(), 42.5, 1e-12);
}

TEST(NcFanucTransform, CutterRadiusOffsetsOfTheProgram) {
  const NcRun run =
      fanuc("G10 L12 P5 R3\nG10 L13 P5 R0.5\nG00 X0 Y-10\nG41 D5 G01 X0 Y0 F100\nY20\nG40 X-20\nM30\n");
  ASSERT_EQ(run.diagnostics.list().size(), 1u);
  EXPECT_EQ(run.diagnostics.list()[0].code, "offset-as-radius");
  EXPECT_NEAR(run.moves()[2].to.tip_W.x(), -3.5, 1e-12);
}

TEST(NcFanucTransform, ThereAndBackOverTheReference) {
  ControlSetup setup = three_axis_setup();
  setup.machine.axes[0].home = 300;
  const NcRun run = fanuc(
      "G00 X10 Y20 Z30\nG91 G28 X5\nG90 G29 X50\nG28 X40 Y0\nG91 G29 X1 Y2\nG90 G27 X300\nM30\n", setup);
  ASSERT_EQ(run.text(), "");
  std::vector<std::array<double, 2>> way;
  for (const NcMove& move : run.moves()) way.push_back({move.to.tip_W.x(), move.to.tip_W.y()});
  const std::vector<std::array<double, 2>> expected{{10, 20}, {15, 20}, {300, 20}, {15, 20}, {50, 20},
                                                    {40, 0},  {300, 0}, {40, 0},   {41, 2},  {300, 2}};
  EXPECT_EQ(way, expected);
}

}  // namespace
}  // namespace swarf::program::nc_fanuc_transform_test
