// Tilted planes in every orientation of a 5 degree grid, 72 x 72: reached exactly, or refused with the
// degrees that are missing. The plane's normal is Rz(first) R(second) z, so that its angle to Z is the second
// angle's distance to whole turns, and whether a machine can stand there is known without any inverse.
#include <fmt/format.h>

#include <cmath>

#include "unit/program/nc_support.h"
#include "unit/program/siemens_support.h"

namespace swarf::program::nc_tilted_plane_test {
namespace {

constexpr int kSteps = 72;
constexpr double kStepDeg = 5.0;
const Vec3 kOrigin(3, -4, 205), kPoint(7, -8, 9);

Mat3 about(const Vec3& axis, double deg) {
  return Eigen::AngleAxisd(rad_from_deg(deg), axis).toRotationMatrix();
}

/// Angle between the plane's normal and Z.
double tilt_deg(int second) {
  return std::min(second, kSteps - second) * kStepDeg;
}

struct Case {
  std::string text;  ///< the program, ready to paste
  Mat3 R;            ///< the plane's axes in W
  double tilt;
};

/// The last move ends in the plane with the tool along its normal.
void expect_reached(const Case& one, const ControlSetup& setup, const NcMove& last, double length_mm) {
  ASSERT_TRUE(last.q_to.allFinite()) << one.text;
  const ToolPose pose =
      kinematics::forward_by_poses(kinematics::with_tool(setup.machine, length_mm), last.q_to);
  ASSERT_LE((pose.axis_W - one.R.col(2)).norm(), 1e-12) << one.text;
  ASSERT_LE((pose.tip_W - (kOrigin + one.R * kPoint)).norm(), 1e-9) << one.text;
  ASSERT_LE((last.to.axis_W - pose.axis_W).norm(), 1e-12) << one.text;
}

/// Refused at the place, and the message says how many degrees are missing.
void expect_refused(const Case& one, const NcRun& run, const std::string& error, double missing_deg) {
  ASSERT_EQ(run.first_error(), error) << one.text << run.text();
  ASSERT_NE(run.text().find(fmt::format("{:.4g} deg are missing", missing_deg)), std::string::npos)
      << one.text << run.text();
}

Case fanuc_case(int first, int second) {
  const double i = kStepDeg * first, j = kStepDeg * second, k = kStepDeg * ((first + 7 * second) % kSteps);
  return {fmt::format("T2 M06\nG43 H2\nG00 X0 Y0 Z400\nG68.2 X3 Y-4 Z205 I{} J{} K{}\nG53.1\nG00 X7 Y-8 Z9\n"
                      "G69\nM30\n",
                      i, j, k),
          about(Vec3::UnitZ(), i) * about(Vec3::UnitX(), j) * about(Vec3::UnitZ(), k), tilt_deg(second)};
}

/// `reach_deg`: of the tool axis to Z.
void fanuc_grid(const kinematics::MachineModel& machine, double reach_deg) {
  ControlSetup setup = five_axis_setup();
  setup.machine = machine;
  for (int first = 0; first < kSteps; ++first) {
    for (int second = 0; second < kSteps; ++second) {
      const Case one = fanuc_case(first, second);
      const NcRun run = run_text(one.text, Dialect::kFanuc, setup);
      if (one.tilt > reach_deg) {
        expect_refused(one, run, "unreachable-orientation 5:1", one.tilt - reach_deg);
      } else {
        ASSERT_EQ(run.text(), "") << one.text;
        expect_reached(one, setup, run.moves().back(), 50.0);
      }
      if (testing::Test::HasFatalFailure()) return;
    }
  }
}

TEST(NcTiltedPlane, FanucGridOnTableTable) {
  fanuc_grid(five_axis_machine(), 120.0);  // A reaches +-120 degrees
}

/// No travel helps a nutating axis beyond the horizon.
TEST(NcTiltedPlane, FanucGridOnNutatingHead) {
  kinematics::MachineModel machine = kinematics::nutating_head();
  machine.X_MW = Pose::Identity();
  machine.gauge_M = Vec3(0.0, 0.0, 50.0);
  for (kinematics::Axis& axis : machine.axes) {
    if (axis.kind == kinematics::AxisKind::kRotary) axis.min = -4.0 * kPi, axis.max = 4.0 * kPi;
  }
  fanuc_grid(machine, 90.0);
}

NcRun run_siemens(const std::string& text, const ControlSetup& setup) {
  return run_text(text, Dialect::kSiemens, setup);
}

/// CYCLE800, turns Z Y X: B reaches +-100 degrees, and _DIR chooses its sign.
TEST(NcTiltedPlane, SiemensSwivelGrid) {
  const ControlSetup setup = nc::siemens::setup_of(nc::siemens::spinner());
  for (int first = 0; first < kSteps; ++first) {
    for (int second = 0; second < kSteps; ++second) {
      const int direction = (first + second) % 2 == 0 ? 1 : -1;
      const double i = kStepDeg * first, j = kStepDeg * second;
      const Case plane = {
          fmt::format(
              "T=\"MILL10\" M6\nCYCLE800(0,\"TC1\",0,27,3,-4,205,{},{},0,0,0,0,{},0,1)\nG0 X7 Y-8 Z9\nM30\n",
              i, j, direction),
          about(Vec3::UnitZ(), i) * about(Vec3::UnitY(), j), tilt_deg(second)};
      const NcRun run = run_siemens(plane.text, setup);
      if (plane.tilt > 100.0) {
        expect_refused(plane, run, "unreachable-orientation 2:1", plane.tilt - 100.0);
      } else {
        ASSERT_EQ(run.text(), "") << plane.text;
        expect_reached(plane, setup, run.moves().back(), 120.0);
        ASSERT_NEAR(deg_from_rad(run.moves().back().q_to[3]), direction * plane.tilt, 1e-6) << plane.text;
      }
      if (HasFatalFailure()) return;
    }
  }
}

/// ROT and a tool vector along its Z under TRAORI: what lies outside the travel is a finding of the run, the
/// interpreter keeps the orientation.
TEST(NcTiltedPlane, SiemensRotGrid) {
  const ControlSetup setup = nc::siemens::setup_of(nc::siemens::spinner());
  for (int first = 0; first < kSteps; ++first) {
    for (int second = 0; second < kSteps; ++second) {
      const double i = kStepDeg * first, j = kStepDeg * second;
      const Case plane = {fmt::format("T=\"MILL10\" M6\nTRAORI\nORIWKS\nTRANS X3 Y-4 Z205\nAROT Y{} Z{}\n"
                                      "G0 X7 Y-8 Z9 A3=0 B3=0 C3=1\nM30\n",
                                      j, i),
                          about(Vec3::UnitZ(), i) * about(Vec3::UnitY(), j), tilt_deg(second)};
      const NcRun run = run_siemens(plane.text, setup);
      ASSERT_EQ(run.first_error(), "") << plane.text << run.text();
      expect_reached(plane, setup, run.moves().back(), 120.0);
      if (HasFatalFailure()) return;
    }
  }
}

/// Straight up from anywhere: the free rotary axis stands still.
TEST(NcTiltedPlane, AtThePoleTheFreeAxisStands) {
  const NcRun run =
      run_text("T2 M06\nG43 H2\nG00 X0 Y0 Z400 A0 C77\nG68.2 X0 Y0 Z0 I0 J0 K0\nG53.1\nG00 Z1\nG69\nM30\n",
               Dialect::kFanuc, five_axis_setup());
  ASSERT_EQ(run.text(), "");
  EXPECT_NEAR(deg_from_rad(run.moves().back().q_to[1]), 77.0, 1e-12);
}

}  // namespace
}  // namespace swarf::program::nc_tilted_plane_test
