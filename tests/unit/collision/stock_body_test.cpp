#include "collision/stock_body.h"

#include <gtest/gtest.h>

#include "unit/collision/toy_machine.h"

namespace swarf::collision {
namespace {

constexpr double kVoxel = 0.25;

/// A block of 40 x 20 x 10 with a slot along X, 10 wide and 6 deep.
stock::Stock slotted_block(const Box& block) {
  stock::Stock stock(block, kVoxel);
  const stock::CutterSolid cutter(5.0, 30.0);
  const std::vector<stock::Sweep> sweeps{
      {{Vec3(-10, 10, 4), Vec3::UnitZ()}, {Vec3(50, 10, 4), Vec3::UnitZ()}, 0}};
  stock.cut(sweeps, cutter);
  return stock;
}

/// A bar along Z whose foot is centred at y = 10 and stands at `height`.
Body bar(double height, double half_width) {
  return mesh_body("bar", BodyKind::kLink, kZSlide,
                   box_mesh({-30, 10 - half_width, height}, {-25, 10 + half_width, height + 40}));
}

TEST(StockBody, SuspectsAreHeldAgainstWhatIsLeft) {
  const machine::MachineScene scene = toy_machine();
  const Box block{Vec3(0, 0, 0), Vec3(40, 20, 10)};
  const AxisSegment along = way(axes(0), axes(60));
  StockBody stock(scene, block);
  // Over the block whatever is cut; through it before it is cut.
  EXPECT_EQ(stock.over(bar(10.5, 3), along).outcome, StockOutcome::kClearOfRaw);
  EXPECT_EQ(stock.over(bar(7, 3), along).outcome, StockOutcome::kContact);
  stock.refresh(slotted_block(block));
  EXPECT_EQ(stock.over(bar(10.5, 3), along).outcome, StockOutcome::kClearOfRaw);
  // Through the slot with 2 mm on each side and 3 mm below.
  EXPECT_EQ(stock.over(bar(7, 3), along).outcome, StockOutcome::kClear);
  // A tenth of a millimetre beside the walls: within a voxel.
  const StockAnswer near = stock.over(bar(7, 4.9), along);
  EXPECT_EQ(near.outcome, StockOutcome::kOpen);
  EXPECT_NEAR(near.upper, 0.1, 0.13 * kVoxel);
  // Half a millimetre into both walls, half into the floor.
  EXPECT_EQ(stock.over(bar(7, 5.5), along).outcome, StockOutcome::kContact);
  EXPECT_NEAR(stock.over(bar(7, 5.5), along).depth_mm, 0.5, 0.05);
  EXPECT_EQ(stock.over(bar(3.5, 3), along).outcome, StockOutcome::kContact);
  EXPECT_NEAR(stock.over(bar(3.5, 3), along).depth_mm, 0.5, 0.05);
}

TEST(StockBody, WaysAreClearUpToTheFirstThatIsNot) {
  const machine::MachineScene scene = toy_machine();
  const Box block{Vec3(0, 0, 0), Vec3(40, 20, 10)};
  StockBody stock(scene, block);
  stock.refresh(slotted_block(block));
  // Along the slot, then into its wall, then out again.
  const std::vector<AxisValues> places{axes(0),     axes(20), axes(40),       axes(60),
                                       axes(60, 8), axes(60), axes(60, 0, 50)};
  EXPECT_EQ(stock.clear_ways(bar(7, 3), std::span(places).first(4), 0.0), 3U);
  EXPECT_EQ(stock.clear_ways(bar(7, 3), places, 0.0), 3U);
  EXPECT_EQ(stock.clear_ways(bar(7, 3), std::span(places).subspan(4), 0.0), 0U);
  EXPECT_EQ(stock.clear_ways(bar(7, 3), std::span(places).subspan(5), 0.0), 1U);
  // What the caller wants besides: 2 mm to each wall; over the first way the bar has not come to the block.
  EXPECT_EQ(stock.clear_ways(bar(7, 3), std::span(places).first(4), 1.7), 3U);
  EXPECT_EQ(stock.clear_ways(bar(7, 3), std::span(places).first(4), 1.8), 1U);
  // A needle flies across the walls in one way.
  const Body needle =
      mesh_body("needle", BodyKind::kLink, kZSlide, box_mesh({20, -30, 7}, {20.1F, -29.9F, 40}));
  const std::vector<AxisValues> across{axes(0), axes(0, 20), axes(0, 80)};
  EXPECT_EQ(stock.clear_ways(needle, across, 0.0), 1U);
}

/// Seeded: no place of a way that is told to be clear is in the material.
TEST(StockBody, NothingOfAClearWayIsNearTheMaterial) {
  const machine::MachineScene scene = toy_machine();
  const Box block{Vec3(0, 0, 0), Vec3(40, 20, 10)};
  const stock::Stock slotted = slotted_block(block);
  StockBody stock(scene, block);
  stock.refresh(slotted);
  size_t clear = 0, stopped = 0;
  for (int i = 0; i < 200; ++i) {
    Rng rng(900 + i);
    const Vec3 low(rng.uniform(0, 38), rng.uniform(2, 16), rng.uniform(3, 12));
    const Vec3 high = low + rng.uniform(0.1, 2.0) * Vec3::Ones();
    const Body body = mesh_body("body", BodyKind::kLink, kZSlide, box_mesh(low, high));
    std::vector<AxisValues> places(1, axes(0));
    for (int k = 0; k < 6; ++k)
      places.push_back(places.back() + axes(rng.uniform(-4, 4), rng.uniform(-2, 2), rng.uniform(-1, 1)));
    const size_t ways = stock.clear_ways(body, places, 0.0);
    (ways == 6 ? clear : stopped) += 1;
    for (size_t w = 0; w < ways; ++w)
      for (int s = 0; s <= 20; ++s) {
        const AxisValues q = way(places[w], places[w + 1]).at(s / 20.0);
        for (const Triangle& triangle : body.triangles)
          for (const Vec3& corner : triangle)
            ASSERT_GT(slotted.distance_mm(corner + q.head<3>()), 0.5 * kVoxel) << "seed " << 900 + i;
      }
  }
  EXPECT_GT(clear, 20U);
  EXPECT_GT(stopped, 50U);
}

/// A wall of 0.06 mm between two slots, which no grid point lies in: the mesh lacks it, the proof does not.
TEST(StockBody, WallsThatTheMeshLacksAreNotClear) {
  const machine::MachineScene scene = toy_machine();
  const Box block{Vec3(0, 0, 0), Vec3(40, 20, 10)};
  const auto slots = [&](double wall) {
    stock::Stock stock(block, kVoxel);
    const stock::CutterSolid cutter(2.0, 30.0);
    std::vector<stock::Sweep> sweeps;
    for (const double y : {8.1, 12.1 + wall})
      sweeps.push_back({{Vec3(-10, y, 4), Vec3::UnitZ()}, {Vec3(50, y, 4), Vec3::UnitZ()}, 0});
    stock.cut(sweeps, cutter);
    return stock;
  };
  const Body needle =
      mesh_body("needle", BodyKind::kLink, kZSlide, box_mesh({20, 7.95F, 7}, {20.1F, 8.05F, 40}));
  const std::vector<AxisValues> across{axes(0), axes(0, 1), axes(0, 4)};
  const stock::Stock thin = slots(0.06);
  ASSERT_GT(thin.distance_mm({20, 10.13, 8}), 0.0) << "the level set shows it";
  StockBody stock(scene, block);
  stock.refresh(thin);
  EXPECT_EQ(stock.over(needle, way(across[1], across[2])).outcome, StockOutcome::kClear);
  EXPECT_EQ(stock.clear_ways(needle, across, 0.0), 1U);
  stock.refresh(slots(-1.0));
  EXPECT_EQ(stock.clear_ways(needle, across, 0.0), 2U);
}

TEST(StockBody, InsideTheMaterialIsAContact) {
  const machine::MachineScene scene = toy_machine();
  const StockBody stock(scene, Box{Vec3(-50, -50, -50), Vec3(50, 50, 50)});
  const Body inner = mesh_body("inner", BodyKind::kLink, kZSlide, box_mesh({-1, -1, -1}, {1, 1, 1}));
  EXPECT_EQ(stock.over(inner, way(axes(0), axes(5))).outcome, StockOutcome::kContact);
}

}  // namespace
}  // namespace swarf::collision
