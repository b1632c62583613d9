// PLANE AXIAL, MOVE DIST, MB, M114, M144, M116, reference points and tools described in the program.
#include <fmt/format.h>

#include "unit/program/heidenhain_support.h"

namespace swarf::program::heidenhain_axes_test {
namespace {

Mat3 about(int axis, double deg) {
  return Eigen::AngleAxisd(rad_from_deg(deg), Vec3::Unit(axis)).toRotationMatrix();
}

double value_of(const NcMove& move, const ControlSetup& setup, const char* name) {
  for (size_t i = 0; i < setup.machine.axes.size(); ++i) {
    if (setup.machine.axes[i].name == name) return deg_from_rad(move.q_to[static_cast<long>(i)]);
  }
  return std::nan("");
}

// Trunnion A, table C, values a and c: the tool's frame stands in the work as Rz(-c) Rx(-a) ... turned back
// by the table; so do the axes of the plane. The signs follow from the machine's own forward kinematics.
TEST(HeidenhainAxes, PlanesByTheirAxes) {
  const ControlSetup setup = free_five_axis_setup();
  for (const auto& [a, c] :
       {std::pair{-45.0, 0.0}, std::pair{-30.0, 90.0}, std::pair{20.0, -60.0}, std::pair{0.0, 45.0}}) {
    const NcRun run = klartext_clean(fmt::format("CYCL DEF 7.0 D\nCYCL DEF 7.1 X+3 Y-4 Z+5\nPLANE AXIAL "
                                                 "A{:+} C{:+} TURN FMAX\nL X+0 Y+0 Z+0 FMAX\n"
                                                 "L X+10 FMAX\nL Y+10 FMAX\nL Z+10 FMAX\n",
                                                 a, c),
                                     setup);
    ASSERT_GE(run.moves().size(), 4u);
    const size_t n = run.moves().size() - 4;
    const NcMove& at = run.moves()[n + 3];
    EXPECT_NEAR(value_of(at, setup, "A"), a, 1e-9);
    EXPECT_NEAR(value_of(at, setup, "C"), c, 1e-9);
    const Vec3 origin = run.moves()[n].to.tip_W;
    EXPECT_NEAR((origin - Vec3(3, -4, 5)).norm(), 0.0, 1e-9);
    // X of the plane is the X axis of the machine, Z the tool: only X moves for X, only Z for Z.
    for (int i = 0; i < 3; ++i) {
      const NcMove& move = run.moves()[n + 1 + static_cast<size_t>(i)];
      EXPECT_NEAR((move.to.tip_W - move.from.tip_W).norm(), 10.0, 1e-9);
      for (size_t k = 0; k < setup.machine.axes.size(); ++k) {
        const double way = move.q_to[static_cast<long>(k)] - move.q_from[static_cast<long>(k)];
        EXPECT_NEAR(way, setup.machine.axes[k].name == std::string(1, "XYZ"[i]) ? 10.0 : 0.0, 1e-8);
      }
    }
    EXPECT_NEAR(((at.to.tip_W - at.from.tip_W) / 10.0 - at.to.axis_W).norm(), 0.0, 1e-9);
  }
}

TEST(HeidenhainAxes, AxialAnglesAreModalAndIncremental) {
  const ControlSetup setup = free_five_axis_setup();
  const NcRun run = klartext_clean(
      "PLANE AXIAL A-40 TURN FMAX\nPLANE AXIAL C+30 TURN FMAX\nPLANE AXIAL IA+15 TURN FMAX\n", setup);
  ASSERT_EQ(run.moves().size(), 3u);
  EXPECT_NEAR(value_of(run.moves()[1], setup, "A"), -40.0, 1e-9);
  EXPECT_NEAR(value_of(run.moves()[1], setup, "C"), 30.0, 1e-9);
  EXPECT_NEAR(value_of(run.moves()[2], setup, "A"), -25.0, 1e-9);
}

// The point DIST ahead of the tip stands on the part in each piece, and the tool ends in the plane.
TEST(HeidenhainAxes, MoveTurnsAboutAPointAheadOfTheTip) {
  for (const double distance : {50.0, -20.0}) {
    const NcRun run = klartext_clean(
        fmt::format(
            "TOOL CALL 2 Z S1000\nL X+10 Y+20 Z+100 A+0 C+0 FMAX\nPLANE SPATIAL SPA+30 SPB+10 SPC+0 MOVE "
            "DIST{:+} F2000\n",
            distance),
        free_five_axis_setup());
    ASSERT_GE(run.moves().size(), 10u);
    const Vec3 centre = Vec3(10, 20, 100) - distance * Vec3::UnitZ();
    for (size_t i = 1; i < run.moves().size(); ++i) {
      const ToolPose& to = run.moves()[i].to;
      EXPECT_NEAR((to.tip_W - distance * to.axis_W - centre).norm(), 0.0, 1e-8);
    }
    EXPECT_NEAR((run.moves().back().to.axis_W - (about(1, 10) * about(0, 30)).col(2)).norm(), 0.0, 1e-9);
  }
}

TEST(HeidenhainAxes, RetractionBeforeTurning) {
  const NcRun run = klartext_clean(
      "TOOL CALL 2 Z S1000\nL X+10 Y+20 Z+100 A+0 C+0 FMAX\nPLANE SPATIAL SPA+30 SPB+0 SPC+0 MOVE MB40 "
      "FMAX\n",
      free_five_axis_setup());
  ASSERT_EQ(run.moves().size(), 3u);
  expect_tip(run.moves()[1], 10, 20, 140);
  EXPECT_NEAR((run.moves()[2].to.tip_W - run.moves()[1].to.tip_W).norm(), 0.0, 1e-9);
}

// A swivelling head: with M114 and M144 the tip ends where it is programmed, the way is that of the axes.
TEST(HeidenhainAxes, HeadsAreCompensated) {
  ControlSetup setup = three_axis_setup();
  setup.machine =
      kinematics::make_machine("head", {kinematics::make_axis("X", kinematics::Side::kHead, Vec3::UnitX()),
                                        kinematics::make_axis("Y", kinematics::Side::kHead, Vec3::UnitY()),
                                        kinematics::make_axis("Z", kinematics::Side::kHead, Vec3::UnitZ()),
                                        kinematics::make_axis("C", kinematics::Side::kHead, Vec3::UnitZ()),
                                        kinematics::make_axis("B", kinematics::Side::kHead, Vec3::UnitY())});
  setup.machine.gauge_M = Vec3::Zero();
  for (const std::string on : {"M114", "M144"}) {
    const NcRun run =
        klartext_clean("TOOL CALL 2 Z S1000\nL X+0 Y+0 Z+100 B+0 C+0 FMAX\n" + on +
                           "\nL X+10 Y+20 Z+50 B+30 C+40 F500\nL X+15 F500\nL X+0 Y+0 Z+100 B+0 C+0\n" +
                           (on == "M114" ? "M115" : "M145") + "\nL X+1 FMAX\n",
                       setup);
    ASSERT_EQ(run.moves().size(), 5u) << on;
    expect_tip(run.moves()[1], 10, 20, 50);
    EXPECT_NEAR((run.moves()[1].to.axis_W - (about(2, 40) * about(1, 30)).col(2)).norm(), 0.0, 1e-9);
    EXPECT_EQ(run.moves()[1].law, BlockLaw::kJoint);
    expect_tip(run.moves()[2], 15, 20, 50);
    expect_tip(run.moves()[4], 1, 0, 100);
  }
}

// M116: F is mm/min on the circle of the tip about the table's axis.
TEST(HeidenhainAxes, FeedOfRotaryTables) {
  const ControlSetup setup = free_five_axis_setup();
  const NcRun run = klartext_clean(
      "L X+30 Y+40 Z+50 A+0 C+0 FMAX\nM116\nL C+90 F600\nL X+0 Y+0 C+90 FMAX\nL X+50\nL C+0 IX+10 "
      "F600\nM117\nL C+90 "
      "F600\n",
      setup);
  ASSERT_EQ(run.moves().size(), 6u);
  EXPECT_NEAR(run.moves()[1].duration_s * 10.0, 0.5 * kPi * 50.0, 1e-6);
  EXPECT_NEAR(run.moves()[5].duration_s * 10.0, 90.0, 1e-9);
  // With a linear axis: the root of both ways' squares.
  EXPECT_NEAR(run.moves()[4].duration_s * 10.0, std::hypot(10.0, 0.5 * kPi * 50.0), 1e-6);
}

TEST(HeidenhainAxes, ToolsThatTheProgramDescribes) {
  const std::string contour = "TOOL CALL 2 Z S1000\nL X-30 FMAX\nL X+0 Y+0 RL F600\nL Y+30\nL X+30 R0\n";
  const NcRun same = klartext_clean("TOOL DEF 2 L+50 R+5\n" + contour);
  EXPECT_NEAR(same.moves()[1].to.tip_W.x(), -5.0, 1e-9);
  ControlSetup none = three_axis_setup();
  none.tools.clear();
  const NcRun run = klartext("TOOL DEF 2 L+0 R+7\n" + contour, none);
  ASSERT_EQ(run.first_error(), "") << run.text();
  EXPECT_NEAR(run.moves()[1].to.tip_W.x(), -7.0, 1e-9);
}

TEST(HeidenhainAxes, ReferencePointsOfSharpTools) {
  for (const char* point : {"TIP-TIP", "TIP-CENTER", "CENTER-CENTER"}) {
    const NcRun run = klartext_clean(
        fmt::format(
            "TOOL CALL 2 Z S1000\nFUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS REFPNT {}\nL X+10 Y+5 Z+20 A-20 "
            "C+30 F500\nFUNCTION RESET TCPM\n",
            point),
        free_five_axis_setup());
    expect_tip(run.moves().back(), 10, 5, 20);
  }
}

TEST(HeidenhainAxes, ReferencePointsOfRoundToolsAreRefused) {
  ControlSetup setup = free_five_axis_setup();
  setup.tools.push_back({9, "BALL", 50.0, 20.0, 10.0});
  const NcRun run =
      klartext("TOOL CALL 9 Z\nFUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS REFPNT CENTER-CENTER\n", setup);
  EXPECT_EQ(run.first_error(), "unsupported-word 3:44") << run.text();
}

}  // namespace
}  // namespace swarf::program::heidenhain_axes_test
