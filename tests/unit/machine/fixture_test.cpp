// Fixtures: closed solids where the stock and the table are, their volumes in closed form.
#include "machine/fixture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/units.h"
#include "mesh/mesh_check.h"
#include "mesh/mesh_ops.h"
#include "mesh/plain_solids.h"

namespace swarf::machine {
namespace {

/// A stock of 80 x 50 x 20 whose lower face stands 60 mm above the table, turned by 30 deg.
HeldWork work() {
  HeldWork held{{{-10.0, 5.0, -20.0}, {70.0, 55.0, 0.0}}, Pose::Identity(), {3.0, -4.0, 100.0}};
  held.X_MW.linear() = Eigen::AngleAxisd(rad_from_deg(30.0), Vec3::UnitZ()).toRotationMatrix();
  held.X_MW.translation() = Vec3(12.0, 7.0, 180.0);
  return held;
}

TriMesh made(const Fixture& fixture, const HeldWork& held = work()) {
  Diagnostics diagnostics;
  TriMesh mesh = fixture_mesh(fixture, held, diagnostics);
  EXPECT_TRUE(diagnostics.list().empty());
  EXPECT_EQ(mesh::check_closed(mesh), "");
  return mesh;
}

/// As seen from the work.
Box bounds_W(const TriMesh& mesh, const HeldWork& held = work()) {
  return mesh::bounds(mesh::moved(mesh, held.X_MW.inverse()));
}

void expect_box(const Box& box, const Vec3& lower, const Vec3& upper) {
  EXPECT_LT((box.lower - lower).norm(), 1e-3) << box.lower.transpose();
  EXPECT_LT((box.upper - upper).norm(), 1e-3) << box.upper.transpose();
}

std::string complaint(const Fixture& fixture, const HeldWork& held) {
  Diagnostics diagnostics;
  EXPECT_TRUE(fixture_mesh(fixture, held, diagnostics).triangles.empty());
  return diagnostics.list().empty() ? "" : diagnostics.list().front().code;
}

TEST(Fixture, AViceGripsTheStockAndStandsOnTheTable) {
  Fixture fixture{"vice", Vice{.along_y = true, .grip_mm = 6.0}};
  const TriMesh mesh = made(fixture);
  // Bed 80 x (50 + 2 50) x 60, jaws 80 x 20 x 6 each.
  EXPECT_NEAR(mesh::enclosed_volume(mesh), 80.0 * 150.0 * 60.0 + 2.0 * 80.0 * 20.0 * 6.0, 1.0);
  expect_box(bounds_W(mesh), {-10.0, -45.0, -80.0}, {70.0, 105.0, -14.0});

  fixture.shape = Vice{.along_y = false, .grip_mm = 6.0, .jaw_width_mm = 100.0, .jaw_thickness_mm = 10.0};
  expect_box(bounds_W(made(fixture)), {-50.0, -20.0, -80.0}, {110.0, 80.0, -14.0});
}

TEST(Fixture, ClampsPressOnTheStocksUpperFace) {
  const Fixture fixture{"clamps", Clamps{.sides = {"y+"}, .reach_mm = 8.0, .margin_mm = 40.0}};
  const TriMesh mesh = made(fixture);
  EXPECT_NEAR(mesh::enclosed_volume(mesh), 160.0 * 130.0 * 60.0 + 43.0 * 20.0 * 12.0 + 14.0 * 16.0 * 20.0,
              1.0);
  expect_box(bounds_W(mesh), {-50.0, -35.0, -80.0}, {110.0, 95.0, 12.0});
}

TEST(Fixture, AChuckClosesOnARoundStock) {
  HeldWork held = work();
  held.stock_W = {{-20.0, -20.0, -40.0}, {20.0, 20.0, 0.0}};
  const Fixture fixture{"chuck", Chuck{.diameter_mm = 120.0, .grip_mm = 9.0}};
  const TriMesh mesh = made(fixture, held);
  const double body = std::numbers::pi * 60.0 * 60.0 * 40.0, jaws = 3.0 * 40.0 * 20.0 * 9.0;
  const double volume = mesh::enclosed_volume(mesh);
  EXPECT_GE(volume, body + jaws - 1.0);  // its prism stands around the cylinder
  EXPECT_LE(volume, body * std::pow(1.0 + 0.05 / 60.0, 2.0) + jaws);
  EXPECT_NEAR(bounds_W(mesh, held).upper.z(), -31.0, 1e-3);
  EXPECT_EQ(complaint(fixture, work()), "bad-fixture");  // 80 x 50: what is it to close on?
  EXPECT_EQ(complaint({"chuck", Chuck{.diameter_mm = 120.0, .grip_diameter_mm = 130.0}}, work()),
            "bad-fixture");
}

TEST(Fixture, SolidsStandInTheFrameThatIsSaid) {
  Fixture fixture{"stop", FixtureSolid{}};
  mesh::add_box(std::get<FixtureSolid>(fixture.shape).mesh, {{0.0, 0.0, 0.0}, {10.0, 20.0, 30.0}});
  fixture.position_mm = Vec3(1.0, 2.0, 3.0);
  fixture.rotation_rad = Vec3(0.0, 0.0, rad_from_deg(90.0));
  expect_box(mesh::bounds(made(fixture)), {-16.0, -2.0, 103.0}, {4.0, 8.0, 133.0});
  fixture.on_part = true;
  expect_box(bounds_W(made(fixture)), {-19.0, 2.0, 3.0}, {1.0, 12.0, 33.0});

  const Fixture stone{"stone", Tombstone{{100.0, 80.0, 250.0}, 25.0}};
  const TriMesh mesh = made(stone);
  EXPECT_NEAR(mesh::enclosed_volume(mesh), 180.0 * 160.0 * 25.0 + 100.0 * 80.0 * 225.0, 1.0);
  expect_box(mesh::bounds(mesh), {-87.0, -84.0, 100.0}, {93.0, 76.0, 350.0});
}

TEST(Fixture, WithoutRoomUnderTheStockThereIsNone) {
  HeldWork held = work();
  held.X_MW.translation().z() = 121.0;  // 1 mm above the table
  EXPECT_EQ(complaint({"vice", Vice{}}, held), "no-room-for-fixture");
  EXPECT_EQ(complaint({"clamps", Clamps{}}, held), "no-room-for-fixture");
  held.X_MW.translation().z() = 90.0;  // below it
  EXPECT_EQ(complaint({"vice", Vice{}}, held), "no-room-for-fixture");
}

TEST(Fixture, ItRidesOnTheLinkThatCarriesTheWork) {
  MachineScene machine = load_machine(SWARF_SOURCE_DIR "/assets/machines/mill_3axis/machine.toml");
  const size_t before = machine.links.size();
  const Fixture fixture{"vice", Vice{}};
  add_fixture(machine, fixture, made(fixture));
  ASSERT_EQ(machine.links.size(), before + 1);
  EXPECT_TRUE(machine.links.back().fixture);
  EXPECT_EQ(machine.links.back().parent, machine.work_link);
  kinematics::AxisValues q = kinematics::AxisValues::Zero();
  q[0] = 33.0;
  const std::vector<Pose> poses = link_poses(machine, q);
  EXPECT_EQ(poses.back().matrix(), poses[static_cast<size_t>(machine.work_link)].matrix());
}

}  // namespace
}  // namespace swarf::machine
