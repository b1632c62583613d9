// Meshes made for pictures: closed, wound outwards, true to size; the fan: thinned, on the paths.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/units.h"
#include "mesh/mesh_ops.h"
#include "render/figures/axis_fan.h"
#include "render/figures/figure_mesh.h"
#include "render/figures/tool_mesh.h"

namespace swarf::render::figures_mesh {
namespace {

using Key = std::array<float, 3>;

Vec3 at(const TriMesh& mesh, uint32_t v) {
  const auto& p = mesh.positions[v];
  return {p[0], p[1], p[2]};
}

double volume(const TriMesh& mesh) {
  double six = 0;
  for (const auto& t : mesh.triangles) six += at(mesh, t[0]).dot(at(mesh, t[1]).cross(at(mesh, t[2])));
  return six / 6;
}

/// Edges by position, since creases split vertices: each must run once each way.
bool closed(const TriMesh& mesh) {
  std::map<std::pair<Key, Key>, int> edges;
  for (const auto& t : mesh.triangles) {
    for (size_t k = 0; k < 3; ++k) ++edges[{mesh.positions[t[k]], mesh.positions[t[(k + 1) % 3]]}];
  }
  return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
    const auto partner = edges.find({edge.first.second, edge.first.first});
    return edge.second == 1 && partner != edges.end();
  });
}

/// Normals lie on the outer side of their triangles.
bool normals_face_outwards(const TriMesh& mesh) {
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& t) {
    const Vec3 face = (at(mesh, t[1]) - at(mesh, t[0])).cross(at(mesh, t[2]) - at(mesh, t[0]));
    return std::all_of(t.begin(), t.end(), [&](uint32_t v) {
      const auto& n = mesh.normals[v];
      return face.dot(Vec3(n[0], n[1], n[2])) > 0.0;
    });
  });
}

TEST(FigureMesh, CylinderIsClosedAndHasTheVolumeOfItsPolygon) {
  const TriMesh mesh = cylinder_mesh(20, 30, 1, 96);
  EXPECT_TRUE(closed(mesh));
  EXPECT_TRUE(normals_face_outwards(mesh));
  // Full polygon prism plus two frusta of the bevels: area factor n/2 sin(2 pi/n) in place of pi.
  const double factor = 48 * std::sin(2 * kPi / 96);
  const double expected = factor * (100.0 * 28 + 2 * (100 + 90 + 81) / 3.0);
  EXPECT_NEAR(volume(mesh), expected, 1e-5 * expected);
}

/// Greatest radius of the mesh within a span of heights.
double reach(const TriMesh& mesh, double low, double high) {
  double greatest = 0;
  for (const auto& p : mesh.positions) {
    if (p[2] >= low && p[2] <= high) greatest = std::max(greatest, std::hypot(double{p[0]}, double{p[1]}));
  }
  return greatest;
}

TEST(FigureMesh, ToolIsAClosedSolidOfTheStatedSize) {
  const TriMesh tool = tool_mesh({{{0, 0}, {5, 0}, {5, 25}}, {{6, 25}, {6, 60}}, 4});
  EXPECT_TRUE(closed(tool));
  EXPECT_GT(volume(tool), 0.5 * kPi * 25 * 25 + 0.9 * kPi * 36 * 35);
  EXPECT_LT(volume(tool), kPi * 25 * 25 + kPi * 36 * 35);
  const Box tool_box = mesh::bounds(tool);
  EXPECT_NEAR(tool_box.upper.x(), 6, 0.02);
  EXPECT_EQ(tool_box.lower.z(), 0);
  EXPECT_EQ(tool_box.upper.z(), 60);
  EXPECT_NEAR(reach(tool, 0, 24), 5, 1e-5) << "the edges cut the nominal diameter";
}

TEST(FigureMesh, ToolFollowsItsOutline) {
  // A ball, a drill, a disc whose teeth go through, and a flat end without a shank.
  std::vector<Vec2> ball;
  for (int i = 0; i <= 20; ++i) {
    ball.emplace_back(5 * std::sin(i * kPi / 40), 5 - 5 * std::cos(i * kPi / 40));
  }
  ball.emplace_back(5, 25);
  const std::vector<ToolFigure> figures{{ball, {{5, 25}, {5, 60}}, 4},
                                        {{{0, 0}, {4, 2.4}, {4, 40}}, {{4, 40}, {4, 80}}, 2},
                                        {{{0, 0}, {10, 0}, {10, 4}}, {{4, 4}, {4, 60}}, 8},
                                        {{{0, 0}, {5, 0}, {5, 25}}, {}, 4}};
  for (size_t i = 0; i < figures.size(); ++i) {
    SCOPED_TRACE(i);
    const TriMesh tool = tool_mesh(figures[i]);
    EXPECT_TRUE(closed(tool));
    EXPECT_EQ(mesh::bounds(tool).lower.z(), 0);
    for (const Vec2& p : figures[i].flutes) {
      if (p.x() == 0) continue;
      EXPECT_NEAR(reach(tool, p.y() - 1e-3, p.y() + 1e-3), p.x(), 0.02) << p.y();
    }
  }
  // The teeth of the disc are cut into its upper face, above the shank's 4 mm too.
  const TriMesh disc = tool_mesh(figures[2]);
  EXPECT_LT(volume(disc), 0.9 * kPi * 100 * 4 + kPi * 16 * 56);
}

TEST(FigureMesh, HolderIsAClosedSolidOfTheStatedSize) {
  const TriMesh holder = holder_mesh(40, 50);
  EXPECT_TRUE(closed(holder));
  EXPECT_TRUE(normals_face_outwards(holder));
  const Box box = mesh::bounds(holder);
  EXPECT_NEAR((box.lower - Vec3(-20, -20, 0)).norm(), 0, 1e-5);
  EXPECT_NEAR((box.upper - Vec3(20, 20, 50)).norm(), 0, 1e-5);
}

TEST(FigureMesh, GridWindsWithItsNormalsWhicheverWayItRuns) {
  for (const double side : {1.0, -1.0}) {
    std::vector<Vec3> points, normals;
    for (int v = 0; v < 4; ++v) {
      for (int u = 0; u < 5; ++u) {
        points.emplace_back(u, v, 0.1 * u * v);
        normals.push_back(side * Vec3(-0.1 * v, -0.1 * u, 1).normalized());
      }
    }
    const TriMesh mesh = surface_grid_mesh(5, 4, points, normals);
    EXPECT_EQ(mesh.positions.size(), 20U);
    EXPECT_EQ(mesh.triangles.size(), 24U);
    EXPECT_TRUE(normals_face_outwards(mesh)) << side;
  }
}

TEST(FigureMesh, GridSplitsQuadsAlongTheRidge) {
  // Two facets meet along the diagonal from (0,0) to (1,1): its ends agree in normal.
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, -1}, {0, 1, -1}, {1, 1, 0}};
  const Vec3 up(0, 0, 1);
  const std::vector<Vec3> normals{up, Vec3(1, -1, 1).normalized(), Vec3(-1, 1, 1).normalized(), up};
  for (const auto& t : surface_grid_mesh(2, 2, points, normals).triangles) {
    EXPECT_TRUE(std::count(t.begin(), t.end(), 0U) == 1 && std::count(t.begin(), t.end(), 3U) == 1);
  }
}

FanInput straight_passes(size_t passes, size_t points) {
  FanInput input;
  for (size_t k = 0; k < passes; ++k) {
    input.pass_starts.push_back(input.points.size());
    for (size_t i = 0; i < points; ++i) {
      // Crowded towards the start, so that equal index steps are not equal arc steps.
      const double s = static_cast<double>(i) / static_cast<double>(points - 1);
      input.points.emplace_back(100 * s * s, 3.0 * static_cast<double>(k), 0);
      input.axes.emplace_back(0, 0, 1);
    }
  }
  return input;
}

TEST(AxisFan, ThinsToEvenPassesAndEvenArcLength) {
  FanStyle style;
  style.passes = 11;
  style.axes_per_pass = 6;
  style.axis_length_mm = 7;
  const std::vector<DrawLine> lines = axis_fan(straight_passes(31, 4001), style);
  ASSERT_EQ(lines.size(), 11U * 7U);
  for (size_t k = 0; k < 11; ++k) {
    const DrawLine& path = lines[7 * k];
    EXPECT_EQ(path.points.front().y(), 9.0 * k) << "every third pass";
    EXPECT_EQ(path.points.front().x(), 0.0);
    EXPECT_EQ(path.points.back().x(), 100.0);
    for (size_t i = 0; i < 6; ++i) {
      const DrawLine& axis = lines[7 * k + 1 + i];
      EXPECT_NEAR(axis.points[0].x(), 20.0 * i, 0.03);
      EXPECT_NEAR((axis.points[1] - axis.points[0] - Vec3(0, 0, 7)).norm(), 0, 1e-12);
    }
  }
}

TEST(AxisFan, NeverMorePassesThanAskedForAndNothingFromNothing) {
  for (size_t passes = 1; passes < 40; ++passes) {
    FanStyle style;
    style.passes = 8;
    size_t paths = 0;
    const auto lines = axis_fan(straight_passes(passes, 20), style);
    for (const DrawLine& line : lines) paths += line.colour == style.path_colour ? 1 : 0;
    EXPECT_LE(paths, 8U) << passes;
    EXPECT_GE(paths, std::min<size_t>(passes, 4)) << passes;
    EXPECT_EQ(lines.front().points.front().y(), 0.0);
  }
  EXPECT_TRUE(axis_fan(FanInput{}).empty());
}

}  // namespace
}  // namespace swarf::render::figures_mesh
