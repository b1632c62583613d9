// Tilted planes, datum shifts, TCPM and LN of Heidenhain programs against rotation matrices.
#include <fmt/format.h>

#include "base/rng.h"
#include "unit/program/heidenhain_support.h"

namespace swarf::program::heidenhain_planes_test {
namespace {

Mat3 about(int axis, double deg) {
  return Eigen::AngleAxisd(rad_from_deg(deg), Vec3::Unit(axis)).toRotationMatrix();
}

/// The point of W that program coordinates mean.
void expect_at(const NcMove& move, const Vec3& expected) {
  EXPECT_NEAR((move.to.tip_W - expected).norm(), 0.0, 1e-9)
      << move.to.tip_W.transpose() << "  not  " << expected.transpose();
}

// SPA about X, then SPB about the fixed Y, then SPC about the fixed Z: the tool stands along the third
// column, and the tilted plane's points lie where the matrix puts them.
TEST(HeidenhainPlanes, SpatialAnglesOverAGrid) {
  const ControlSetup setup = free_five_axis_setup();
  int planes = 0;
  for (int a = -80; a <= 80; a += 40) {
    for (int b = -80; b <= 80; b += 40) {
      for (int c = -170; c <= 180; c += 70) {
        const NcRun run = klartext_clean(
            fmt::format(
                "CYCL DEF 7.0 DATUM\nCYCL DEF 7.1 X+3 Y-4 Z+5\nPLANE SPATIAL SPA{:+} SPB{:+} SPC{:+} TURN "
                "FMAX\nL X+10 Y+20 Z+30 FMAX\nCC X+0 Y+20\nC X+0 Y+30 DR+ F500\nPLANE RESET STAY\n",
                a, b, c),
            setup);
        const Mat3 R = about(2, c) * about(1, b) * about(0, a);
        const Vec3 origin(3, -4, 5);
        ASSERT_GE(run.moves().size(), 2u);
        const NcMove& arc = run.moves().back();
        const NcMove& line = run.moves()[run.moves().size() - 2];
        ASSERT_NEAR((line.to.axis_W - R.col(2)).norm(), 0.0, 1e-9) << a << " " << b << " " << c;
        expect_at(line, origin + R * Vec3(10, 20, 30));
        expect_at(arc, origin + R * Vec3(0, 30, 30));
        ASSERT_TRUE(arc.arc);
        EXPECT_NEAR((arc.arc->centre_W - (origin + R * Vec3(0, 20, 30))).norm(), 0.0, 1e-9);
        EXPECT_NEAR((arc.arc->normal_W - R.col(2)).norm(), 0.0, 1e-9);
        ++planes;
      }
    }
  }
  EXPECT_EQ(planes, 150);
}

// The same plane by every kind of definition.
TEST(HeidenhainPlanes, KindsOfPlanesAgree) {
  const Mat3 R = about(2, 30) * about(0, 40);
  const Vec3 x = R.col(0), z = R.col(2), y = R.col(1);
  const std::vector<std::string> kinds{
      "PLANE EULER EULPR+30 EULNU+40 EULROT+0",
      fmt::format("PLANE VECTOR BX{:+.15f} BY{:+.15f} BZ{:+.15f} NX{:+.15f} NY{:+.15f} NZ{:+.15f}", x.x(),
                  x.y(), x.z(), z.x(), z.y(), z.z()),
      fmt::format(
          "PLANE POINTS P1X+0 P1Y+0 P1Z+0 P2X{:+.15f} P2Y{:+.15f} P2Z{:+.15f} P3X{:+.15f} P3Y{:+.15f} "
          "P3Z{:+.15f}",
          x.x(), x.y(), x.z(), y.x(), y.y(), y.z()),
      "PLANE SPATIAL SPA+40 SPB+0 SPC+30", "PLANE SPATIAL SPA+0 SPB+0 SPC+30 STAY\nPLANE RELATIV SPA+40"};
  for (const std::string& kind : kinds) {
    const NcRun run = klartext_clean(kind + " TURN FMAX SEQ-\nL X+1 Y+2 Z+3 FMAX\n", free_five_axis_setup());
    ASSERT_FALSE(run.moves().empty()) << kind;
    EXPECT_NEAR((run.moves().back().to.axis_W - z).norm(), 0.0, 1e-9) << kind;
    expect_at(run.moves().back(), R * Vec3(1, 2, 3));
  }
}

TEST(HeidenhainPlanes, TurnKeepsTheLinearAxesAndMoveTheTip) {
  const std::string head =
      "TOOL CALL 2 Z S1000\nL X+10 Y+20 Z+100 A+0 C+0 FMAX\nPLANE SPATIAL SPA+30 SPB+0 SPC+0 ";
  const NcRun turn = klartext_clean(head + "TURN F1000\n", free_five_axis_setup());
  const NcRun move = klartext_clean(head + "MOVE DIST0 FMAX\n", free_five_axis_setup());
  const NcRun stay = klartext_clean(head + "STAY\nL A+Q120 C+Q122 FMAX\n", free_five_axis_setup());
  const NcMove &turned = turn.moves().back(), &moved = move.moves().back(), &stayed = stay.moves().back();
  const auto& axes = free_five_axis_setup().machine.axes;
  for (size_t i = 0; i < axes.size(); ++i) {
    if (axes[i].kind == kinematics::AxisKind::kLinear) {
      EXPECT_EQ(turned.q_from[static_cast<long>(i)], turned.q_to[static_cast<long>(i)]) << axes[i].name;
    }
    EXPECT_NEAR(turned.q_to[static_cast<long>(i)], stayed.q_to[static_cast<long>(i)], 1e-12) << axes[i].name;
  }
  EXPECT_NEAR(turned.duration_s, 30.0 / (1000.0 / 60.0), 1e-9);  // degrees a minute
  EXPECT_NEAR((moved.to.tip_W - moved.from.tip_W).norm(), 0.0, 1e-9);
  const Mat3 R = about(0, 30);
  EXPECT_NEAR((moved.to.axis_W - R.col(2)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((turned.to.axis_W - R.col(2)).norm(), 0.0, 1e-9);
}

TEST(HeidenhainPlanes, ResetTurnsTheAxesToZero) {
  const NcRun run = klartext_clean(
      "PLANE SPATIAL SPA+30 SPB+0 SPC+50 TURN FMAX\nPLANE RESET TURN FMAX\nL X+1 Y+2 Z+3 FMAX\n",
      free_five_axis_setup());
  ASSERT_FALSE(run.moves().empty());
  const NcMove& last = run.moves().back();
  EXPECT_NEAR((last.to.axis_W - Vec3::UnitZ()).norm(), 0.0, 1e-12);
  expect_at(last, Vec3(1, 2, 3));
}

// Shift and rotation before the plane, and within it: T(s) Rz(q) R T(s') Rz(q').
TEST(HeidenhainPlanes, ShiftsAndRotationsOutsideAndInside) {
  const NcRun run = klartext_clean(
      "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+10\nCYCL DEF 7.2 Y+20\nCYCL DEF 7.3 IZ+5\nCYCL DEF 10.0 "
      "ROTATION\n"
      "CYCL DEF 10.1 ROT+30\nL X+1 Y+2 Z+3 FMAX\nCYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 A+0 B+40 C+0\n"
      "L A+Q120 C+Q122 FMAX\nTRANS DATUM AXIS X+7 Y+8\nCYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 IROT-15\n"
      "L X+1 Y+2 Z+3 FMAX\nTRANS DATUM RESET\nCYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+0\n"
      "CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1\nCYCL DEF 10.0 R\nCYCL DEF 10.1 ROT+0\n"
      "CYCL DEF 7.0 D\nCYCL DEF 7.1 X+0 Y+0 Z+0\nL A+0 C+0 FMAX\nL X+1 Y+2 Z+3 FMAX\n",
      free_five_axis_setup());
  ASSERT_GE(run.moves().size(), 5u);
  const Vec3 s(10, 20, 5), p(1, 2, 3);
  expect_at(run.moves()[0], s + about(2, 30) * p);
  expect_at(run.moves()[2], s + about(2, 30) * about(1, 40) * (Vec3(7, 8, 0) + about(2, -15) * p));
  EXPECT_NEAR((run.moves()[2].to.axis_W - (about(2, 30) * about(1, 40)).col(2)).norm(), 0.0, 1e-9);
  expect_at(run.moves().back(), p);
}

TEST(HeidenhainPlanes, PresetsAreWorkOffsets) {
  ControlSetup setup = three_axis_setup();
  AxisValues offset = AxisValues::Zero();
  offset.head<3>() << 100, 200, 300;
  setup.work_offsets[3] = offset;
  const NcRun run =
      klartext_clean("CYCL DEF 247 DATUM SETTING ~\n  Q339=+3 ;DATUM NUMBER\nL X+1 Y+2 Z+3 FMAX\n", setup);
  ASSERT_EQ(run.moves().size(), 1u);
  const AxisValues q = run.moves()[0].q_to;
  EXPECT_NEAR((q.head<3>() - Eigen::Vector3d(101, 202, 303)).norm(), 0.0, 1e-12);
}

// The manual: a preset ends shift, mirror image, rotation and scaling.
TEST(HeidenhainPlanes, PresetsEndTheTransformationsBeforeThem) {
  const NcRun run = klartext_clean(
      "TRANS DATUM AXIS X+10\nTRANS MIRROR AXIS Y\nTRANS ROTATION ROT+30\nTRANS SCALE SCL2\nCYCL DEF 247 "
      "PRESET "
      "Q339=+1\nCYCL DEF 13.0 ORIENTATION\nCYCL DEF 13.1 ANGLE 180\nL X+1 Y+2 Z+3 FMAX\n");
  ASSERT_EQ(run.moves().size(), 1u);
  expect_tip(run.moves()[0], 1, 2, 3);
  EXPECT_EQ(
      klartext("PLANE SPATIAL SPA+10 SPB+0 SPC+0 STAY\nCYCL DEF 247 PRESET Q339=+1\n", free_five_axis_setup())
          .first_error(),
      "unsupported-word 3:10");
}

// M128 and each FUNCTION TCPM: the tip goes where it is programmed, whatever the rotary axes do.
TEST(HeidenhainTcpm, TipStandsWhereItIsProgrammed) {
  const std::string head = "TOOL CALL 2 Z S1000\nL X+0 Y+0 Z+50 A+0 C+0 FMAX\n";
  for (const std::string on : {"M128", "M128 F1000", "FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS",
                               "FUNCTION TCPM F TCP AXIS POS PATHCTRL VECTOR REFPNT TIP-TIP"}) {
    const NcRun run = klartext_clean(
        head + on + "\nL X+10 Y+5 Z+20 A-20 C+30 F500\nL A-40 C+60 F500\nM129\nL X+0 Y+0 Z+80 A+0 C+0 FMAX\n",
        free_five_axis_setup());
    ASSERT_EQ(run.moves().size(), 4u) << on;
    expect_tip(run.moves()[1], 10, 5, 20);
    expect_tip(run.moves()[2], 10, 5, 20);
    const bool vector = on.find("VECTOR") != std::string::npos;
    EXPECT_EQ(run.moves()[1].law, vector ? BlockLaw::kTcp : BlockLaw::kTcpAxes) << on;
    EXPECT_EQ(run.moves()[3].law, BlockLaw::kJoint);
    EXPECT_NEAR(run.moves()[1].feed_mm_s, 500.0 / 60.0, 1e-12);
    EXPECT_NEAR(run.moves()[2].duration_s, std::hypot(20.0, 30.0) / (500.0 / 60.0), 1e-9);
  }
}

// AXIS SPAT: A B C are spatial angles of the tool, as PLANE SPATIAL has them.
TEST(HeidenhainTcpm, SpatialAnglesOfTheTool) {
  const NcRun run = klartext_clean(
      "FUNCTION TCPM F TCP AXIS SPAT PATHCTRL VECTOR\nL X+1 Y+2 Z+3 A+10 B+20 C+30 F500\nFUNCTION RESET "
      "TCPM\n",
      free_five_axis_setup());
  ASSERT_EQ(run.moves().size(), 1u);
  EXPECT_NEAR((run.moves()[0].to.axis_W - (about(2, 30) * about(1, 20) * about(0, 10)).col(2)).norm(), 0.0,
              1e-9);
  expect_tip(run.moves()[0], 1, 2, 3);
}

// LN with a tool vector: tip and axis are those of the block, and the axis goes along the great circle.
TEST(HeidenhainTcpm, VectorsGiveTipAndAxis) {
  Rng rng(5);
  const auto random = [&] { return 2.0 * static_cast<double>(rng.next() % 100000) / 1e5 - 1.0; };
  for (int round = 0; round < 40; ++round) {
    const Vec3 p(10 * random(), 10 * random(), 10 * random());
    const Vec3 t = Vec3(random(), random(), 1.2 + random()).normalized();
    const std::string text = fmt::format(
        "TOOL CALL 2 Z S1000\nL X+0 Y+0 Z+50 A+0 C+0 FMAX\nM128\nLN X{:+.9f} Y{:+.9f} Z{:+.9f} TX{:+.9f} "
        "TY{:+.9f} "
        "TZ{:+.9f} F900\nL IX+1 A+0 C+0\nM129\n",
        p.x(), p.y(), p.z(), t.x(), t.y(), t.z());
    const NcRun run = klartext_clean(text, free_five_axis_setup());
    ASSERT_EQ(run.moves().size(), 3u) << text;
    EXPECT_NEAR((run.moves()[1].to.tip_W - p).norm(), 0.0, 1e-8) << text;
    EXPECT_NEAR((run.moves()[1].to.axis_W - t).norm(), 0.0, 1e-8) << text;
    EXPECT_EQ(run.moves()[1].law, BlockLaw::kTcp);
    EXPECT_EQ(run.moves()[2].law, BlockLaw::kTcpAxes);  // rotary words turn the axes again
    EXPECT_NEAR((run.moves()[2].to.tip_W - p - Vec3::UnitX()).norm(), 0.0, 1e-8) << text;
    EXPECT_NEAR(run.moves()[1].duration_s, (p - Vec3(0, 0, 50)).norm() / 15.0, 1e-8) << text;
  }
}

// The contact point of a torus cutter: the tip that touches there. Independent oracle: the distance of the
// contact point from the torus' core circle is the corner radius, along the normal.
TEST(HeidenhainTcpm, ContactPointsOfATorusCutter) {
  ControlSetup setup = free_five_axis_setup();
  setup.tools.push_back({9, "TORUS", 50.0, 20.0, 3.0});
  const Vec3 n = Vec3(0.3, -0.2, 0.8).normalized(), t = Vec3(0.1, 0.2, 0.9).normalized(), p(4, 5, 6);
  const NcRun run = klartext_clean(
      fmt::format(
          "TOOL CALL 9 Z S1000 DR2+0.25 DR+0.5\nL X+0 Y+0 Z+90 A+0 C+0 FMAX M128\nFUNCTION PROG PATH IS "
          "CONTOUR\nLN X+4 Y+5 Z+6 NX{:+.12f} NY{:+.12f} NZ{:+.12f} TX{:+.12f} TY{:+.12f} TZ{:+.12f} F500\n"
          "FUNCTION PROG PATH OFF\nLN X+4 Y+5 Z+6 NX{:+.12f} NY{:+.12f} NZ{:+.12f} TX{:+.12f} TY{:+.12f} "
          "TZ{:+.12f}\n",
          n.x(), n.y(), n.z(), t.x(), t.y(), t.z(), n.x(), n.y(), n.z(), t.x(), t.y(), t.z()),
      setup);
  ASSERT_EQ(run.moves().size(), 3u);
  const auto gap = [&](const Vec3& tip, double radius, double corner) {
    const Vec3 middle = tip + corner * t, to_point = p - middle;
    const Vec3 across = (to_point - to_point.dot(t) * t).normalized();
    const Vec3 core = middle + (radius - corner) * across;
    EXPECT_NEAR((core - p).norm(), corner, 1e-9);
    EXPECT_NEAR(((core - p).normalized() - n).norm(), 0.0, 1e-9);
  };
  gap(run.moves()[1].to.tip_W, 10.5, 3.25);
  gap(run.moves()[2].to.tip_W, 0.5, 0.25);
}

TEST(HeidenhainTcpm, SplineWithRotaryAxes) {
  const NcRun run = klartext_clean(
      "TOOL CALL 2 Z S1000\nL X+10 Y+0 Z+50 A-10 C+0 FMAX M128\nSPL X+0 Y+0 Z+50 A-30 C+40 K3X+0 K2X+0 "
      "K1X+10 "
      "K3Y+0 K2Y+0 K1Y+0 K3Z+0 K2Z+0 K1Z+0 K3A+0 K2A+5 K1A+15 K3C+0 K2C-40 K1C+0 F600\n",
      free_five_axis_setup());
  ASSERT_GE(run.moves().size(), 100u);  // the rotary axes bend
  const kinematics::MachineModel& machine = free_five_axis_setup().machine;
  size_t a = 0, c = 0;
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    if (machine.axes[i].name == "A") a = i;
    if (machine.axes[i].name == "C") c = i;
  }
  for (size_t i = 1; i < run.moves().size(); ++i) {
    const NcMove& move = run.moves()[i];
    const double s = move.to.tip_W.x() / 10.0;
    EXPECT_NEAR(deg_from_rad(move.q_to[static_cast<long>(a)]), -30 + 15 * s + 5 * s * s, 1e-9);
    EXPECT_NEAR(deg_from_rad(move.q_to[static_cast<long>(c)]), 40 - 40 * s * s, 1e-9);
    EXPECT_NEAR((move.to.tip_W - Vec3(10 * s, 0, 50)).norm(), 0.0, 1e-9);
  }
}

TEST(HeidenhainTcpm, ShortestWaysAndReducedDisplays) {
  ControlSetup setup = free_five_axis_setup();
  for (kinematics::Axis& axis : setup.machine.axes) {
    if (axis.name == "C") axis.min = -100.0, axis.max = 100.0;
  }
  const NcRun run = klartext("L C+350 FMAX\nL C+10 FMAX M126\nM127\nM94 C\nL C+20 FMAX\n", setup);
  ASSERT_EQ(run.first_error(), "") << run.text();
  ASSERT_EQ(run.moves().size(), 3u);
  std::vector<double> turns;
  for (const NcMove& move : run.moves())
    turns.push_back(deg_from_rad((move.q_to - move.q_from).cwiseAbs().maxCoeff()));
  EXPECT_NEAR(turns[1], 20.0, 1e-9);
  EXPECT_NEAR(turns[2], 10.0, 1e-9);  // 370 is shown as 10
}

}  // namespace
}  // namespace swarf::program::heidenhain_planes_test
