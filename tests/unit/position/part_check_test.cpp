// Borders, gaps and inverted meshes, against planted ones and their sound twins.
#include <gtest/gtest.h>

#include "brute_force.h"
#include "position/mesh_target.h"
#include "position/part_check.h"

namespace swarf::position {
namespace {

ToolProfile ball_10() {
  return ToolProfile(cutters_under_test()[1].cutter);
}

/// Two sheets of 20 x 20 mm in squares of 2 mm, side by side along x, `gap` mm apart; as an STL file has
/// them.
TriMesh two_sheets(double gap) {
  TriMesh mesh;
  for (const double start : {-20.0 - 0.5 * gap, 0.5 * gap})
    for (int i = 0; i < 10; ++i)
      for (int j = 0; j < 10; ++j) {
        const double x = start + 2.0 * i, y = 2.0 * j - 10.0;
        add_triangle(mesh, {x, y, 0}, {x + 2, y, 0}, {x + 2, y + 2, 0});
        add_triangle(mesh, {x, y, 0}, {x + 2, y + 2, 0}, {x, y + 2, 0});
      }
  return mesh;
}

TEST(PartCheck, CrackBetweenSheets) {
  const GapReport report = gaps(Borders(two_sheets(0.5)), 10.0);
  EXPECT_EQ(report.edges, 20U);
  EXPECT_EQ(report.lone_edges, 60U);
  EXPECT_NEAR(report.widest.width_mm, 0.5, 1e-6);
  EXPECT_NEAR(std::abs(report.widest.at.x()), 0.25, 1e-6);
  const GapReport sound = gaps(Borders(two_sheets(0.0)), 10.0);
  EXPECT_EQ(sound.edges, 0U);
  EXPECT_EQ(sound.lone_edges, 60U);
}

// The tip over the middle of the crack sinks by w(g/2), and the rest says that it is a border that holds it.
TEST(PartCheck, ToolSinksIntoTheCrack) {
  const TriMesh mesh = two_sheets(0.5);
  const MeshTarget target(mesh);
  const Borders borders(mesh);
  const ToolProfile ball = ball_10();
  Rest over, beside;
  int near = -1;
  target.raise(ball, upright(0.0, 1.3), over, near);
  EXPECT_NEAR(over.height, -sinks_into(ball, 0.5), 1e-12);
  EXPECT_TRUE(borders.on_border(over));
  target.raise(ball, upright(1.1, 1.3), beside, near);
  EXPECT_DOUBLE_EQ(beside.height, 0.0);
  EXPECT_FALSE(borders.on_border(beside));
}

Diagnostics check(const TriMesh& mesh, double sink_mm) {
  Diagnostics found;
  check_part(mesh, "part.stl", ball_10(), sink_mm, found);
  return found;
}
bool has(const Diagnostics& found, const std::string& code) {
  return std::any_of(found.list().begin(), found.list().end(),
                     [&](const Diagnostic& d) { return d.code == code; });
}

TEST(PartCheck, GapsByWhatTheToolSinks) {
  const double sink = 5.0 - std::sqrt(25.0 - 0.25 * 0.25);
  EXPECT_TRUE(has(check(two_sheets(0.5), 0.99 * sink), "part-gap-wide"));
  EXPECT_TRUE(has(check(two_sheets(0.5), 1.01 * sink), "part-gap"));
  EXPECT_FALSE(check(two_sheets(0.5), 1.01 * sink).has_errors());
  EXPECT_FALSE(has(check(two_sheets(0.0), 0.0), "part-gap"));
  EXPECT_TRUE(has(check(two_sheets(0.0), 0.0), "part-ends"));
  EXPECT_FALSE(has(check(two_sheets(11.0), 0.0), "part-gap-wide"));  // beyond the cutter: told as ends
}

TEST(PartCheck, HoleInASheet) {
  TriMesh mesh = height_field(20, 40.0, [](double, double) { return 0.0; });
  const size_t square = 2 * (10 * 20 + 10);
  mesh.triangles.erase(mesh.triangles.begin() + square, mesh.triangles.begin() + square + 2);
  const GapReport report = gaps(Borders(mesh), 10.0);
  EXPECT_EQ(report.edges, 4U);
  EXPECT_EQ(report.lone_edges, 80U);
  EXPECT_GE(report.widest.width_mm, 1.0);
  EXPECT_LE(report.widest.width_mm, 2.0);
}

TriMesh tetrahedron(bool turned) {
  TriMesh mesh;
  mesh.positions = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {0, 0, 10}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  if (turned)
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TEST(PartCheck, ClosedAndInverted) {
  EXPECT_TRUE(Borders(tetrahedron(false)).closed());
  EXPECT_TRUE(check(tetrahedron(false), 0.0).list().empty());
  EXPECT_TRUE(has(check(tetrahedron(true), 0.0), "mesh-inverted"));
  EXPECT_TRUE(has(check(TriMesh{}, 0.0), "mesh-empty"));
}

// Whichever way the facets are turned the tool rests on the same place.
TEST(PartCheck, InvertedStopsAllTheSame) {
  const ToolProfile ball = ball_10();
  for (double x = -4.0; x < 14.0; x += 0.7) {
    Rest right, turned;
    int near = -1;
    MeshTarget(tetrahedron(false)).raise(ball, upright(x, 2.0), right, near);
    near = -1;
    MeshTarget(tetrahedron(true)).raise(ball, upright(x, 2.0), turned, near);
    EXPECT_NEAR(right.height, turned.height, 1e-12);
  }
}

}  // namespace
}  // namespace swarf::position
