// Fanuc programs: macros, TCP, tilted planes, NURBS, against closed forms.
#include <fmt/format.h>

#include <cmath>

#include "base/rng.h"
#include "unit/program/nc_support.h"

namespace swarf::program::nc_fanuc_test {
namespace {

NcRun fanuc(const std::string& text, const ControlSetup& setup = three_axis_setup()) {
  return run_text(text, Dialect::kFanuc, setup);
}

TEST(NcFanuc, MacrosLoopsAndCalls) {
  const NcRun run = fanuc(
      "O0001\nG21 G90\n#100=3\nWHILE [#100 GT 0] DO1\nG00 X[#100*10]\n#100=#100-1\nEND1\nN5 #101=7\n"
      "IF [#101 LT 9] THEN #101=9\nG00 Y#101\nIF [#101 GE 9] GOTO 20\nG00 Y99\nN20 G65 P0010 A2.5 X4 L2\n"
      "M98 P0020011\nM30\nO0010\nG91 G00 Z[#1+#24]\nG90 M99\nO0011\nG91 G00 X1\nG90 M99\n");
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 8u);
  expect_tip(run.moves()[0], 30, 0, 0);
  expect_tip(run.moves()[2], 10, 0, 0);
  expect_tip(run.moves()[3], 10, 9, 0);
  expect_tip(run.moves()[5], 10, 9, 13);
  expect_tip(run.moves()[7], 12, 9, 13);
}

TEST(NcFanuc, VacantVariablesAndReturnsToBlocks) {
  const NcRun run = fanuc(
      "O0001\n#100=2\nIF [#1 EQ #0] THEN #2=7\nIF [#0 NE #2] THEN #3=8\nIF [#100 EQ #0] THEN #3=9\n"
      "IF [[#5 EQ #0] AND [#2 NE #0]] THEN #4=1\nG00 X#2 Y#3 Z#4\nG65 P2 A5\nG00 X99\nN30 M98 P3\nN40 G00 "
      "X50\n"
      "M30\nO0002\nIF [#2 NE #0] GOTO 1\nG00 X[#1*2]\nN1 M99 P30\nO0003\nM99 P40\n");
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 3u);
  expect_tip(run.moves()[0], 7, 8, 1);
  expect_tip(run.moves()[1], 10, 8, 1);
  expect_tip(run.moves()[2], 50, 8, 1);
  // M99 P in the main program is a jump: counted, it ends.
  const NcRun main = fanuc("#100=0\nN10 #100=#100+1\nG91 G00 X1\nIF [#100 GE 3] GOTO 20\nM99 P10\nN20 M30\n");
  ASSERT_EQ(main.text(), "");
  EXPECT_EQ(main.moves().size(), 3u);
}

TEST(NcFanuc, TcpByRotariesAndByVectors) {
  const ControlSetup setup = five_axis_setup();
  const NcRun run = fanuc(
      "T2 M06\nG43.4 H2 G00 X0 Y0 Z20 A0 C0\nG01 X10 A20 C30 F500\nG49\nG43.5 H2\n"
      "G01 X20 Y5 Z20 I0.5 J0 K0.866025403784439 F500\nG49\nM30\n",
      setup);
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 3u);
  EXPECT_EQ(run.moves()[1].law, BlockLaw::kTcpAxes);
  expect_tip(run.moves()[1], 10, 0, 20);
  EXPECT_EQ(run.moves()[2].law, BlockLaw::kTcp);
  expect_tip(run.moves()[2], 20, 5, 20);
  EXPECT_NEAR((run.moves()[2].to.axis_W - Vec3(0.5, 0, std::sqrt(0.75))).norm(), 0.0, 1e-12);
  EXPECT_NEAR(run.moves()[2].feed_mm_s, 500.0 / 60.0, 1e-12);
}

TEST(NcFanuc, TiltedPlaneDrillsAlongItsNormal) {
  const ControlSetup setup = five_axis_setup();
  const NcRun run = fanuc(
      "T2 M06\nG43 H2 G00 X0 Y0 Z120\nG68.2 X5 Y6 Z7 I30 J40 K0\nG53.1\nG00 X10 Y0 Z20\nG01 Z-5 F300\n"
      "G02 X12 Y2 R2\nG69\nG49\nM30\n",
      setup);
  ASSERT_EQ(run.text(), "");
  const Mat3 R = (Eigen::AngleAxisd(rad_from_deg(30), Vec3::UnitZ()) *
                  Eigen::AngleAxisd(rad_from_deg(40), Vec3::UnitX()))
                     .toRotationMatrix();
  ASSERT_EQ(run.moves().size(), 5u);
  const auto in_work = [&](double x, double y, double z) { return Vec3(Vec3(5, 6, 7) + R * Vec3(x, y, z)); };
  EXPECT_NEAR((run.moves()[1].to.axis_W - R.col(2)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((run.moves()[2].to.tip_W - in_work(10, 0, 20)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((run.moves()[3].to.tip_W - in_work(10, 0, -5)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((run.moves()[4].to.tip_W - in_work(12, 2, -5)).norm(), 0.0, 1e-9);
  ASSERT_TRUE(run.moves()[4].arc);
  EXPECT_NEAR((run.moves()[4].arc->centre_W - in_work(12, 0, -5)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((run.moves()[4].arc->normal_W + R.col(2)).norm(), 0.0, 1e-12);
}

// A full quarter circle as a rational quadratic: every point lies on it, the length is a quarter of the
// circle's.
TEST(NcFanuc, NurbsQuarterCircle) {
  const NcRun run = fanuc(
      "G01 X10 Y0 F600\nG06.2 P3 K0 X10 Y0 Z0 R1\nK0 X10 Y10 R0.707106781186548\nK0 X0 Y10 "
      "R1\nK1\nK1\nK1\nG01 X-5\nM30\n");
  ASSERT_EQ(run.text(), "");
  ASSERT_GE(run.moves().size(), 10u);
  double time = 0.0;
  for (size_t i = 1; i + 1 < run.moves().size(); ++i) {
    EXPECT_NEAR(run.moves()[i].to.tip_W.norm(), 10.0, 1e-9);
    const Vec3 middle = 0.5 * (run.moves()[i].from.tip_W + run.moves()[i].to.tip_W);
    EXPECT_GT(middle.norm(), 10.0 - 1.01e-4);
    time += run.moves()[i].duration_s;
  }
  EXPECT_NEAR(time, 5.0 * kPi / 10.0, 1e-4);
  expect_tip(run.moves().back(), -5, 10, 0);
}

TEST(NcBuilderWords, OfLettersAreNamedOrRefused) {
  ControlSetup setup = three_axis_setup();
  const std::string text = "G00 X1 M68\nM46\nM30\n";
  EXPECT_EQ(run_text(text, Dialect::kFanuc, setup).first_error(), "unknown-word 1:8");
  setup.builder_words = {{"M46", "probe out"}, {"M68", "clamp C"}};
  const NcRun run = run_text(text, Dialect::kFanuc, setup);
  ASSERT_EQ(run.text(), "");
  EXPECT_EQ(run.summary.functions, (std::vector<std::string>{"M68 (clamp C)", "M46 (probe out)"}));
  EXPECT_EQ(run.moves().size(), 1u);
  setup.builder_words = {{"M3", "fan"}};
  EXPECT_EQ(run_text("M03 S1\nM30\n", Dialect::kFanuc, setup).first_error(), "reserved-word 1:1");
  setup.builder_words = {{"M150", "part counter"}};
  EXPECT_EQ(run_text("M150\nM2\n", Dialect::kLinuxCnc, setup).text(), "");
  EXPECT_EQ(run_text("M151\nM2\n", Dialect::kLinuxCnc, setup).first_error(), "unsupported-word 1:1");
}

TEST(NcBuilderWords, CyclesAndProgramsAreNamedOrRefused) {
  ControlSetup setup = three_axis_setup();
  const std::string cycle =
      "BEGIN PGM A MM\nCYCL DEF 392 ATC~\n Q240=7 ;MODE~\n Q241=1\nL X+Q240 FMAX\nEND PGM A MM\n";
  const std::string call = "LASERCHECK(1,\"X\")\nL701 P2\nG0 X7\nM30\n";
  EXPECT_EQ(run_text(cycle, Dialect::kHeidenhain, setup).first_error(), "unknown-word 2:10");
  EXPECT_EQ(run_text(call, Dialect::kSiemens, setup).first_error(), "unknown-word 1:1");
  setup.builder_words = {{"CYCL DEF 392", "tuning"}, {"LASERCHECK", "tool measured"}, {"L701", "pallet"}};
  const NcRun tuned = run_text(cycle, Dialect::kHeidenhain, setup),
              checked = run_text(call, Dialect::kSiemens, setup);
  EXPECT_EQ(tuned.text() + checked.text(), "");
  ASSERT_EQ(tuned.moves().size() + checked.moves().size(), 2u);
  EXPECT_EQ(tuned.moves()[0].to.tip_W.x(), 7.0);
  EXPECT_EQ(tuned.summary.functions, (std::vector<std::string>{"CYCL DEF 392 (tuning)"}));
  EXPECT_EQ(checked.summary.functions,
            (std::vector<std::string>{"LASERCHECK (tool measured)", "L701 (pallet)"}));
}

TEST(NcBuilderWords, AreWrittenInAFewWays) {
  EXPECT_EQ(builder_word("m068"), "M68");
  EXPECT_EQ(builder_word("cycl  def 392"), "CYCL DEF 392");
  EXPECT_EQ(builder_word("LaserCheck_1"), "LASERCHECK_1");
  for (const char* wrong : {"", "M", "G68 X", "68", "M6.5", "CYCL DEF x", "M99999", "a-b"})
    EXPECT_EQ(builder_word(wrong), "") << wrong;
}

TEST(NcFanuc, UnitsForgetTheFeed) {
  EXPECT_EQ(fanuc("G21 F100\nG20 G01 X1\nM30\n").first_error(), "missing-feed 2:9");
  const NcRun run = fanuc("G21 F100\nG20 G01 X1 F10\nG20 X2\nM30\n");
  ASSERT_EQ(run.text(), "");
  EXPECT_NEAR(run.moves()[1].feed_mm_s, 254.0 / 60.0, 1e-12);
}

TEST(NcFanuc, PercentOrMissingEndEndsTheProgram) {
  const NcRun ended = fanuc("G00 X1\n%\nG00 X2\n");
  EXPECT_EQ(ended.text(), "");
  EXPECT_EQ(ended.moves().size(), 1u);
  const NcRun cut_off = fanuc("%\nG00 X1\n");
  EXPECT_FALSE(cut_off.diagnostics.has_errors());
  EXPECT_NE(cut_off.text().find("missing-end"), std::string::npos) << cut_off.text();
}

TEST(NcFanuc, ReferencesAndShifts) {
  const NcRun run = fanuc(
      "G10 L2 P2 X100\nG55 G00 X1 Z20\nG91 G28 Z0\nG90 G52 X5\nG00 X1\nG52 X0\nG53 G00 X0\n"
      "G54.1 P3 G00 X7\nG68 X0 Y0 R90\nG00 X10 Y0\nG69\nM30\n");
  ASSERT_EQ(run.text(), "");
  ASSERT_EQ(run.moves().size(), 6u);
  expect_tip(run.moves()[0], 101, 0, 20);
  expect_tip(run.moves()[1], 101, 0, 0);
  expect_tip(run.moves()[2], 106, 0, 0);
  expect_tip(run.moves()[3], 0, 0, 0);
  expect_tip(run.moves()[4], 7, 0, 0);
  expect_tip(run.moves()[5], 0, 10, 0);
}

// Straight programs written with the numbers of known moves give those moves back.
TEST(NcRoundTrip, StraightPrograms) {
  Rng rng(7);
  for (int round = 0; round < 50; ++round) {
    std::string text = "G21 G90\n";
    std::vector<Vec3> points;
    for (int i = 0; i < 40; ++i) {
      const auto number = [&] { return std::round((rng.uniform() - 0.5) * 2e6) / 1e4; };
      points.emplace_back(number(), number(), number());
      text += fmt::format("G1 X{:.4f} Y{:.4f} Z{:.4f} F{}\n", points.back().x(), points.back().y(),
                          points.back().z(), 100 + i);
    }
    for (const Dialect dialect : {Dialect::kLinuxCnc, Dialect::kFanuc}) {
      const NcRun run = run_text(text + "M30\n", dialect, three_axis_setup());
      ASSERT_EQ(run.text(), "") << text;
      ASSERT_EQ(run.moves().size(), points.size()) << text;
      for (size_t i = 0; i < points.size(); ++i) {
        ASSERT_NEAR((run.moves()[i].to.tip_W - points[i]).norm(), 0.0, 1e-10) << text;
        ASSERT_NEAR(run.moves()[i].duration_s * run.moves()[i].feed_mm_s,
                    (run.moves()[i].to.tip_W - run.moves()[i].from.tip_W).norm(), 1e-9)
            << text;
      }
    }
  }
}

}  // namespace
}  // namespace swarf::program::nc_fanuc_test
