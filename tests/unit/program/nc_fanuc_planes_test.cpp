// Every way to give a tilted plane, in every orientation of a 5 degree grid: the plane's axes and origin as
// the forward kinematics of the machine give them.
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "unit/program/nc_support.h"

namespace swarf::program::nc_fanuc_planes_test {
namespace {

constexpr int kSteps = 72;
constexpr double kStepDeg = 5.0;
const Vec3 kOrigin(3, -4, 205), kPoint(7, -8, 9);
constexpr double kLength = 50.0;

/// The trunnion turns as far as a test wants.
ControlSetup free_setup() {
  ControlSetup setup = five_axis_setup();
  for (kinematics::Axis& axis : setup.machine.axes) {
    if (axis.kind == kinematics::AxisKind::kRotary) axis.min = -400 * kPi, axis.max = 400 * kPi;
  }
  return setup;
}

Mat3 about(int axis, double deg) {
  return Eigen::AngleAxisd(rad_from_deg(deg), Vec3::Unit(axis)).toRotationMatrix();
}

/// One plane: its blocks, and what they mean.
struct Plane {
  std::string blocks;
  Mat3 R;
};

/// All planes in one program: each is given, positioned to and left again.
void expect_planes(const std::vector<Plane>& planes, double tolerance,
                   const std::string& orient = "G53.1\n") {
  const ControlSetup setup = free_setup();
  std::string text = "T2 M06\nG43 H2\nG00 X0 Y0 Z400\n";
  std::map<int, size_t> plane_of_line;
  for (size_t i = 0; i < planes.size(); ++i) {
    text += planes[i].blocks + orient + "G00 X7 Y-8 Z9\n";
    plane_of_line[static_cast<int>(std::count(text.begin(), text.end(), '\n'))] = i;
    text += "G69\nG00 X0 Y0 Z400\n";
  }
  const NcRun run = run_text(text + "M30\n", Dialect::kFanuc, setup);
  ASSERT_EQ(run.first_error(), "") << run.text();
  size_t checked = 0;
  for (const NcMove& move : run.moves()) {
    const auto found = plane_of_line.find(move.line);
    if (found == plane_of_line.end()) continue;
    const Plane& plane = planes[found->second];
    const ToolPose pose =
        kinematics::forward_by_poses(kinematics::with_tool(setup.machine, kLength), move.q_to);
    ASSERT_LE((pose.axis_W - plane.R.col(2)).norm(), tolerance) << plane.blocks;
    ASSERT_LE((pose.tip_W - (kOrigin + plane.R * kPoint)).norm(), 30 * tolerance) << plane.blocks;
    ++checked;
  }
  ASSERT_EQ(checked, planes.size());
}

template <class Make>
std::vector<Plane> grid(Make make) {
  std::vector<Plane> planes;
  for (int first = 0; first < kSteps; ++first) {
    for (int second = 0; second < kSteps; ++second)
      planes.push_back(make(kStepDeg * first, kStepDeg * second, first * kSteps + second));
  }
  return planes;
}

const std::string kXyz = "X3 Y-4 Z205";

/// Roll, pitch and yaw turn about axes that stand: the last rotation stands on the left.
TEST(NcFanucPlanes, RollPitchYawGridInAllOrders) {
  const int orders[] = {123, 132, 213, 231, 312, 321};
  expect_planes(
      grid([&](double a, double b, int n) {
        const int q = orders[n % 6];
        double angle[3] = {};
        angle[q / 100 - 1] = a;
        angle[q / 10 % 10 - 1] = b;
        angle[q % 10 - 1] = kStepDeg * (n % 71);
        const Mat3 R =
            about(q % 10 - 1, kStepDeg * (n % 71)) * about(q / 10 % 10 - 1, b) * about(q / 100 - 1, a);
        return Plane{fmt::format("G68.2 P1 Q{} {} I{} J{} K{}\n", q, kXyz, angle[0], angle[1], angle[2]), R};
      }),
      1e-12);
}

Mat3 euler(double a, double b, double c) {
  return about(2, a) * about(0, b) * about(2, c);
}

std::string xyz(const Vec3& p) {
  return fmt::format("X{:.12f} Y{:.12f} Z{:.12f}", p.x(), p.y(), p.z());
}
std::string ijk(const Vec3& v) {
  return fmt::format("I{:.12f} J{:.12f} K{:.12f}", v.x(), v.y(), v.z());
}

TEST(NcFanucPlanes, ThreePointsGrid) {
  expect_planes(grid([&](double a, double b, int n) {
                  const double c = kStepDeg * (n % 71), turn = n % 3 == 0 ? 30.0 : 0.0;
                  const Mat3 R = euler(a, b, c);
                  return Plane{
                      (n % 3 == 0 ? "G68.2 P2 Q0 X0 Y0 Z0 R30\n" : "") +
                          fmt::format("G68.2 P2 Q1 {}\nG68.2 P2 Q2 {}\nG68.2 P2 Q3 {}\n", kXyz,
                                      xyz(kOrigin + R * Vec3(20, 0, 0)), xyz(kOrigin + R * Vec3(-7, 15, 0))),
                      R * about(2, turn)};
                }),
                1e-11);
}

TEST(NcFanucPlanes, TwoVectorsGrid) {
  expect_planes(
      grid([&](double a, double b, int n) {
        const Mat3 R = euler(a, b, kStepDeg * (n % 71));
        return Plane{
            fmt::format("G68.2 P3 Q1 {} {}\nG68.2 P3 Q2 {}\n", kXyz, ijk(R.col(0)), ijk(2.0 * R.col(2))), R};
      }),
      1e-11);
}

/// A plane on a plane: turned about the first one's own axes, its origin counted in them.
TEST(NcFanucPlanes, IncrementalGrid) {
  expect_planes(grid([&](double a, double b, int n) {
                  const Mat3 first = euler(20, 30, 10);
                  const Vec3 from = kOrigin - first * Vec3(1, 2, 3);
                  const double c = kStepDeg * (n % 71);
                  return Plane{
                      fmt::format("G68.2 {} I20 J30 K10\nG68.4 X1 Y2 Z3 I{} J{} K{}\n", xyz(from), a, b, c),
                      first * euler(a, b, c)};
                }),
                1e-11);
}

/// G68.3 lays the plane across the tool as it stands: X is horizontal, at the pole the work's own.
TEST(NcFanucPlanes, ByTheToolAxisGrid) {
  const ControlSetup setup = free_setup();
  const kinematics::MachineModel machine = kinematics::with_tool(setup.machine, kLength);
  std::vector<Plane> planes;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double a = kStepDeg * i, c = kStepDeg * j, turn = (i + j) % 2 == 0 ? 0.0 : 15.0;
      if (i == kSteps / 2) continue;  // head down: refused below
      AxisValues q = AxisValues::Zero();
      for (size_t k = 0; k < machine.axes.size(); ++k) {
        if (machine.axes[k].name == "A") q[static_cast<long>(k)] = rad_from_deg(a);
        if (machine.axes[k].name == "C") q[static_cast<long>(k)] = rad_from_deg(c);
      }
      const Vec3 z = kinematics::forward_by_poses(machine, q).axis_W;
      Mat3 R = Mat3::Identity();
      if (i != 0) {
        const Vec3 x = Vec3(-z.y(), z.x(), 0.0).normalized();
        R << x, z.cross(x), z;
      }
      planes.push_back({fmt::format("G00 A{} C{}\nG68.3 {} R{}\n", a, c, kXyz, turn), R * about(2, turn)});
    }
  }
  expect_planes(planes, 1e-11, "");
  const NcRun down = run_text("T2 M06\nG43 H2 G00 A180\nG68.3 X0 Y0 Z0\nM30\n", Dialect::kFanuc, setup);
  EXPECT_EQ(down.first_error(), "bad-plane 3:1");
}

/// G53.6 turns about the tip, with the length of H where none is compensated.
TEST(NcFanucPlanes, TheTipStands) {
  const ControlSetup setup = free_setup();
  for (const bool compensated : {true, false}) {
    std::string text = std::string("T2 M06\n") + (compensated ? "G43 H2\n" : "") + "G00 X5 Y6 Z400\n";
    std::map<int, Mat3> planes;
    for (int i = 0; i < kSteps; ++i) {
      const double a = kStepDeg * i, b = kStepDeg * ((7 * i) % kSteps);
      text +=
          fmt::format("G68.2 {} I{} J{} K0\nG53.6{}\n", kXyz, a, b, compensated && i % 2 == 0 ? "" : " H2");
      planes[static_cast<int>(std::count(text.begin(), text.end(), '\n'))] = euler(a, b, 0);
      text += "G69\n";
    }
    const NcRun run = run_text(text + "M30\n", Dialect::kFanuc, setup);
    ASSERT_EQ(run.first_error(), "") << run.text();
    size_t turned = 0;
    const kinematics::MachineModel machine = kinematics::with_tool(setup.machine, kLength);
    for (const NcMove& move : run.moves()) {
      if (planes.find(move.line) == planes.end()) continue;
      ++turned;
      const ToolPose before = kinematics::forward_by_poses(machine, move.q_from);
      const ToolPose after = kinematics::forward_by_poses(machine, move.q_to);
      ASSERT_LE((after.tip_W - before.tip_W).norm(), 1e-9) << move.line;
      ASSERT_LE((after.axis_W - planes.at(move.line).col(2)).norm(), 1e-12) << move.line;
      ASSERT_EQ(move.law, BlockLaw::kTcpAxes);
    }
    EXPECT_GE(turned, planes.size() - 2);
  }
}

TEST(NcFanucPlanes, G69InOneBlockWithAMove) {
  const NcRun run = run_text("G68 X0 Y0 R90\nG00 X10\nG69 X20\nM30\n", Dialect::kFanuc, three_axis_setup());
  ASSERT_EQ(run.text(), "");
  expect_tip(run.moves()[0], 0, 10, 0);
  expect_tip(run.moves()[1], 20, 10, 0);
}

/// TCP in a tilted plane: vectors and coordinates count in the plane, and G49 leaves the plane as it is.
TEST(NcFanucPlanes, TcpWithinAPlane) {
  const ControlSetup setup = free_setup();
  const NcRun run =
      run_text(fmt::format("T2 M06\nG43 H2 G00 Z400\nG68.2 {} I20 J30 K10\nG53.1\nG43.5 H2\n"
                           "G01 X1 Y2 Z3 I0 J0 K1 F500\nX4 I0.6 K0.8\nG49\nG43 H2\nG00 Z20\nG69\nM30\n",
                           kXyz),
               Dialect::kFanuc, setup);
  ASSERT_EQ(run.text(), "");
  const Mat3 R = euler(20, 30, 10);
  const size_t n = run.moves().size();
  EXPECT_LE((run.moves()[n - 2].to.tip_W - (kOrigin + R * Vec3(4, 2, 3))).norm(), 1e-9);
  EXPECT_LE((run.moves()[n - 2].to.axis_W - R * Vec3(0.6, 0, 0.8)).norm(), 1e-12);
  EXPECT_EQ(run.moves()[n - 2].law, BlockLaw::kTcp);
}

}  // namespace
}  // namespace swarf::program::nc_fanuc_planes_test
