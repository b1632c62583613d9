// Rays on designs of any kind, how far they answer for material, and material in several intervals.
#include "stock/rays/ray_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>
#include <set>

#include "base/rng.h"
#include "dome.h"
#include "stock/rays/free_ranges.h"
#include "stock/rays/ray_material.h"
#include "stock/rays/surface_dexels.h"
#include "support/scratch.h"

namespace swarf::stock {
namespace {

/// Appends the rectangle from `corner` along a and b; a x b points out of the material.
void add_rectangle(TriMesh& mesh, const Vec3& corner, const Vec3& a, const Vec3& b) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (const Vec3& p : {corner, Vec3(corner + a), Vec3(corner + a + b), Vec3(corner + b)}) {
    mesh.positions.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

TriMesh box_mesh(double x, double y, double z) {
  TriMesh mesh;
  const Vec3 X(x, 0, 0), Y(0, y, 0), Z(0, 0, z), O = Vec3::Zero();
  add_rectangle(mesh, O, Y, X);
  add_rectangle(mesh, O, X, Z);
  add_rectangle(mesh, O, Z, Y);
  add_rectangle(mesh, Z, X, Y);
  add_rectangle(mesh, Y, Z, X);
  add_rectangle(mesh, X, Y, Z);
  return mesh;
}

/// What holds for the rays of every design: unit normals, tiles that hold each ray once.
void expect_sound(const RayField& field) {
  std::vector<uint32_t> order = field.order;
  std::sort(order.begin(), order.end());
  ASSERT_EQ(order.size(), field.size());
  for (uint32_t n = 0; n < order.size(); ++n) ASSERT_EQ(order[n], n);
  uint32_t next = 0;
  for (const RayTile& tile : field.tiles) {
    ASSERT_EQ(tile.begin, next);
    ASSERT_LE(tile.count, 64u);
    next += tile.count;
  }
  ASSERT_EQ(next, field.size());
  for (const Vec3& normal : field.normals) ASSERT_NEAR(normal.norm(), 1.0, 1e-12);
}

/// Pieces that the rays hang together in by their neighbours.
size_t pieces_of(const RayField& field) {
  std::vector<uint32_t> parent(field.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](uint32_t n) {
    while (parent[n] != n) n = parent[n] = parent[parent[n]];
    return n;
  };
  size_t pieces = field.size();
  for (const auto& [a, b] : field.edges) {
    pieces -= root(a) != root(b) ? 1 : 0;
    parent[root(a)] = root(b);
  }
  return pieces;
}

TEST(RayField, SharpEdgesOfABoxHaveRaysOfBothSides) {
  const RayFieldPtr field = rays_on_mesh(box_mesh(4, 3, 2), 0.5);
  expect_sound(*field);
  EXPECT_NEAR(std::accumulate(field->areas_mm2.begin(), field->areas_mm2.end(), 0.0), 52.0, 1e-9);
  std::set<std::array<double, 3>> directions;
  size_t at_corner = 0;
  for (size_t n = 0; n < field->size(); ++n) {
    directions.insert({field->normals[n].x(), field->normals[n].y(), field->normals[n].z()});
    at_corner += field->points[n] == Vec3(4, 3, 2) ? 1 : 0;
  }
  EXPECT_EQ(directions.size(), 6u);
  EXPECT_EQ(at_corner, 3u);
  for (const auto& [a, b] : field->edges) {
    ASSERT_LE((field->points[a] - field->points[b]).norm(), 2.0 * kFarthestRay * 0.5);
    ASSERT_EQ(field->normals[a], field->normals[b]);  // no edge runs across a crease
  }
  EXPECT_EQ(pieces_of(*field), 6u);
}

TEST(RayField, SmoothEdgesShareTheirRays) {
  const RayFieldPtr field = rays_on_mesh(box_mesh(4, 3, 2), 0.5, 1.6);
  EXPECT_EQ(pieces_of(*field), 1u);
  for (size_t n = 0; n < field->size(); ++n) {
    if (field->points[n] != Vec3(4, 3, 2)) continue;
    EXPECT_LT((field->normals[n] - Vec3(1, 1, 1).normalized()).norm(), 1e-12);
  }
}

TEST(RayField, TheGridIsFinerWhereTheSurfaceBends) {
  // z = x^4 / 2 over [-1, 1]: flat in the middle, curvature 6 at x = 1.
  const Vec3 zero = Vec3::Zero();
  std::vector<Vec3> a(10, zero);  // degree 4 in u, 1 in v: x = 2u - 1
  a[0] = {-1, 0, 0.5};
  a[1] = {0, 1, 0};
  a[2] = {2, 0, -4};
  a[4] = {0, 0, 12};
  a[6] = {0, 0, -16};
  a[8] = {0, 0, 8};
  const auto surface = std::make_shared<surface::PolynomialSurface>(4, 1, a, 1);
  const RayFieldPtr field = rays_on_surface(surface, 0.25, 0.002);
  expect_sound(*field);
  double widest = 0.0, narrowest = 1.0;
  for (size_t i = 0; i + 1 < field->u_lines.size(); ++i) {
    const double low = field->u_lines[i], high = field->u_lines[i + 1];
    const Vec3 p = surface->point(low, 0.5), q = surface->point(high, 0.5);
    const Vec3 off = surface->point(0.5 * (low + high), 0.5) - p, chord = (q - p).normalized();
    EXPECT_LE((off - off.dot(chord) * chord).norm(),
              0.0023);  // the division is even: 15 % for its unevenness
    widest = std::max(widest, (q - p).norm());
    narrowest = std::min(narrowest, (q - p).norm());
  }
  EXPECT_GT(widest, 0.2);
  EXPECT_LT(narrowest, 0.12);
  // sum of shares = area of the strip: length of the curve times 1
  double length = 0.0;
  for (int i = 0; i < 100000; ++i)
    length += (surface->point((i + 1) * 1e-5, 0) - surface->point(i * 1e-5, 0)).norm();
  EXPECT_NEAR(std::accumulate(field->areas_mm2.begin(), field->areas_mm2.end(), 0.0), length, 2e-2);
}

TEST(OwnDepth, EndsWhereAnotherFaceIsNearer) {
  const RayFieldPtr field = rays_on_mesh(box_mesh(40, 30, 20), 5.0);
  const Vec3 out(-1, 0, 0);
  // On the wall x = 0, at depth s the other faces are as near as the foot is to their edges. The test takes
  // what is nearer than .85 s for another face's, so the answer is at most that much too deep.
  for (const double below : {0.0, 0.002, 0.5, 3.0}) {
    const double own = field->own_depth({0, 15, 20 - below}, out, 40.0);
    EXPECT_GE(own, below - 1e-6) << below;
    EXPECT_LE(own, below / 0.85 + 1e-4) << below;
  }
  EXPECT_NEAR(field->own_depth({0, 15, 10}, out, 0.5), 0.5, 0.0) << "all of a shallow cut";
  EXPECT_EQ(field->own_depth({0, 15, 10}, out, -0.5), -0.5) << "material above the design stays";
}

TEST(OwnDepth, AFloorCutAlongItsEdgeIsNoGougeOfTheWall) {
  // A step: the tool's flat end runs over the top face at the design's height and 20 um below it.
  for (const double deep : {0.0, 0.02}) {
    SurfaceDexels dexels(rays_on_mesh(box_mesh(40, 30, 20), 2.0), {{0, 0, 0}, {40, 30, 25}}, {});
    const Sweep sweep{{{-10, 15, 20 - deep}, Vec3::UnitZ()}, {{50, 15, 20 - deep}, Vec3::UnitZ()}, 0};
    dexels.cut({&sweep, 1}, CutterSolid(20.0, 30.0));
    dexels.limit_depths();
    const double deepest = -*std::min_element(dexels.heights_mm().begin(), dexels.heights_mm().end());
    EXPECT_NEAR(deepest, deep, 5e-5) << "floats of the mesh: 2e-5 mm, once more over 0.85";
  }
}

TEST(FreeRanges, EachWallOfASlotAnswersForItsHalf) {
  // A slot 10 wide and 6 deep: floor at z = 0, walls at x = 0 and x = 10.
  TriMesh mesh;
  add_rectangle(mesh, {0, 0, 0}, {10, 0, 0}, {0, 20, 0});
  add_rectangle(mesh, {0, 0, 0}, {0, 20, 0}, {0, 0, 6});
  add_rectangle(mesh, {10, 0, 0}, {0, 0, 6}, {0, 20, 0});
  const RayFieldPtr field = rays_on_mesh(mesh, 0.4);
  const std::vector<double> ranges = free_ranges({&field, 1}, 0);
  for (size_t n = 0; n < field->size(); ++n) {
    const Vec3& p = field->points[n];
    if (p.y() < 6.0 || p.y() > 14.0) continue;
    const bool floor = field->normals[n].z() > 0.5;
    const double to_wall = std::min(p.x(), 10.0 - p.x());
    // The ball on the floor touches the wall at its own height; on the wall it touches the floor or the other
    // wall.
    const double exact = floor ? (to_wall <= 6.0 ? to_wall : 1e9) : std::min(5.0, p.z());
    // Feet closer to the corner than half the pitch answer for nothing.
    ASSERT_GE(ranges[n], exact > 0.2 ? exact - 1e-9 : 0.0) << p.transpose();
    ASSERT_LE(ranges[n], exact + 0.12) << p.transpose();
  }
  const RayFieldPtr outside = rays_on_mesh(box_mesh(4, 3, 2), 0.5);
  for (const double range : free_ranges({&outside, 1}, 0))
    ASSERT_EQ(range, std::numeric_limits<double>::infinity());
}

/// z = 2 sin(x / 3) cos(y / 2) over 24 x 16, in facets of half a millimetre.
TriMesh wave_mesh() {
  constexpr uint32_t kAlong = 48, kAcross = 32;
  TriMesh mesh;
  for (uint32_t i = 0; i <= kAlong; ++i) {
    for (uint32_t j = 0; j <= kAcross; ++j) {
      const double x = 0.5 * i, y = 0.5 * j;
      mesh.positions.push_back({static_cast<float>(x), static_cast<float>(y),
                                static_cast<float>(2.0 * std::sin(x / 3.0) * std::cos(y / 2.0))});
    }
  }
  for (uint32_t i = 0; i < kAlong; ++i) {
    for (uint32_t j = 0; j < kAcross; ++j) {
      const uint32_t a = i * (kAcross + 1) + j, b = a + kAcross + 1;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  }
  return mesh;
}

/// free_ranges.h, wall by wall: of all walls, or of those alone whose normal differs from the ray's by twice
/// the sine at which a wall begins, which no box may leave out.
double range_by_brute_force(const RayField& field, size_t ray, bool all) {
  const RayField& walls = field.walls ? *field.walls : field;
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < walls.size(); ++i) {
    if (!all && (walls.normals[i] - field.normals[ray]).norm() <= 2.0 * kLeastWallSine) continue;
    const Vec3 offset = walls.points[i] - field.points[ray];
    const double along = field.normals[ray].dot(offset), distance2 = offset.squaredNorm();
    if (along <= 0.0 || along * along <= kLeastWallSine * kLeastWallSine * distance2) continue;
    least = std::min(least, distance2 / (2.0 * along));
  }
  return least < 0.5 * field.pitch_mm ? 0.0 : least;
}

TEST(FreeRanges, OfAWaveLieBetweenThoseOfBruteForce) {
  const RayFieldPtr field = rays_on_mesh(wave_mesh(), 0.6);
  const std::vector<double> ranges = free_ranges({&field, 1}, 0);
  size_t limited = 0;
  for (size_t n = 0; n < field->size(); ++n) {
    ASSERT_GE(ranges[n], range_by_brute_force(*field, n, true)) << field->points[n].transpose();
    ASSERT_LE(ranges[n], range_by_brute_force(*field, n, false)) << field->points[n].transpose();
    limited += std::isfinite(ranges[n]) ? 1 : 0;
  }
  EXPECT_GT(limited, field->size() / 5);
  EXPECT_LT(limited, field->size());
}

struct RayState {
  StandingMaterial standing;
  std::vector<MaterialAbove> above;
};

RayState after(const std::vector<RayCut>& cuts) {
  RayState state{{20.0, kUncut}, {}};
  for (const RayCut& cut : cuts) remove_material(cut, 0, state.standing, state.above);
  return state;
}

TEST(RayMaterial, AnyOrderOfIntervalsLeavesTheSame) {
  for (uint64_t seed = 1; seed <= 400; ++seed) {
    Rng rng(seed);
    std::vector<RayCut> cuts;  // whole numbers, so that ends meet often
    for (uint32_t n = 0; n < 8; ++n) {
      const double low = std::floor(rng.uniform(-3.0, 20.0));
      cuts.push_back({low, low + std::floor(rng.uniform(0.0, 6.0)), n});
    }
    const RayState first = after(cuts);
    // By unit cells: cell k is [k, k + 1].
    double standing = 20.0;
    std::vector<bool> material(20, true);
    for (const RayCut& cut : cuts) {
      if (cut.high > cut.low) standing = std::min(standing, cut.low);
      for (int k = 0; k < 20; ++k)
        material[static_cast<size_t>(k)] =
            material[static_cast<size_t>(k)] && (k + 1 <= cut.low || k >= cut.high);
    }
    ASSERT_EQ(first.standing.height, standing) << "seed " << seed;
    for (int k = 0; k < 20; ++k) {
      const bool kept = k + 1 <= standing ||
                        std::any_of(first.above.begin(), first.above.end(),
                                    [&](const MaterialAbove& m) { return k >= m.low && k + 1 <= m.high; });
      ASSERT_EQ(kept, material[static_cast<size_t>(k)]) << "seed " << seed << " cell " << k;
    }
    for (int shuffle = 0; shuffle < 20; ++shuffle) {
      for (size_t i = cuts.size(); i > 1; --i) std::swap(cuts[i - 1], cuts[rng.next() % i]);
      const RayState other = after(cuts);
      ASSERT_EQ(other.standing.height, first.standing.height) << "seed " << seed;
      ASSERT_EQ(other.standing.block, first.standing.block) << "seed " << seed;
      ASSERT_EQ(other.above.size(), first.above.size()) << "seed " << seed;
      for (size_t i = 0; i < other.above.size(); ++i) {
        ASSERT_EQ(other.above[i].low, first.above[i].low) << "seed " << seed;
        ASSERT_EQ(other.above[i].high, first.above[i].high) << "seed " << seed;
        ASSERT_EQ(other.above[i].low_block, first.above[i].low_block) << "seed " << seed;
        ASSERT_EQ(other.above[i].high_block, first.above[i].high_block) << "seed " << seed;
      }
    }
  }
}

// A disc 3 mm thick runs under 10 mm of stock: the floor is finished, 7 mm of material hang above it.
TEST(SurfaceDexels, AnUndercutLeavesMaterialAboveTheGap) {
  TriMesh floor;
  add_rectangle(floor, {-5, -5, 0}, {10, 0, 0}, {0, 10, 0});
  const RayFieldPtr field = rays_on_mesh(floor, 1.0);
  SurfaceDexels dexels(field, {{-5, -5, -5}, {5, 5, 10}}, {});
  const CutterSolid disc(20.0, 3.0);
  const std::vector<Sweep> sweeps{{{{-4, 0, 0}, Vec3::UnitZ()}, {{0, 0, 0}, Vec3::UnitZ()}, 0},
                                  {{{0, 0, 0}, Vec3::UnitZ()}, {{4, 0, 0}, Vec3::UnitZ()}, 1}};
  dexels.cut(sweeps, disc);
  size_t hanging = 0;
  dexels.each_above([&](uint32_t, const MaterialAbove& m) {
    ++hanging;
    EXPECT_EQ(m.low, 3.0);
    EXPECT_EQ(m.high, 10.0);
    EXPECT_EQ(m.low_block, 0u);
    EXPECT_EQ(m.high_block, kUncut);
  });
  EXPECT_EQ(hanging, field->size());
  for (const double height : dexels.heights_mm()) EXPECT_EQ(height, 0.0);
  const auto path = (std::filesystem::path(test::scratch_text()) / "undercut.rays").string();
  dexels.save(path);
  SurfaceDexels loaded = SurfaceDexels::load(path, field);
  // What hangs is cut away later, by a second cutter and in the loaded copy too.
  const std::vector<Sweep> clearing{{{{-4, 0, 2}, Vec3::UnitZ()}, {{4, 0, 2}, Vec3::UnitZ()}, 2}};
  for (SurfaceDexels* rays : {&dexels, &loaded}) {
    size_t before = 0, left = 0;
    rays->each_above([&](uint32_t, const MaterialAbove&) { ++before; });
    rays->cut(clearing, CutterSolid(20.0, 30.0));
    rays->each_above([&](uint32_t, const MaterialAbove&) { ++left; });
    EXPECT_EQ(before, field->size());
    EXPECT_EQ(left, 0u);
  }
  EXPECT_EQ(loaded.heights_mm(), dexels.heights_mm());
}

}  // namespace
}  // namespace swarf::stock
