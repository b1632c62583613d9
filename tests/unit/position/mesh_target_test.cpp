// The tree against a loop over all triangles, to the last bit, and against a search over their points.
#include <gtest/gtest.h>

#include <cstring>

#include "base/diagnostics.h"
#include "base/parallel.h"
#include "brute_force.h"
#include "position/mesh_target.h"
#include "position/triangle_rest.h"
#include "support/counted_new.h"

namespace swarf::position {
namespace {

constexpr double kBelowAll = -std::numeric_limits<double>::infinity();

double loop_over_all(const ToolProfile& profile, const GuideLine& line, const TriMesh& mesh) {
  double best = kBelowAll;
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto local = [&](size_t k) { return line.local(corner_of(mesh, i, k)); };
    best = std::max(best, rest_on_triangle(profile, {local(0), local(1), local(2)}, kBelowAll).height);
  }
  return best;
}

/// Upright, tilted by up to 40 degrees, and in turn from any direction.
GuideLine random_line(Rng& rng, const Vec3& centre, double half, int i) {
  const Vec3 at = centre + Vec3(rng.uniform(-half, half), rng.uniform(-half, half), rng.uniform(-half, half));
  if (i % 3 == 0) return upright(at.x(), at.y());
  const Vec3 any = rng.direction();
  return guide_line(at, i % 3 == 1 ? Vec3(Vec3::UnitZ() + 0.6 * any) : any);
}

/// Every cutter at many places: the tree's height is that of the loop, whatever the hint.
void expect_as_loop(const TriMesh& mesh, const Vec3& centre, double half, int places, const char* what) {
  const MeshTarget target(mesh);
  int touched = 0;
  for (const NamedCutter& named : cutters_under_test()) {
    const ToolProfile profile(named.cutter);
    Rng rng(11);
    int near = -1;
    for (int i = 0; i < places; ++i) {
      const GuideLine line = random_line(rng, centre, half, i);
      Rest rest, hinted;
      int none = -1;
      target.raise(profile, line, rest, none);
      target.raise(profile, line, hinted, near);
      const double expected = loop_over_all(profile, line, mesh);
      touched += rest.touches() ? 1 : 0;
      ASSERT_EQ(rest.height, expected) << what << " " << named.name << " line = " << paste(line);
      ASSERT_EQ(hinted.height, expected) << what << " " << named.name << " line = " << paste(line);
      if (rest.touches()) {
        // An independent look at the contact: it lies on the underside, and at that height. Its coordinates
        // are rounded, and a rim's contact that comes to lie outside of the rim falls down its wall.
        const ClosedForm tool(named.cutter);
        const double rounded = 2.0 * std::numeric_limits<double>::epsilon() * rest.contact_W.norm();
        ASSERT_NEAR(brute_point(tool, line, rest.contact_W), rest.height, 2e-6 + kWallSlope * rounded)
            << what << " " << named.name << " line = " << paste(line);
      }
      if (i % 5 == 0) near = static_cast<int>(rng.next() % mesh.triangles.size());
    }
  }
  EXPECT_GT(touched, places) << what;
}

TriMesh soup(uint64_t seed, size_t n, double span, double size, const Vec3& centre) {
  Rng rng(seed);
  TriMesh mesh;
  const auto near = [&](const Vec3& p, double half) {
    return Vec3(p.x() + rng.uniform(-half, half), p.y() + rng.uniform(-half, half),
                p.z() + rng.uniform(-half, half));
  };
  for (size_t i = 0; i < n; ++i) {
    const Vec3 at = near(centre, span);
    Vec3 a = near(at, size), b = near(at, size), c = near(at, size);
    if (i % 7 == 0) c = a + 0.5 * (b - a);         // no area
    if (i % 11 == 0) c = b + 1e-3 * (c - b);       // a needle
    if (i % 13 == 0) c.z() = b.z() = a.z() = 1.0;  // level with others
    add_triangle(mesh, a, b, c);
    if (i % 17 == 0) add_triangle(mesh, b, a, c);  // twice, turned
  }
  return mesh;
}

TEST(MeshTarget, TreeIsTheLoop) {
  expect_as_loop(soup(1, 600, 20.0, 3.0, Vec3::Zero()), Vec3::Zero(), 20.0, 120, "soup");
  expect_as_loop(soup(2, 40, 10.0, 400.0, Vec3::Zero()), Vec3::Zero(), 20.0, 120, "triangles round the tool");
  expect_as_loop(soup(3, 300, 9000.0, 1000.0, Vec3::Zero()), Vec3::Zero(), 9000.0, 120, "1e3 mm");
  expect_as_loop(soup(4, 400, 3.0, 1e-3, Vec3::Zero()), Vec3::Zero(), 4.0, 120, "1e-3 mm");
  expect_as_loop(soup(5, 300, 10.0, 2.0, {1e4, -1e4, 1e4}), {1e4, -1e4, 1e4}, 12.0, 120, "far off");
  expect_as_loop(soup(6, 1, 0.1, 3.0, Vec3::Zero()), Vec3::Zero(), 3.0, 120, "one or two");
  expect_as_loop(soup(7, 5, 2.0, 3.0, Vec3::Zero()), Vec3::Zero(), 3.0, 120, "a few");
}

// Centres of spheres are rounded by half a micrometre there, and level triangles leave no other slack.
TEST(MeshTarget, SmallLevelTrianglesFarOff) {
  const Vec3 centre(1e4, -5e3, 2e3);
  for (uint64_t seed = 20; seed < 50; ++seed) {
    TriMesh mesh = soup(seed, 60, 3.0, 0.02, centre);
    for (auto& p : mesh.positions) p[2] = 2000.0F;
    expect_as_loop(mesh, centre, 4.0, 30, "level, far off");
  }
}

TriMesh waves() {
  return height_field(24, 40.0,
                      [](double x, double y) { return 2.0 * std::sin(0.3 * x) * std::cos(0.2 * y); });
}

TEST(MeshTarget, FacesThatAreLevel) {
  const TriMesh plane = height_field(24, 40.0, [](double, double) { return 3.0; });
  expect_as_loop(plane, Vec3::Zero(), 18.0, 60, "plane");
  expect_as_loop(height_field(24, 40.0, [](double x, double) { return 0.25 * x; }), Vec3::Zero(), 18.0, 60,
                 "inclined plane");
  expect_as_loop(waves(), Vec3::Zero(), 18.0, 60, "waves");
}

/// Sphere of radius 20, torus, saddle, each as a mesh: a search over the points of its triangles under the
/// tool.
struct Smooth {
  const char* name;
  std::function<double(double, double)> height;
};
const std::vector<Smooth>& smooth_shapes() {
  static const std::vector<Smooth> all{
      {"sphere", [](double x, double y) { return std::sqrt(std::max(0.0, 400.0 - x * x - y * y)); }},
      {"torus",
       [](double x, double y) {
         const double off = std::hypot(x, y) - 9.0;
         return std::sqrt(std::max(0.0, 64.0 - off * off));
       }},
      {"saddle", [](double x, double y) { return 0.02 * (x * x - y * y); }}};
  return all;
}

TriMesh part_under(const TriMesh& mesh, const GuideLine& line, double radius) {
  TriMesh part;
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Vec3 a = corner_of(mesh, i, 0);
    if ((a - line.point_W).cross(line.axis_W).norm() < radius + 4.0)
      add_triangle(part, a, corner_of(mesh, i, 1), corner_of(mesh, i, 2));
  }
  return part;
}

/// The tree's height less that of the search, mm.
double off_search(const TriMesh& mesh, const MeshTarget& target, const cutter::Cutter& cutter,
                  const GuideLine& line) {
  const ToolProfile profile(cutter);
  Rest rest;
  int near = -1;
  target.raise(profile, line, rest, near);
  return rest.height - brute_mesh(ClosedForm(cutter), line, part_under(mesh, line, profile.radius()));
}

TEST(MeshTarget, SmoothShapesAsMeshes) {
  Rng rng(5);
  int turn = 0;  // upright and tilted in turn: a search takes half a second
  for (const Smooth& shape : smooth_shapes()) {
    const TriMesh mesh = height_field(30, 30.0, shape.height);
    const MeshTarget target(mesh);
    for (const NamedCutter& named : cutters_under_test()) {
      const double x = rng.uniform(-8.0, 8.0), y = rng.uniform(-8.0, 8.0);
      const GuideLine line = turn++ % 2 == 0 ? upright(x, y) : guide_line({x, y, 8.0}, {0.4, -0.3, 1.0});
      EXPECT_NEAR(off_search(mesh, target, named.cutter, line), 0.0, 1e-7)
          << shape.name << " " << named.name << " " << paste(line);
    }
  }
}

// Theory 3: ball r 5 on a sphere of R 20; the mesh has its corners on the sphere and its facets inside by
// less than side^2 / (4 R).
TEST(MeshTarget, BallOnSphere) {
  const MeshTarget target(height_field(400, 36.0, smooth_shapes()[0].height));
  const ToolProfile ball(cutters_under_test()[1].cutter);
  const double tips[3][2] = {{0.0, 20.0}, {6.0, 19.269322199}, {12.5, 16.650635095}};
  for (const auto& tip : tips) {
    Rest rest;
    int near = -1;
    target.raise(ball, upright(tip[0], 0.0), rest, near);
    EXPECT_LE(rest.height, tip[1] + 1e-6);
    EXPECT_GE(rest.height, tip[1] - 0.09 * 0.09 / 20.0);
  }
}

TEST(MeshTarget, OverAVertexAnEdgeAndAFace) {
  TriMesh roof;  // ridge along y at z = 5
  add_triangle(roof, {-10, -10, 0}, {0, -10, 5}, {0, 10, 5});
  add_triangle(roof, {0, -10, 5}, {10, -10, 0}, {0, 10, 5});
  const MeshTarget target(roof);
  const ToolProfile ball(cutters_under_test()[1].cutter);
  const auto at = [&](double x, double y) {
    Rest rest;
    int near = -1;
    target.raise(ball, upright(x, y), rest, near);
    return rest;
  };
  EXPECT_EQ(at(0, 0).what, Touched::kEdge);
  EXPECT_DOUBLE_EQ(at(0, 0).height, 5.0);
  EXPECT_EQ(at(0, 0).number % 3,
            at(0, 0).number / 3 == 0 ? 1 : 2);  // the side from its first corner on the ridge
  EXPECT_EQ(at(0, 10).what, Touched::kVertex);
  EXPECT_DOUBLE_EQ(at(0, 13).height, 5.0 - 1.0);
  EXPECT_EQ(at(6, -5).what, Touched::kFace);
  EXPECT_EQ(at(6, -5).number, 1);
  EXPECT_NEAR(at(6, -5).gradient.x(), -0.5, 1e-12);
  EXPECT_FALSE(at(30, 0).touches());
}

TEST(MeshTarget, RaisesOnlyWhatIsLower) {
  const MeshTarget target(waves());
  const ToolProfile ball(cutters_under_test()[1].cutter);
  Rest first;
  int near = -1;
  target.raise(ball, upright(1.0, 2.0), first, near);
  Rest higher = first;
  higher.height += 0.5;
  higher.number = 12345;
  target.raise(ball, upright(1.0, 2.0), higher, near);
  EXPECT_EQ(higher.number, 12345);
}

TEST(MeshTarget, AllocatesNothing) {
  const MeshTarget target(waves());
  const ToolProfile bull(cutters_under_test()[2].cutter);
  Rest rest;
  int near = -1;
  const long before = allocations;
  for (int i = 0; i < 100; ++i) {
    rest = Rest{};
    target.raise(bull, upright(0.1 * i, 2.0), rest, near);
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_TRUE(rest.touches());
}

TEST(MeshTarget, EmptyAndBroken) {
  Rest rest;
  int near = -1;
  MeshTarget(TriMesh{}).raise(ToolProfile(cutter::Cutter{}), upright(0, 0), rest, near);
  EXPECT_FALSE(rest.touches());
  TriMesh broken;
  add_triangle(broken, {0, 0, 0}, {1, 0, std::nan("")}, {0, 1, 0});
  EXPECT_THROW(MeshTarget{broken}, InputError);
}

TEST(MeshTarget, SameTreeForAnyNumberOfThreads) {
  const TriMesh mesh = height_field(220, 100.0, [](double x, double y) { return std::sin(x) + 0.1 * y; });
  set_thread_count(1);
  const MeshTarget one(mesh);
  set_thread_count(4);
  const MeshTarget four(mesh);
  set_thread_count(0);
  const auto &a = one.tree(), &b = four.tree();
  ASSERT_EQ(a.nodes().size(), b.nodes().size());
  EXPECT_EQ(std::memcmp(a.nodes().data(), b.nodes().data(), a.nodes().size_bytes()), 0);
  EXPECT_EQ(std::memcmp(a.triangles().data(), b.triangles().data(), a.triangles().size_bytes()), 0);
}

}  // namespace
}  // namespace swarf::position
