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

TEST(StockBody, InsideTheMaterialIsAContact) {
  const machine::MachineScene scene = toy_machine();
  const StockBody stock(scene, Box{Vec3(-50, -50, -50), Vec3(50, 50, 50)});
  const Body inner = mesh_body("inner", BodyKind::kLink, kZSlide, box_mesh({-1, -1, -1}, {1, 1, 1}));
  EXPECT_EQ(stock.over(inner, way(axes(0), axes(5))).outcome, StockOutcome::kContact);
}

}  // namespace
}  // namespace swarf::collision
