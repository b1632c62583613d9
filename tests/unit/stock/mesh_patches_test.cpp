// The surface in patches: together it is the mesh, and only what was cut is made again.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "base/rng.h"
#include "mesh/mesh_ops.h"
#include "stock/mesher/stock_mesher.h"
#include "stock/stock.h"
#include "stock_test_support.h"

namespace swarf::stock {
namespace {

using Corner = std::array<float, 6>;  // position and normal
using Triangle = std::array<Corner, 3>;

/// Triangles by what they look like, for comparing; each begins with its least corner.
std::multiset<Triangle> triangles_of(const TriMesh& mesh) {
  std::multiset<Triangle> all;
  for (const auto& t : mesh.triangles) {
    Triangle triangle;
    for (size_t c = 0; c < 3; ++c) {
      const auto &p = mesh.positions.at(t[c]), &n = mesh.normals.at(t[c]);
      triangle[c] = {p[0], p[1], p[2], n[0], n[1], n[2]};
    }
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
    all.insert(triangle);
  }
  return all;
}

Sweep cut_at(Rng& rng, uint32_t block) {
  Sweep sweep = random_sweep(rng, 7.0, 1.5, 0.2);
  sweep.block = block;
  return sweep;
}

/// Leaf positions of a patch's side.
class StockPatches : public testing::TestWithParam<int> {};

TEST_P(StockPatches, TogetherAreTheMeshAfterEveryCut) {
  Stock stock({{-6, -6, -6}, {6, 6, 6}}, 0.15);
  StockMesher mesher(stock, GetParam());
  std::vector<TriMesh> kept(mesher.patches());
  Rng rng(91);
  size_t made = 0;
  constexpr uint32_t kCuts = 10;
  for (uint32_t n = 0; n <= kCuts; ++n) {
    const std::vector<size_t> changed = mesher.update();
    EXPECT_TRUE(std::is_sorted(changed.begin(), changed.end()));
    for (const size_t p : changed) {
      const TriMesh before = std::exchange(kept.at(p), mesher.patch(p));
      if (n > 0)
        EXPECT_NE(triangles_of(before), triangles_of(kept.at(p))) << "patch " << p << " is as it was";
    }
    if (n > 0) made += changed.size();
    std::multiset<Triangle> all;
    for (const TriMesh& patch : kept) all.merge(triangles_of(patch));
    ASSERT_EQ(all, triangles_of(stock.mesh())) << "cut " << n;
    stock.cut(std::vector<Sweep>{cut_at(rng, n)}, {0.8, 3.0});
  }
  EXPECT_GT(made, 0U);
  EXPECT_LT(made, kCuts * mesher.patches() / 2);
}

INSTANTIATE_TEST_SUITE_P(Sides, StockPatches, testing::Values(1, 3, 4));

TEST(StockPatch, OnlyWhatACutReachesIsMadeAgain) {
  constexpr double kVoxel = 0.15, kRadius = 0.5;
  constexpr double kNear = 8.0 * kVoxel;  // the leaf behind joins its vertices
  Stock stock({{-6, -6, -6}, {6, 6, 6}}, kVoxel);
  StockMesher mesher(stock, 1);
  mesher.update();
  const Vec3 from(-3, -3, 4), to(1, -3, 4);
  stock.cut(std::vector<Sweep>{{{from, Vec3::UnitZ()}, {to, Vec3::UnitZ()}, 0}}, {kRadius, 20.0});
  const Box slot{from - Vec3(kRadius, kRadius, 0.0), Vec3(to.x() + kRadius, to.y() + kRadius, 6.0)};
  const std::vector<size_t> changed = mesher.update();
  EXPECT_GT(changed.size(), 5U);
  for (const size_t p : changed) {
    const TriMesh patch = mesher.patch(p);
    if (patch.triangles.empty()) continue;
    const Box box = mesh::bounds(patch);
    EXPECT_TRUE((box.lower.array() - kNear <= slot.upper.array()).all() &&
                (box.upper.array() + kNear >= slot.lower.array()).all())
        << "patch " << p << " lies beside the slot";
  }
}

TEST(StockPatch, NothingIsMadeAgainWhereNothingWasCut) {
  Stock stock({{-6, -6, -6}, {6, 6, 6}}, 0.15);
  StockMesher mesher(stock);
  EXPECT_EQ(mesher.update().size(), mesher.patches());
  EXPECT_TRUE(mesher.update().empty());
  // A hole in one corner leaves the opposite one alone.
  stock.cut(std::vector<Sweep>{{{{-5, -5, 4}, Vec3::UnitZ()}, {{-5, -5, 5}, Vec3::UnitZ()}, 0}}, {0.5, 20.0});
  const std::vector<size_t> changed = mesher.update();
  EXPECT_FALSE(changed.empty());
  EXPECT_EQ(std::count(changed.begin(), changed.end(), mesher.patches() - 1), 0);
}

TEST(StockPatch, AStockThatIsAllCutAwayHasEmptyOnes) {
  Stock stock({{-1, -1, -1}, {1, 1, 1}}, 0.1);
  StockMesher mesher(stock);
  mesher.update();
  stock.cut(std::vector<Sweep>{{{{0, 0, -5}, Vec3::UnitZ()}, {{0, 0, -5}, Vec3::UnitZ()}, 0}}, {5.0, 20.0});
  for (const size_t p : mesher.update()) EXPECT_TRUE(mesher.patch(p).triangles.empty());
}

}  // namespace
}  // namespace swarf::stock
