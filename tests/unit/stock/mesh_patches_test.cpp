// The surface in patches: together it is the mesh, and only what was cut is made again.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "base/rng.h"
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

TEST(StockPatches, TogetherAreTheMeshAfterEveryCut) {
  Stock stock({{-6, -6, -6}, {6, 6, 6}}, 0.15);
  StockMesher mesher(stock);
  std::vector<TriMesh> kept(mesher.patches());
  Rng rng(91);
  size_t made = 0;
  constexpr uint32_t kCuts = 20;
  for (uint32_t n = 0; n <= kCuts; ++n) {
    const std::vector<size_t> changed = mesher.update();
    EXPECT_TRUE(std::is_sorted(changed.begin(), changed.end()));
    for (const size_t p : changed) kept.at(p) = mesher.patch(p);
    if (n > 0) made += changed.size();
    std::multiset<Triangle> all;
    for (const TriMesh& patch : kept) all.merge(triangles_of(patch));
    ASSERT_EQ(all, triangles_of(stock.mesh())) << "cut " << n;
    stock.cut(std::vector<Sweep>{cut_at(rng, n)}, {0.8, 3.0});
  }
  EXPECT_GT(made, 0U);
  EXPECT_LT(made, kCuts * mesher.patches() / 2);
}

TEST(StockPatches, NothingIsMadeAgainWhereNothingWasCut) {
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

TEST(StockPatches, AStockThatIsAllCutAwayHasEmptyOnes) {
  Stock stock({{-1, -1, -1}, {1, 1, 1}}, 0.1);
  StockMesher mesher(stock);
  mesher.update();
  stock.cut(std::vector<Sweep>{{{{0, 0, -5}, Vec3::UnitZ()}, {{0, 0, -5}, Vec3::UnitZ()}, 0}}, {5.0, 20.0});
  for (const size_t p : mesher.update()) EXPECT_TRUE(mesher.patch(p).triangles.empty());
}

}  // namespace
}  // namespace swarf::stock
