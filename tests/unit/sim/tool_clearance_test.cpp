// Which part of a tool meets the stock: neck, shank and holder by their own shapes, in a block 30 mm high.
#include "sim/tool_clearance.h"

#include <gtest/gtest.h>

namespace swarf::sim {
namespace {

constexpr double kVoxel = 0.5;  // mm

/// Flutes D10 to 5 mm, neck D8 to 15 mm, shank D8 to 30 mm, holder from there.
cutter::Cutter slender() {
  cutter::Cutter c;
  c.flute_length_mm = 5.0;
  c.neck_diameter_mm = 8.0;
  c.neck_length_mm = 10.0;
  c.shank_diameter_mm = 8.0;
  c.length_mm = 30.0;
  c.holder = {{20.0, 20.0, 20.0}};
  return c;
}

stock::Stock block() {
  return stock::Stock({{-20, -20, 0}, {20, 20, 30}}, kVoxel);
}

stock::Sweep plunge(double depth_z) {
  return {{{0, 0, 45}, Vec3::UnitZ()}, {{0, 0, depth_z}, Vec3::UnitZ()}, 7};
}

/// After the flutes have drilled down to `tip_z` and the tool stands there.
ToolClearance drilled(const cutter::Cutter& cutter, double tip_z) {
  stock::Stock stock = block();
  const std::vector<stock::Sweep> sweeps{plunge(tip_z)};
  stock.cut(sweeps, stock::CutterSolid(cutter));
  ToolClearanceCheck check(std::span(&cutter, 1), kVoxel);
  check.check(stock, sweeps, 0);
  return check.result();
}

TEST(ToolClearance, ANeckInsideTheHoleIsClear) {
  const ToolClearance found = drilled(slender(), 17.0);
  EXPECT_EQ(found.contacts, 0U);
  EXPECT_EQ(found.checked_poses, 1U);
  EXPECT_NEAR(found.nearest_mm, 1.0, 0.05) << "a hole of 10 around a neck of 8 mm";
}

TEST(ToolClearance, TheNeckIsNamed) {
  cutter::Cutter thick = slender();
  thick.neck_diameter_mm = 14.0;
  const ToolClearance found = drilled(thick, 17.0);
  EXPECT_EQ(found.contacts, 1U);
  EXPECT_EQ(found.part, "neck");
  EXPECT_EQ(found.first_block, 7U);
}

TEST(ToolClearance, TheShankIsNamed) {
  cutter::Cutter thick = slender();
  thick.shank_diameter_mm = 14.0;
  EXPECT_EQ(drilled(thick, 17.0).contacts, 0U) << "it begins 2 mm above the block";
  const ToolClearance found = drilled(thick, 12.0);
  EXPECT_EQ(found.contacts, 1U);
  EXPECT_EQ(found.part, "shank");
}

TEST(ToolClearance, TheHolderIsNamed) {
  EXPECT_EQ(drilled(slender(), 1.0).contacts, 0U) << "its face stands 1 mm above the block";
  const ToolClearance found = drilled(slender(), -2.0);
  EXPECT_EQ(found.contacts, 1U);
  EXPECT_EQ(found.part, "holder");
}

TEST(ToolClearance, AConicalHolderIsACone) {
  // Its face stands 4 mm inside a hole of 10 mm: a slim cone passes, one that opens by 45 degrees does not.
  cutter::Cutter slim = slender(), wide = slender();
  slim.holder = {{8.0, 9.0, 6.0}, {20.0, 20.0, 20.0}};
  wide.holder = {{8.0, 20.0, 6.0}, {20.0, 20.0, 20.0}};
  EXPECT_EQ(drilled(slim, -4.0).contacts, 0U);
  const ToolClearance found = drilled(wide, -4.0);
  EXPECT_EQ(found.contacts, 1U);
  EXPECT_EQ(found.part, "holder");
}

TEST(ToolClearance, AShoulderThatFacesTheStockIsSeen) {
  // The holder is wider than the block: its wall passes outside, only its level face comes down on it.
  cutter::Cutter c = slender();
  c.holder = {{60.0, 60.0, 20.0}};
  const ToolClearance found = drilled(c, -1.5);
  EXPECT_EQ(found.contacts, 1U);
  EXPECT_EQ(found.part, "holder");
}

TEST(ToolClearance, TheTopOfADiscIsTheCuttersOwn) {
  // A T-slot cutter beside its slot: the disc's upper face cuts, the neck behind it is clear.
  cutter::Cutter c = slender();
  c.shape = cutter::Shape::kWoodruff;
  c.diameter_mm = 16.0;
  c.flute_length_mm = 4.0;
  stock::Stock stock = block();
  cutter::Cutter slot = slender();
  const std::vector<stock::Sweep> cuts{{{{-30, 0, 12}, Vec3::UnitZ()}, {{30, 0, 12}, Vec3::UnitZ()}, 1}};
  slot.flute_length_mm = 25.0;
  slot.length_mm = 40.0;
  stock.cut(cuts, stock::CutterSolid(slot));
  stock.cut(cuts, stock::CutterSolid(c));
  ToolClearanceCheck check(std::span(&c, 1), kVoxel);
  const std::vector<stock::Sweep> stand{{cuts[0].start, {{0, 0, 12}, Vec3::UnitZ()}, 2}};
  check.check(stock, stand, 0);
  EXPECT_EQ(check.result().contacts, 0U);
  EXPECT_NEAR(check.result().nearest_mm, 1.0, 0.05);
}

}  // namespace
}  // namespace swarf::sim
