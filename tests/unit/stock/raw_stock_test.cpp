// Level set and measuring rays of raw stocks that are no box, against their closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "base/units.h"
#include "stock/rays/free_ranges.h"
#include "stock/rays/surface_dexels.h"
#include "stock/stock.h"
#include "stock_test_support.h"
#include "support/solids.h"
#include "surface/analytic.h"

namespace swarf::stock::raw_stock_test {
namespace {

const Box kTwin{{-6, -5, -4}, {7, 8, 9}};

const std::vector<Vec2> kOutline{{0, 0}, {40, 5}, {30, 30}, {20, 12}, {4, 28}};

/// Greatest distance of the level set's mesh from the raw surface, mm. Not looked at: what lies within two
/// voxels of a place where three faces of kOutline meet, at no right angles. The mesher's planes, not the
/// level set's values, are up to a third of a voxel off there.
double farthest(const Stock& stock, bool outline) {
  const double near = 2.0 * stock.voxel_mm();
  const auto at_corner = [&](const Vec3& p) {
    const bool end = std::min(p.z() - stock.box().lower.z(), stock.box().upper.z() - p.z()) < near;
    return outline && end && std::any_of(kOutline.begin(), kOutline.end(), [&](const Vec2& corner) {
             return (p.head<2>() - corner).norm() < near;
           });
  };
  double farthest = 0.0;
  for (const auto& position : stock.mesh().positions) {
    const Vec3 p(position[0], position[1], position[2]);
    if (!at_corner(p)) farthest = std::max(farthest, std::abs(stock.raw().distance_mm(p)));
  }
  return farthest;
}

/// Walls of 1.2 mm around two pockets with a floor of 2: a thin casting.
TriMesh casting() {
  return test::towers({0, 1.2, 24, 25.2, 48.8, 50}, {0, 1.2, 28.8, 30}, 0.0,
                      [](int i, int j) { return (i == 1 || i == 3) && j == 1 ? 2.0 : 18.0; });
}

struct Case {
  const char* name;
  RawShape shape;
  double voxel_mm;
};

TEST(RawStock, VolumeWithinAThousandthAndSurfaceWithinATenthOfAVoxel) {
  const std::vector<Case> cases{
      {"sphere", RawShape::of_mesh(test::sphere(15.0, {0.3, 0.1, -0.2}, 240, 120), "sphere"), 0.25},
      {"torus", RawShape::of_mesh(test::torus(14.0, 5.0, {0.2, 0, 0}, 320, 120), "torus"), 0.25},
      {"casting", RawShape::of_mesh(casting(), "casting"), 0.25},
      {"cylinder", RawShape::of_tube({{0, 0, -3}, Vec3(1, 2, 2) / 3.0, 12.0, 0.0, 30.0}), 0.25},
      {"tube", RawShape::of_tube({{0, 0, -3}, Vec3::UnitX(), 12.0, 9.0, 30.0}), 0.25},
      {"outline", RawShape::of_outline({kOutline, -3.0, 9.1}), 0.25}};
  for (const Case& one : cases) {
    const Stock stock(one.shape, one.voxel_mm);
    EXPECT_EQ(stock.check(), "") << one.name;
    const double exact = one.shape.volume_mm3();
    EXPECT_NEAR(stock.volume_mm3(), exact, 1e-3 * exact) << one.name;
    const double off = farthest(stock, std::string(one.name) == "outline");
    EXPECT_LT(off, 0.1 * one.voxel_mm) << one.name;
    const VolumeRange range = stock.volume_between(0.0);
    EXPECT_LE(range.least, exact) << one.name;
    EXPECT_GE(range.greatest, exact) << one.name;
    std::printf("%-9s %9zu leaves, volume %+.5f %%, surface within %.4f voxel\n", one.name, stock.leaves(),
                100.0 * (stock.volume_mm3() / exact - 1.0), off / one.voxel_mm);
  }
}

TEST(RawStock, ABoxAsMeshOrOutlineIsTheBox) {
  const Stock box(kTwin, 0.37);
  EXPECT_EQ(Stock(RawShape::of_box(kTwin), 0.37).hash(), box.hash());
  const RawShape outline = RawShape::of_outline({{{-6, -5}, {7, -5}, {7, 8}, {-6, 8}}, -4.0, 9.0});
  const RawShape mesh = RawShape::of_mesh(test::block(kTwin.lower, kTwin.upper), "block");
  for (const RawShape& shape : {outline, mesh}) {
    const Stock stock(shape, 0.37);
    EXPECT_EQ(stock.check(), "");
    EXPECT_EQ(stock.leaves(), box.leaves());
    EXPECT_NEAR(stock.volume_mm3(), box.volume_mm3(), 1e-3);
    Rng rng(3);
    for (int n = 0; n < 2000; ++n) {
      const Vec3 p(rng.uniform(-8, 9), rng.uniform(-7, 10), rng.uniform(-6, 11));
      ASSERT_NEAR(stock.distance_mm(p), box.distance_mm(p), 1e-6) << text(p);
    }
  }
}

TEST(RawStock, IsTheSameForAnyNumberOfThreads) {
  const RawShape shape = RawShape::of_mesh(casting(), "casting");
  std::vector<uint64_t> hashes;
  std::vector<double> walls;
  for (const int threads : {1, 2, 5}) {
    set_thread_count(threads);
    hashes.push_back(Stock(shape, 0.4).hash());
    walls.push_back(shape.thinnest_wall(0.3).mm);
  }
  set_thread_count(0);
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
  EXPECT_EQ(walls[0], walls[2]);
}

TEST(RawStock, SweepsTakeTheSameFromABarAsFromTheBoxAroundItWhereBothAreDeep) {
  const RawTube bar{{0, 0, -10}, Vec3::UnitZ(), 20.0, 0.0, 20.0};
  Stock stock(RawShape::of_tube(bar), 0.4);
  const double full = stock.volume_mm3();
  const CutterSolid cutter{3.0, 25.0};
  stock.cut(straight_sweeps({{-5, 0, 4}, Vec3::UnitZ()}, {{5, 0, 4}, Vec3::UnitZ()}, 10), cutter);
  EXPECT_EQ(stock.check(), "");
  const double slot = (2.0 * 3.0 * 10.0 + kPi * 9.0) * 6.0;
  EXPECT_NEAR(full - stock.volume_mm3(), slot, 1e-3 * slot);
}

TEST(RawStock, RaysOverABoreBeginInTheWallAndSeeTheFarOne) {
  // The design: a plane through the wall of a pipe, 1 mm over its lower outside; rays look up.
  const RawShape pipe = RawShape::of_tube({{-20, 0, 10}, Vec3::UnitX(), 10.0, 8.0, 40.0});
  const auto plane = std::make_shared<surface::PlaneSurface>(Vec3(-5, -1, 1), Vec3(10, 0, 0), Vec3(0, 2, 0));
  SurfaceDexels dexels(rays_on_surface(plane, 0.5), pipe, {});
  size_t hanging = 0;
  for (size_t n = 0; n < dexels.points().size(); ++n) {
    const double y = dexels.points()[n].y();
    EXPECT_NEAR(dexels.heights_mm()[n], 10.0 - std::sqrt(64.0 - y * y) - 1.0, 1e-9);
  }
  dexels.each_above([&](uint32_t ray, const MaterialAbove& m) {
    const double y = dexels.points()[ray].y();
    EXPECT_NEAR(m.low, 9.0 + std::sqrt(64.0 - y * y), 1e-9);
    EXPECT_NEAR(m.high, 9.0 + std::sqrt(100.0 - y * y), 1e-9);
    EXPECT_EQ(m.low_block, kUncut);
    ++hanging;
  });
  EXPECT_EQ(hanging, dexels.points().size());
  // A slot through the far wall takes what hangs, and leaves what stands.
  dexels.cut(straight_sweeps({{-15, 0, 15}, Vec3::UnitZ()}, {{15, 0, 15}, Vec3::UnitZ()}, 4), {4.0, 25.0});
  hanging = 0;
  dexels.each_above([&](uint32_t, const MaterialAbove&) { ++hanging; });
  EXPECT_EQ(hanging, 0U);
  EXPECT_EQ(dexels.blocks()[0], kUncut);
}

TEST(RawStock, RaysInABoxGivenAsAnOutlineAreThoseOfTheBox) {
  const auto plane = std::make_shared<surface::PlaneSurface>(Vec3(-6, -5, 2), Vec3(13, 0, 1), Vec3(0, 13, 2));
  const RayFieldPtr field = rays_on_surface(plane, 0.5);
  const SurfaceDexels box(field, kTwin, {});
  const SurfaceDexels outline(field, RawShape::of_outline({{{-6, -5}, {7, -5}, {7, 8}, {-6, 8}}, -4.0, 9.0}),
                              {});
  for (size_t n = 0; n < field->size(); ++n)
    ASSERT_NEAR(box.heights_mm()[n], outline.heights_mm()[n], 1e-9) << text(field->points[n]);
}

}  // namespace
}  // namespace swarf::stock::raw_stock_test
