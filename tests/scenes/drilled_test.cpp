// Plates with drilled holes: what is told beside a hole is the hole's own, at any pitch.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mesh/mesh_io.h"
#include "support/program_run.h"
#include "support/solids.h"

namespace drilled_test {
namespace {

using swarf::TriMesh;
using swarf::Vec3;

constexpr int kSides = 48;
constexpr double kRadius = 3.4, kCell = 8.0, kTop = 0.0, kBottom = -20.0;

/// A side of the plate around one hole, up or down: the ring's segments fan out to the corners of a square.
void add_ring(TriMesh& mesh, double x, double z, bool up) {
  const auto at = [&](int k) {
    const double angle = 2.0 * M_PI * (k % kSides) / kSides;
    return Vec3(x + kRadius * std::cos(angle), kRadius * std::sin(angle), z);
  };
  const auto corner = [&](int q) {
    const double angle = M_PI * (0.25 + 0.5 * q);
    return Vec3(x + kCell * std::copysign(1.0, std::cos(angle)), kCell * std::copysign(1.0, std::sin(angle)),
                z);
  };
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    if (up)
      swarf::test::add_triangle(mesh, a, b, c);
    else
      swarf::test::add_triangle(mesh, a, c, b);
  };
  constexpr int kQuarter = kSides / 4;
  for (int k = 0; k < kSides; ++k) add(at(k), corner(k / kQuarter), at(k + 1));
  for (int q = 0; q < 4; ++q) add(at(q * kQuarter), corner(q + 3), corner(q));
}

/// A row of squares 16 mm wide, each with a polygon of 48 sides through it.
TriMesh drilled_plate(int holes) {
  TriMesh mesh;
  const auto wall = [&](const Vec3& a, const Vec3& b) {
    swarf::test::add_quad(mesh, {a.x(), a.y(), kBottom}, {b.x(), b.y(), kBottom}, {b.x(), b.y(), kTop},
                          {a.x(), a.y(), kTop});
  };
  for (int n = 0; n < holes; ++n) {
    const double x = 2.0 * kCell * n;
    add_ring(mesh, x, kTop, true);
    add_ring(mesh, x, kBottom, false);
    for (int k = 0; k < kSides; ++k) {
      const auto at = [&](int i) {
        const double angle = 2.0 * M_PI * (i % kSides) / kSides;
        return Vec3(x + kRadius * std::cos(angle), kRadius * std::sin(angle), 0.0);
      };
      wall(at(k + 1), at(k));
    }
    wall({x - kCell, -kCell, 0}, {x + kCell, -kCell, 0});
    wall({x + kCell, kCell, 0}, {x - kCell, kCell, 0});
  }
  wall({-kCell, kCell, 0}, {-kCell, -kCell, 0});
  wall({2.0 * kCell * (holes - 1) + kCell, -kCell, 0}, {2.0 * kCell * (holes - 1) + kCell, kCell, 0});
  return mesh;
}

class Drilled : public testing::TestWithParam<std::pair<int, double>> {};

TEST_P(Drilled, APlateHasTheGougeOfItsFacets) {
  const auto [holes, pitch] = GetParam();
  const std::filesystem::path folder = swarf::test::fresh_folder(
      "drilled_" + std::to_string(holes) + "_" + std::to_string(static_cast<int>(10 * pitch)));
  swarf::mesh::save_mesh((folder / "plate.stl").string(), drilled_plate(holes));
  std::ofstream nc(folder / "d.nc");
  nc << "%\nO1\nG21 G90 G94 G17 G54\nT1 M6\nS3000 M3\nG0 X0 Y0\nG43 H1 Z5\nG98 G83 X0. Y0. Z-23. R2. Q5. "
        "F350.\n";
  for (int n = 1; n < holes; ++n) nc << "X" << 16 * n << ". Y0.\n";
  nc << "G80\nG0 Z50\nM5\nM30\n%\n";
  nc.close();
  std::ofstream(folder / "scene.toml")
      << "nc = \"d.nc\"\ntools = \"T1=drill6.8\"\nstock.box_mm = [[-8, -8, -20], [" << 16 * holes - 8
      << ", 8, 0]]\nstock.voxel_mm = 0.4\n"
      << "setup.work_origin_mm = \"on_table\"\n[design]\nmesh = \"plate.stl\"\npitch_mm = " << pitch
      << "\n[accept]\ngouge_max_um = 9.28\nexcess_max_um = 10\n";
  const auto run =
      swarf::test::run_command(std::string(SWARF_PROGRAM) + " run " + (folder / "scene.toml").string() +
                               " --no-render -o " + (folder / "out").string());
  EXPECT_EQ(run.exit_code, 0) << run.output;
  const auto metrics = nlohmann::json::parse(swarf::test::read_text(folder / "out/metrics.json"));
  const double truth = 1e3 * kRadius * (1.0 - std::cos(M_PI / kSides));  // 7.28 um
  EXPECT_NEAR(metrics["surface"]["gouge_max_um"].get<double>(), truth, 0.05);
  EXPECT_GE(metrics["surface"]["gouge_bound_um"].get<double>(), truth - 0.01);
}

INSTANTIATE_TEST_SUITE_P(Plates, Drilled,
                         testing::Values(std::pair{1, 1.0}, std::pair{2, 0.2}, std::pair{2, 2.0},
                                         std::pair{4, 0.5}, std::pair{8, 1.0}));

}  // namespace
}  // namespace drilled_test
