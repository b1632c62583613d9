// Motions, frames and orientations of Siemens 840D programs against closed forms.
#include <fmt/format.h>

#include <cmath>

#include "base/rng.h"
#include "unit/program/siemens_support.h"

namespace swarf::program::nc::siemens::siemens_motion_test {
namespace {

Mat3 turn(const Vec3& axis, double deg) {
  return Eigen::AngleAxisd(rad_from_deg(deg), axis).toRotationMatrix();
}
Mat3 Rx(double deg) {
  return turn(Vec3::UnitX(), deg);
}
Mat3 Ry(double deg) {
  return turn(Vec3::UnitY(), deg);
}
Mat3 Rz(double deg) {
  return turn(Vec3::UnitZ(), deg);
}
/// Tool axis of the Spinner in W.
Vec3 axis_at(double b_deg, double c_deg) {
  return Rz(c_deg) * (Ry(b_deg) * Vec3::UnitZ());
}

void expect_near(const Vec3& a, const Vec3& b, double tolerance, const std::string& what = "") {
  EXPECT_LE((a - b).norm(), tolerance) << what << ": " << a.transpose() << " instead of " << b.transpose();
}

const NcMove& last_of(const Ran& ran) {
  static const NcMove none;
  return ran.moves.empty() ? none : ran.moves.back();
}

TEST(SiemensMotion, SignOfTheRadiusChoosesTheArc) {
  const double h = std::sqrt(75.0);
  const struct {
    const char* block;
    double centre_y, normal_z;
  } cases[] = {
      {"G2 X10 CR=10", -h, -1}, {"G2 X10 CR=-10", h, -1}, {"G3 X10 CR=10", h, 1}, {"G3 X10 CR=-10", -h, 1}};
  for (const auto& one : cases) {
    const Ran ran = run_clean(std::string("G0 Z=IC(-5)\nF100\n") + one.block + "\nM30\n");
    ASSERT_TRUE(last_of(ran).arc) << one.block;
    expect_near(last_of(ran).arc->centre_W - Vec3(0, 0, last_of(ran).arc->centre_W.z()),
                Vec3(5, one.centre_y, 0), 1e-9, one.block);
    expect_near(last_of(ran).arc->normal_W, Vec3(0, 0, one.normal_z), 1e-12, one.block);
  }
}

TEST(SiemensMotion, CentresAreIncrementalOrAbsoluteInEveryPlane) {
  const struct {
    const char* blocks;
    Vec3 centre, normal, end;
  } cases[] = {
      {"G0 X10 Y0 Z0\nG17 G3 X0 Y10 I-10 J0 F100\n", {0, 0, 0}, {0, 0, 1}, {0, 10, 0}},
      {"G0 X10 Y0 Z0\nG17 G3 X0 Y10 I=AC(0) J=AC(0) F100\n", {0, 0, 0}, {0, 0, 1}, {0, 10, 0}},
      {"G0 X10 Y0 Z0\nG17 G91 G3 X-10 Y=AC(10) I-10 F100\n", {0, 0, 0}, {0, 0, 1}, {0, 10, 0}},
      {"G0 X0 Y3 Z10\nG18 G3 X10 Z0 I0 K-10 F100\n", {0, 3, 0}, {0, 1, 0}, {10, 3, 0}},
      {"G0 X3 Y10 Z0\nG19 G3 Y0 Z10 J-10 F100\n", {3, 0, 0}, {1, 0, 0}, {3, 0, 10}},
      {"G0 X10 Y0 Z0\nG3 I-10 F100\n", {0, 0, 0}, {0, 0, 1}, {10, 0, 0}},
      {"G0 X10 Y0 Z0\nCIP X0 Y10 I1=10*COS(30) J1=10*SIN(30) F100\n", {0, 0, 0}, {0, 0, 1}, {0, 10, 0}},
      {"G0 X10 Y0 Z0\nCIP X0 Z10 I1=10*COS(60) K1=10*SIN(60) F100\n", {0, 0, 0}, {0, -1, 0}, {0, 0, 10}},
      {"G0 X10 Y-5 Z0\nG1 Y0 F100\nCT X0 Y10\n", {0, 0, 0}, {0, 0, 1}, {0, 10, 0}},
      {"G0 X10 Y0 Z0\nG3 X0 Y10 I-10 F100\nCT X-10 Y0\n", {0, 0, 0}, {0, 0, 1}, {-10, 0, 0}},
      {"G0 X10 Y0 Z0\nG3 AR=90 I-10 F100\n", {0, 0, 0}, {0, 0, 1}, {0, 10, 0}},
      {"G0 X10 Y0 Z0\nG3 X0 Y10 AR=90 F100\n", {0, 0, 0}, {0, 0, 1}, {0, 10, 0}},
      {"G0 X10 Y0 Z0\nG2 X0 Y10 AR=270 F100\n", {0, 0, 0}, {0, 0, -1}, {0, 10, 0}},
  };
  for (const auto& one : cases) {
    // The work's zero is put high enough that the machine can get there.
    ControlSetup setup = setup_of(spinner());
    kinematics::AxisValues offset = kinematics::AxisValues::Zero();
    offset[2] = 300.0;
    setup.work_offsets[1] = offset;
    const Ran ran = run_text(std::string(one.blocks) + "M30\n", setup);
    ASSERT_FALSE(ran.diagnostics.has_errors()) << one.blocks << all_text(ran.diagnostics);
    const NcMove& move = last_of(ran);
    ASSERT_TRUE(move.arc) << one.blocks;
    const Vec3 up(0, 0, 300);
    const Vec3 flat_miss = move.arc->centre_W - up - one.centre;
    expect_near(flat_miss - flat_miss.dot(one.normal) * one.normal, Vec3::Zero(), 1e-9, one.blocks);
    expect_near(move.arc->normal_W, one.normal, 1e-9, one.blocks);
    expect_near(move.to.tip_W - up, one.end, 1e-9, one.blocks);
  }
}

TEST(SiemensMotion, HelixTurnsAreWholeTurnsBeforeTheLast) {
  const Ran ran = run_clean("G0 X10 Y0 Z400\nG3 X0 Y10 Z390 I-10 TURN=2 F100\nM30\n");
  double angle = 0.0, fallen = 0.0;
  for (const NcMove& move : ran.moves) {
    if (!move.arc) continue;
    const Vec3 a = move.from.tip_W - move.arc->centre_W, b = move.to.tip_W - move.arc->centre_W;
    double turned = std::atan2(a.x() * b.y() - a.y() * b.x(), a.x() * b.x() + a.y() * b.y());
    if (turned <= 1e-9) turned += 2.0 * kPi;
    angle += turned;
    fallen += move.from.tip_W.z() - move.to.tip_W.z();
  }
  EXPECT_NEAR(angle, 4.5 * kPi, 1e-9);
  EXPECT_NEAR(fallen, 10.0, 1e-9);
}

TEST(SiemensMotion, MixesAbsoluteAndIncrementalWords) {
  const Ran ran = run_clean(
      "G0 X10 Y=IC(5)\nG91 X5 Y=AC(2)\nX=IC(-1) Y1\nG90 C=DC(350)\nC=ACP(10)\nC=ACN(0)\nC=IC(-5)\nM30\n");
  ASSERT_EQ(ran.moves.size(), 7U);
  expect_near(ran.moves[0].q_to.head<3>(), Vec3(10, 5, 400), 1e-12);
  expect_near(ran.moves[1].q_to.head<3>(), Vec3(15, 2, 400), 1e-12);
  expect_near(ran.moves[2].q_to.head<3>(), Vec3(14, 3, 400), 1e-12);
  const double c[] = {-10, 10, 0, -5};
  for (size_t n = 0; n < 4; ++n) EXPECT_NEAR(deg_from_rad(ran.moves[3 + n].q_to[4]), c[n], 1e-9) << n;
}

TEST(SiemensMotion, FeedsAndTimes) {
  const auto seconds = [](const std::string& text) {
    return last_of(run_clean(text + "\nM30\n")).duration_s;
  };
  EXPECT_NEAR(seconds("G1 X100 F600"), 10.0, 1e-9);
  EXPECT_NEAR(seconds("G93 G1 X100 F4"), 15.0, 1e-9);
  EXPECT_NEAR(seconds("S1000 M3 G95 G1 X100 F0.2"), 30.0, 1e-9);
  EXPECT_NEAR(seconds("G70 G1 X1 F254"), 6.0, 1e-9);  // 25.4 mm at 254 mm/min
  EXPECT_NEAR(seconds("G700 G1 X1 F10"), 6.0, 1e-9);  // one inch at 10 in/min
  EXPECT_NEAR(seconds("F254\nG70 G1 X1"), 6.0, 1e-9);
  EXPECT_NEAR(seconds("F254\nG700 G1 X1"), 6.0, 1e-9);  // F stays the speed that it was
  EXPECT_NEAR(last_of(run_clean("G700 G1 X2 F10\nM30\n")).to.tip_W.x(), 50.8, 1e-9);
  EXPECT_NEAR(last_of(run_clean("G4 F1.5\nG1 X1 F100\nM30\n")).dwell_s, 1.5, 1e-12);
  EXPECT_NEAR(last_of(run_clean("S600 M3\nG4 S20\nG1 X1 F100\nM30\n")).dwell_s, 2.0, 1e-12);
}

TEST(SiemensMotion, CornersFollowG60G64AndCycle832) {
  const Ran ran = run_clean(
      "G1 X1 F100\nG64 X2\nG641 ADIS=0.4 X3\nCYCLE832(0.02,1,1)\nX4\nCYCLE832()\nX5\nG60 X6\nG9 G64 "
      "X7\nX8\nCTOL=0.05 G642 X9\nM30\n");
  ASSERT_EQ(ran.moves.size(), 9U);
  const bool exact[] = {true, false, false, false, false, true, true, false, false};
  const double tolerance[] = {0, 0, 0.2, 0.02, 0.2, 0, 0, 0, 0.05};
  for (size_t n = 0; n < 9; ++n) {
    EXPECT_EQ(ran.moves[n].exact_stop, exact[n]) << n;
    EXPECT_NEAR(ran.moves[n].corner_tolerance_mm, tolerance[n], 1e-12) << n;
  }
}

TEST(SiemensMotion, MachineCoordinatesAndToolLengths) {
  const Ran ran = run_clean(
      "T=\"MILL10\"\nM6\nSUPA G0 Z=500 D0\nSUPA G0 Z=480 D1\nG0 Z300\nG0 D0 Z300\nG75 Z=0\nG74 X1=0 "
      "Y1=0\nM30\n");
  std::vector<double> z;
  for (const NcMove& move : ran.moves) z.push_back(move.q_to[2]);
  // Tool change at 610; D0: the gauge line, D1: 120 mm of tool above it; home again.
  EXPECT_EQ(z, (std::vector<double>{610, 500, 600, 420, 300, 610}));
  EXPECT_NEAR(ran.moves[3].to.tip_W.z(), 300.0, 1e-9);
  EXPECT_EQ(ran.summary.tools_used.size(), 0U);  // nothing was cut
}

TEST(SiemensFrames, ReplaceAndAddAsTheControlDoes) {
  const struct {
    const char* frame;
    Vec3 end;  ///< of X1 Y2
  } cases[] = {
      {"TRANS X10 Y20", {11, 22, 0}},
      {"TRANS X10 Y20\nATRANS X5", {16, 22, 0}},
      {"TRANS X10 Y20\nTRANS Y5", {1, 7, 0}},
      {"ROT Z90", {-2, 1, 0}},
      {"ROT RPL=90", {-2, 1, 0}},
      {"TRANS X10 Y20\nAROT Z90", {8, 21, 0}},
      {"TRANS X10 Y20\nROT Z90", {-2, 1, 0}},
      {"ROT Z90\nATRANS X10", {-2, 11, 0}},
      {"ROT Z30\nAROT Z60", {-2, 1, 0}},
      {"ROT Z90\nTRANS", {1, 2, 0}},
      {"ROT Z90\nMIRROR", {1, 2, 0}},
  };
  for (const auto& one : cases) {
    const Ran ran = run_clean(std::string(one.frame) + "\nG0 X1 Y2 Z300\nM30\n");
    expect_near(last_of(ran).to.tip_W - Vec3(0, 0, 300), one.end, 1e-9, one.frame);
  }
}

TEST(SiemensFrames, SeveralAnglesTurnAboutZThenYThenX) {
  const Ran ran = run_clean("ROT X30 Y40 Z50\nG0 X10 Y20 Z300\nM30\n");
  expect_near(last_of(ran).to.tip_W, Rz(50) * Ry(40) * Rx(30) * Vec3(10, 20, 300), 1e-9);
  const Ran added =
      run_clean("TRANS X1 Y2 Z3\nAROT X30\nAROT Y-20\nATRANS Z7\nAROT Z15\nG0 X10 Y20 Z300\nM30\n");
  const Vec3 expected = Vec3(1, 2, 3) + Rx(30) * Ry(-20) * (Vec3(0, 0, 7) + Rz(15) * Vec3(10, 20, 300));
  expect_near(last_of(added).to.tip_W, expected, 1e-9);
}

/// TRAORI: whatever the rotary axes and the tool, the tip stands where it is programmed.
TEST(SiemensTraori, KeepsTheTipWhereItIsProgrammed) {
  Rng rng(20260501);
  for (int round = 0; round < 200; ++round) {
    const auto between = [&](double low, double high) { return low + (high - low) * rng.uniform(); };
    const double b = between(-95, 95), c = between(-180, 180), x = between(-50, 50), y = between(-50, 50),
                 z = between(200, 260);
    const double turn_z = between(-180, 180);
    const std::string text = fmt::format(
        "T=\"MILL10\"\nM6\nTRAORI\nORIAXES\nTRANS X3 Y-4\nAROT Z{:.6f}\nG0 X0 Y0 Z300\nG1 X{:.6f} Y{:.6f} "
        "Z{:.6f} B{:.6f} C{:.6f} F1000\nM30\n",
        turn_z, x, y, z, b, c);
    const Ran ran = run_clean(text);
    const NcMove& move = last_of(ran);
    const auto rounded = [](double v) { return std::round(v * 1e6) / 1e6; };
    const Vec3 expected = Vec3(3, -4, 0) + Rz(rounded(turn_z)) * Vec3(rounded(x), rounded(y), rounded(z));
    expect_near(move.to.tip_W, expected, 1e-8, text);
    expect_near(move.to.axis_W, axis_at(rounded(b), rounded(c)), 1e-12, text);
    EXPECT_EQ(move.law, BlockLaw::kTcpAxes);
  }
}

TEST(SiemensTraori, TakesVectorsEulerAndRpyAngles) {
  const Vec3 v = Vec3(1, 2, 3).normalized();
  const auto axis = [](const std::string& block) {
    return last_of(run_clean("TRAORI\nORIWKS\nG0 X0 Y0 Z300\n" + block + "\nM30\n")).to.axis_W;
  };
  expect_near(axis("G1 X1 A3=1 B3=2 C3=3 F500"), v, 1e-9);
  expect_near(axis("AROT Z90\nG1 X1 A3=1 B3=2 C3=3 F500"), Rz(90) * v, 1e-9);
  expect_near(axis("ORIEULER\nG1 X1 A2=20 B2=30 C2=40 F500"), Rz(20) * Rx(30) * Rz(40) * Vec3::UnitZ(), 1e-9);
  expect_near(axis("ORIRPY\nG1 X1 A2=20 B2=30 C2=40 F500"), Rz(40) * Ry(30) * Rx(20) * Vec3::UnitZ(), 1e-9);
  EXPECT_EQ(last_of(run_clean("TRAORI\nORIWKS\nG0 X0 Y0 Z300\nG1 X1 A3=1 C3=1 F500\nM30\n")).law,
            BlockLaw::kTcp);
  EXPECT_EQ(
      last_of(run_clean("TRAORI\nORIWKS\nG0 X0 Y0 Z300\nG1 X1 A3=1 C3=1 F500\nTRAFOOF\nG1 X2\nM30\n")).law,
      BlockLaw::kJoint);
}

TEST(SiemensTraori, SaysWhichInterpolationItAssumes) {
  const Ran ran = run_clean("TRAORI\nG0 X0 Y0 Z300\nG1 X1 B5 F500\nM30\n");
  EXPECT_NE(all_text(ran.diagnostics).find("orientation-assumed"), std::string::npos);
}

/// CYCLE800: the tool axis stands along the plane's normal, B has the sign of _DIR, and coordinates lie in
/// the plane.
TEST(SiemensSwivel, AgreesWithRotationMatricesInEveryOrder) {
  const struct {
    int mode;
    int order[3];
  } modes[] = {{57, {0, 1, 2}}, {45, {0, 2, 1}}, {54, {1, 0, 2}},
               {30, {1, 2, 0}}, {39, {2, 0, 1}}, {27, {2, 1, 0}}};
  Rng rng(800);
  int reached = 0;
  for (int round = 0; round < 240; ++round) {
    const auto& mode = modes[round % 6];
    double angle[3];
    Mat3 R = Mat3::Identity();
    for (int n = 0; n < 3; ++n) {
      angle[n] = std::round(1e3 * (-80.0 + 160.0 * rng.uniform())) / 1e3;
      R = R * turn(Vec3::Unit(mode.order[n]), angle[n]);
    }
    const int direction = rng.uniform() < 0.5 ? -1 : 1;
    const std::string text =
        fmt::format("CYCLE800(0,\"TC1\",0,{},1,2,200,{:.3f},{:.3f},{:.3f},4,5,6,{},0,1)\nG0 X7 Y8 Z9\nM30\n",
                    mode.mode, angle[0], angle[1], angle[2], direction);
    const double b = deg_from_rad(std::acos(R(2, 2)));
    const Ran ran = run_text(text);
    if (b > 100.0) {
      EXPECT_EQ(errors_of(ran.diagnostics), std::vector<std::string>{"unreachable-orientation 1:1"}) << text;
      continue;
    }
    ASSERT_FALSE(ran.diagnostics.has_errors()) << all_text(ran.diagnostics) << text;
    ++reached;
    const NcMove& move = last_of(ran);
    expect_near(move.to.axis_W, R.col(2), 1e-9, text);
    expect_near(move.to.tip_W, Vec3(1, 2, 200) + R * Vec3(4 + 7, 5 + 8, 6 + 9), 1e-8, text);
    EXPECT_NEAR(deg_from_rad(move.q_to[3]), direction * b, 1e-7) << text;
  }
  EXPECT_GT(reached, 150);
}

TEST(SiemensSwivel, EndsAndAddsUp) {
  const Ran off =
      run_clean("CYCLE800(0,\"\",0,57,0,0,200,0,30,0,0,0,0,1)\nCYCLE800()\nG0 B0 C0\nG0 X1 Y2 Z300\nM30\n");
  expect_near(last_of(off).to.tip_W, Vec3(1, 2, 300), 1e-9);
  const Ran twice = run_clean(
      "CYCLE800(0,\"\",0,57,0,0,200,0,30,0,0,0,0,1)\nCYCLE800(0,\"\",1,57,0,0,0,0,15,0,0,0,0,1)\nG0 X1 Y2 "
      "Z3\nM30\n");
  expect_near(last_of(twice).to.tip_W, Vec3(0, 0, 200) + Ry(45) * Vec3(1, 2, 3), 1e-9);
  const Ran away = run_clean("G0 X10 Y10\nCYCLE800(2,\"\",0,57,0,0,200,0,30,0,0,0,0,1)\nM30\n");
  ASSERT_EQ(away.moves.size(), 4U);
  EXPECT_EQ(away.moves[1].q_to[2], 610.0);
  EXPECT_EQ(away.moves[2].q_to[0], -365.0);
  EXPECT_NEAR(deg_from_rad(away.moves[3].q_to[3]), 30.0, 1e-9);
}

TEST(SiemensDrilling, DrillsAtEachPositionUntilMcallEnds) {
  const Ran ran = run_clean(
      "T=\"DRILL5\"\nM6\nS1000 M3 F200\nG0 X0 Y0 Z300\nMCALL CYCLE82(290,250,2,-20+250,,0.5)\nX10\nX20 "
      "Y5\nMCALL\nX30\nM30\n");
  std::vector<Vec3> bottoms;
  for (const NcMove& move : ran.moves) {
    if (!move.rapid) bottoms.push_back(move.to.tip_W);
  }
  ASSERT_EQ(bottoms.size(), 2U);
  expect_near(bottoms[0], Vec3(10, 0, 230), 1e-9);
  expect_near(bottoms[1], Vec3(20, 5, 230), 1e-9);
  expect_near(last_of(ran).to.tip_W, Vec3(30, 5, 290), 1e-9);
}

TEST(SiemensDrilling, PecksAndTaps) {
  // 6.7525 + 2 is a last bit above 8.7525.
  run_clean("F200\nG0 X0 Y0 Z300\nCYCLE81(8.7525,6.7525,2,-4.3475)\nM30\n");
  const Ran pecks = run_clean("F200\nG0 X0 Y0 Z300\nCYCLE83(290,250,2,230,,,8,0,0,0,1,1)\nM30\n");
  std::vector<double> depths;
  for (const NcMove& move : pecks.moves) {
    if (!move.rapid) depths.push_back(move.to.tip_W.z());
  }
  EXPECT_EQ(depths.size(), 3U);  // 22 mm from the safety plane in pecks of 8 mm
  EXPECT_NEAR(depths.back(), 230.0, 1e-9);
  const Ran taps = run_clean("G0 X0 Y0 Z300\nCYCLE84(290,250,2,240,,0,5,,1.25,0,400,400)\nM30\n");
  std::vector<double> speeds;
  for (const NcMove& move : taps.moves) {
    if (move.rapid) continue;
    speeds.push_back(move.spindle_rpm);
    EXPECT_NEAR(move.duration_s, 12.0 / (1.25 * 400.0) * 60.0, 1e-9);
  }
  EXPECT_EQ(speeds, (std::vector<double>{400, -400}));
}

TEST(SiemensWords, WithoutEffectAreListedOnce) {
  const Ran ran = run_clean("N10 SOFT FFWON M8\nN20 M8 COMPCAD\n/N30 MSG(\"HELLO\")\nM30\n");
  EXPECT_EQ(ran.summary.functions, (std::vector<std::string>{"M8", "SOFT", "FFWON", "COMPCAD", "/", "MSG"}));
  bool found = false;
  for (const NcNote& note : ran.notes)
    found = found || (note.word == "MSG" && note.text == "HELLO" && note.line == 3);
  EXPECT_TRUE(found);
}

TEST(SiemensCutter, GoesBesideTheContour) {
  const Ran ran =
      run_clean("T=\"MILL10\" M6\nG0 X-20 Y-20 Z200\nG41 G1 X0 Y0 F500\nY50\nX50\nG40 X80 Y60\nM30\n");
  bool beside = false;
  for (const NcMove& move : ran.moves) {
    const bool up = move.to.tip_W.y() > move.from.tip_W.y() + 30.0;
    if (up && std::abs(move.to.tip_W.x() + 5.0) < 1e-9 && std::abs(move.from.tip_W.x() + 5.0) < 1e-9)
      beside = true;
  }
  EXPECT_TRUE(beside) << "no move along Y at 5 mm to the left of the contour";
}

}  // namespace
}  // namespace swarf::program::nc::siemens::siemens_motion_test
