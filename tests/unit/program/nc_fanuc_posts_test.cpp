// Programs as posts and people write them: heads, ends of lines, retracts, calls. Results by hand.
#include <fmt/format.h>

#include <cmath>

#include "unit/program/nc_support.h"

namespace swarf::program::nc_fanuc_posts_test {
namespace {

NcRun fanuc(const std::string& text, const ControlSetup& setup = three_axis_setup()) {
  return run_text(text, Dialect::kFanuc, setup);
}

/// Mastercam: CR LF, sequence numbers, name in the O line, modal words, J before I.
TEST(NcFanucPosts, MillWithSequenceNumbers) {
  const NcRun run = fanuc(
      "%\r\nO0001(BRACKET)\r\n(DATE=DD-MM-YY - 21-11-26)\r\nN100 G21\r\nN102 G0 G17 G40 G49 G80 G90\r\n"
      "N104 T2 M6\r\nN106 G0 G90 G54 X-60. Y0. S3000 M3\r\nN108 G43 H2 Z50. M8\r\nN110 Z5.\r\n"
      "N112 G1 Z0. F500.\r\nN114 X60.\r\nN116 G3 X60. Y20. J10. I0.\r\nN118 G0 Z50.\r\nN120 M5\r\n"
      "N122 G91 G28 Z0. M9\r\nN124 G28 X0. Y0.\r\nN126 G90\r\nN128 M30\r\n%\r\n");
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 9u);
  expect_tip(run.moves()[5], 60, 20, 0);
  EXPECT_NEAR((run.moves()[5].arc->centre_W - Vec3(60, 10, 0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(run.moves()[5].duration_s, kPi * 10 / (500.0 / 60), 1e-9);
  expect_tip(run.moves()[8], 0, 0, -50);  // home of the gauge line
}

/// A retract before any position is known: G91 G28 Z0 needs no point to go through.
TEST(NcFanucPosts, RetractBeforeAnyPosition) {
  ControlSetup setup = three_axis_setup();
  setup.start.reset();
  setup.machine.axes[2].home = 400;
  const NcRun run =
      fanuc("%\nO1001\nN10 G90 G94 G17\nN20 G28 G91 Z0.\nN25 G90\nN30 G0 X5. Y6.\nN35 G43 Z15. H2\nM30\n%\n",
            setup);
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 1u);
  EXPECT_EQ(run.moves()[0].q_from[2], 400.0);
  EXPECT_EQ(run.summary.start.substr(0, 43), "machine position X5.0000 Y6.0000 Z400.0000:");
  // A point that is not where the axis stands needs a position.
  EXPECT_EQ(fanuc("G91 G28 Z5.\nM30\n", setup).first_error(), "start-unknown 1:9");
}

/// Modal codes hold even where the block's own action is another one.
TEST(NcFanucPosts, MotionCodesBesideOtherWords) {
  const NcRun run = fanuc(
      "G1 X1. F100.\nG0 G91 G28 Z0.\nG90 X5.\nG1 G50.1 X0\nX6.\nG81 Z-1. R1.\nG0 G40 G50.1 G69 "
      "G80\nX9.\nM30\n");
  ASSERT_EQ(run.text(), "");
  std::string rapids;
  for (const NcMove& move : run.moves()) rapids += move.rapid ? 'r' : 'f';
  EXPECT_EQ(rapids, "frfrfrr");
  EXPECT_EQ(fanuc("G81 X1 Z-1. R1. F100.\nG53 Z0\nM30\n").first_error(), "modal-conflict 2:1");
}

TEST(NcFanucPosts, NamesOfPrograms) {
  for (const char* const head : {"%\n:0012\n", "%\n<BRACKET_2>(OP 10)\n", "O0012\n", "%\n:0012(OP 10)\n"}) {
    const NcRun run = fanuc(std::string(head) + "G0 X1.\nM98 P7\nM30\n:0007\nG0 X2.\nM99\n%\n");
    EXPECT_EQ(run.text(), "") << head;
    EXPECT_EQ(run.moves().size(), 2u) << head;
  }
}

TEST(NcFanucPosts, NumbersWithoutAPointAreStated) {
  EXPECT_EQ(fanuc("G0 X0 Y1.5 Z5.\nX#100 M30\n").summary.dialect_reason, "the scene says so");
  EXPECT_EQ(
      fanuc("G0 X0 Y1.5\nG1 X100 F20\nM30\n").summary.dialect_reason,
      "the scene says so; X100 in line 2 has no decimal point: such numbers are millimetres and degrees "
      "(calculator type, parameter 3401)");
  const NcRun run = fanuc("G0 X100 Y-50.\nM30\n");
  expect_tip(run.moves()[0], 100, -50, 0);
}

/// 3+2: I90 J30 K-90 is a turn by 30 degrees about Y, so that the hole runs along (-1/2, 0, -sqrt(3)/2).
TEST(NcFanucPosts, TiltedHole) {
  ControlSetup setup = five_axis_setup();
  const NcRun run = fanuc(
      "%\nO0004(3+2)\nG21\nG0 G17 G40 G49 G80 G90\nG91 G28 Z0.\nT2 M06\nG90 G54\nG00 A0 C0\n"
      "G68.2 X20. Y0. Z50. I90. J30. K-90.\nG53.1\nG43 H2 X0. Y0. Z60. S2000 M03\n"
      "G98 G81 X0. Y0. Z-12. R2. F150.\nG80\nG0 Z60.\nG49\nG69\nG91 G28 Z0.\nG28 X0 Y0\nG90\nM30\n%\n",
      setup);
  ASSERT_EQ(run.text(), "");
  const Vec3 normal(0.5, 0, std::sqrt(0.75)), origin(20, 0, 50);
  int feeds = 0;
  for (const NcMove& move : run.moves()) {
    if (move.rapid) continue;
    ++feeds;
    EXPECT_LE((move.from.tip_W - (origin + 2 * normal)).norm(), 1e-9);
    EXPECT_LE((move.to.tip_W - (origin - 12 * normal)).norm(), 1e-9);
    EXPECT_LE((move.to.axis_W - normal).norm(), 1e-12);
    EXPECT_NEAR(move.duration_s, 14.0 / (150.0 / 60), 1e-9);
  }
  EXPECT_EQ(feeds, 1);
}

/// A bolt hole circle macro with H holes of step B from A on the circle of diameter I about X Y.
TEST(NcFanucPosts, BoltHoleCircle) {
  const NcRun run = fanuc(
      "%\nO0011\nG90 G21 G54 G0 X0 Y0 Z50.\nG65 P9110 X10. Y20. Z-5. R2. F200. I30. A0 B45. H8\nG0 "
      "Z50.\nM30\n"
      "O9110(BOLT HOLE CIRCLE)\n#30=#4/2\n#31=1\nWHILE [#31 LE #11] DO1\n#33=#1+[#31-1]*#2\n"
      "#32=#24+#30*COS[#33]\n#33=#25+#30*SIN[#33]\nG81 G98 X#32 Y#33 Z#26 R#18 F#9\nG80\n#31=#31+1\nEND1\n"
      "M99\n%\n");
  ASSERT_EQ(run.text(), "");
  std::vector<Vec3> holes;
  for (const NcMove& move : run.moves()) {
    if (!move.rapid) holes.push_back(move.to.tip_W);
  }
  ASSERT_EQ(holes.size(), 8u);
  for (size_t i = 0; i < 8; ++i) {
    const double a = rad_from_deg(45.0 * static_cast<double>(i));
    EXPECT_LE((holes[i] - Vec3(10 + 15 * std::cos(a), 20 + 15 * std::sin(a), -5)).norm(), 1e-9);
  }
}

/// One pocket in four quadrants: mirrored by one axis it is milled the other way round.
TEST(NcFanucPosts, PocketInFourQuadrants) {
  const NcRun run = fanuc(
      "%\nO0014\nG90 G54 G0 X0 Y0 Z10.\nM98 P100\nG51.1 X0.\nM98 P100\nG51.1 Y0.\nM98 P100\nG50.1 X0.\n"
      "M98 P100\nG50.1 Y0.\nM30\nO0100\nG0 X10. Y10.\nG1 Z-2. F100.\nX20.\nG3 X30. Y20. R10.\nG1 Y30.\n"
      "G0 Z10.\nM99\n%\n");
  ASSERT_EQ(run.text(), "");
  const double signs[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
  size_t arc = 0;
  for (const NcMove& move : run.moves()) {
    if (!move.arc) continue;
    ASSERT_LT(arc, 4u);
    const auto& [sx, sy] = signs[arc++];
    expect_tip(move, 30 * sx, 20 * sy, -2);
    EXPECT_NEAR((move.arc->centre_W - Vec3(20 * sx, 20 * sy, -2)).norm(), 0.0, 1e-9);
    EXPECT_NEAR(move.arc->normal_W.z(), sx * sy, 1e-12);
  }
  EXPECT_EQ(arc, 4u);
}

}  // namespace
}  // namespace swarf::program::nc_fanuc_posts_test
