// Which part of a tool meets the stock: neck, shank and holder by their own shapes, in a block 30 mm high.
#include "sim/run/tool_clearance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "contact_run.h"

namespace swarf::sim::tool_clearance_test {
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

/// The flutes drill down to `tip_z` in a block 30 mm high, whatever follows them.
ToolClearance drilled(const cutter::Cutter& cutter, double tip_z) {
  ContactRun run({cutter}, {{-20, -20, 0}, {20, 20, 30}}, kVoxel);
  run.start({{0, 0, 45}, Vec3::UnitZ()});
  run.move({0, 0, tip_z});
  return run.cut();
}

/// One event of the part, so deep (to a voxel).
void expect_contact(const ToolClearance& found, const char* part, double depth_mm) {
  ASSERT_EQ(found.events.size(), 1U);
  EXPECT_EQ(found.events[0].part, part);
  EXPECT_NEAR(found.events[0].depth_mm, depth_mm, kVoxel);
  EXPECT_EQ(found.nearest_mm, 0.0);
}

TEST(ToolClearance, ANeckInsideTheHoleIsClear) {
  const ToolClearance found = drilled(slender(), 17.0);
  EXPECT_TRUE(found.events.empty());
  EXPECT_EQ(found.checked_sweeps, 1U);
  EXPECT_NEAR(found.nearest_mm, 1.0, 0.05) << "a hole of 10 around a neck of 8 mm";
}

TEST(ToolClearance, TheNeckIsNamed) {
  cutter::Cutter thick = slender();
  thick.neck_diameter_mm = 14.0;
  // Its lower end comes to 17 + 5, 8 mm below the block's face.
  expect_contact(drilled(thick, 17.0), "neck", 8.0);
}

TEST(ToolClearance, TheShankIsNamed) {
  cutter::Cutter thick = slender();
  thick.shank_diameter_mm = 14.0;
  EXPECT_TRUE(drilled(thick, 17.0).events.empty()) << "it begins 2 mm above the block";
  expect_contact(drilled(thick, 12.0), "shank", 3.0);
}

TEST(ToolClearance, TheHolderIsNamed) {
  EXPECT_TRUE(drilled(slender(), 1.0).events.empty()) << "its face stands 1 mm above the block";
  expect_contact(drilled(slender(), -2.0), "holder", 2.0);
}

TEST(ToolClearance, AConicalHolderIsACone) {
  // Its face stands 4 mm inside a hole of 10 mm: a slim cone passes, one that opens by 45 degrees does not.
  cutter::Cutter slim = slender(), wide = slender();
  slim.holder = {{8.0, 9.0, 6.0}, {20.0, 20.0, 20.0}};
  wide.holder = {{8.0, 20.0, 6.0}, {20.0, 20.0, 20.0}};
  EXPECT_TRUE(drilled(slim, -4.0).events.empty());
  const ToolClearance found = drilled(wide, -4.0);
  ASSERT_EQ(found.events.size(), 1U);
  EXPECT_EQ(found.events[0].part, "holder");
}

TEST(ToolClearance, AShoulderThatFacesTheStockIsSeen) {
  // The holder is wider than the block: its wall passes outside, only its level face comes down on it.
  cutter::Cutter c = slender();
  c.holder = {{60.0, 60.0, 20.0}};
  expect_contact(drilled(c, -1.5), "holder", 1.5);
}

TEST(ToolClearance, TheTopOfADiscIsTheCuttersOwn) {
  // A T-slot cutter in its slot: the disc's upper face cuts, the neck behind it is clear.
  cutter::Cutter disc = slender(), slot = slender();
  disc.shape = cutter::Shape::kWoodruff;
  disc.diameter_mm = 16.0;
  disc.flute_length_mm = 4.0;
  slot.flute_length_mm = 25.0;
  slot.neck_length_mm = 0.0;
  slot.length_mm = 40.0;
  ContactRun run({slot, disc}, {{-20, -20, 0}, {20, 20, 30}}, kVoxel);
  run.start({{-40, 0, 12}, Vec3::UnitZ()});
  run.move({40, 0, 12});
  run.start({{-40, 0, 12}, Vec3::UnitZ()});
  run.move({40, 0, 12}).tool = 1;
  EXPECT_TRUE(run.cut().events.empty());
  EXPECT_NEAR(run.result.clearance.nearest_mm, 1.0, 0.05) << "a slot of 10 around necks of 8 mm";
}

/// Flutes of 5 mm, D8, a slot through a block whose face is z = 0.
ContactRun slot_run(double voxel_mm, double depth, int blocks) {
  ContactRun run({flat_tool(8, 5, 60)}, {{-20, -20, -10}, {20, 20, 0}}, voxel_mm);
  run.start({{-30, 0, 5}, Vec3::UnitZ()});
  run.move({-30, 0, -depth});
  for (int i = 1; i <= blocks; ++i) run.move({-30.0 + 60.0 * i / blocks, 0, -depth});
  run.move({30, 0, 20}, 0.0);
  return run;
}

TEST(ToolClearance, AShankThatPloughsBetweenTheEndsOfALongBlockIsFound) {
  for (const double voxel : {0.16, 0.2, 0.5, 0.7}) {
    for (const int blocks : {1, 12}) {  // collinear ones are merged into one sweep
      ContactRun run = slot_run(voxel, 9.0, blocks);
      const ToolClearance& found = run.cut();
      ASSERT_EQ(found.events.size(), 1U) << voxel;
      const ContactEvent& event = found.events[0];
      EXPECT_EQ(event.part, "shank");
      EXPECT_NEAR(event.depth_mm, 4.0, voxel) << voxel;
      EXPECT_NEAR(event.deepest_W.z(), -4.0, voxel);
      // The shank's front meets the block with its axis at -24, its back leaves it at 24.
      EXPECT_EQ(event.first.element, blocks == 1 ? 1 : 2) << "from -25 to -20";
      EXPECT_EQ(event.last_element, blocks == 1 ? 1 : 11) << "from 20 to 25";
    }
  }
}

TEST(ToolClearance, ShallowSlotsAndOpenOnesAreFree) {
  ContactRun shallow = slot_run(0.5, 5.0, 3);
  EXPECT_TRUE(shallow.cut().events.empty());
  // In steps of the flutes' length: the shank finds its way open.
  ContactRun steps({flat_tool(8, 5, 60)}, {{-20, -20, -10}, {20, 20, 0}}, 0.5);
  steps.start({{-30, 0, -4.5}, Vec3::UnitZ()});
  steps.move({30, 0, -4.5});
  steps.move({30, 0, -9});
  steps.move({-30, 0, -9});
  EXPECT_TRUE(steps.cut().events.empty());
}

TEST(ToolClearance, DepthDoesNotEndAtTheBand) {
  // Shank D4 in solid 25 mm deep, band 0.6 mm; the block is 60 wide.
  ContactRun run({flat_tool(4, 5, 80)}, {{-30, -30, -60}, {30, 30, 0}}, 0.4);
  run.start({{-40, 0, -30}, Vec3::UnitZ()});
  run.move({40, 0, -30});
  expect_contact(run.cut(), "shank", 25.0);
}

TEST(ToolClearance, APlateThinnerThanTheBandIsFound) {
  // Two voxels thick; the shank goes through it 3 mm above its lower end.
  for (const double thickness : {1.0, 0.6}) {
    ContactRun run({flat_tool(8, 5, 60)}, {{-20, -20, -thickness}, {20, 20, 0}}, 0.5);
    run.start({{-30, 0, -8}, Vec3::UnitZ()});
    run.move({30, 0, -8});
    expect_contact(run.cut(), "shank", 3.0);
  }
}

TEST(ToolClearance, ATurnOnTheSpotIsFollowedAllTheWay) {
  // The tip stands beside the block; the shank, leaned by 40 degrees, swings over it and out again.
  const auto leaned = [](double azimuth) {
    const double lean = 40.0 * kPi / 180.0;
    return ToolPose{{-28, 0, -20},
                    {std::sin(lean) * std::cos(azimuth), std::sin(lean) * std::sin(azimuth), std::cos(lean)}};
  };
  ContactRun run({flat_tool(8, 5, 60)}, {{-20, -20, -40}, {20, 20, 0}}, 0.5);
  run.start(leaned(-2.2));
  run.turn(leaned(0.0));
  run.turn(leaned(2.2));
  const ToolClearance& found = run.cut();
  ASSERT_GE(found.events.size(), 1U);
  EXPECT_EQ(found.events[0].part, "shank");
  EXPECT_EQ(found.events[0].first.element, 0);
  EXPECT_EQ(found.events[0].last_element, 1);
}

TEST(ToolClearance, EachToolAndEachPartHasItsOwnEvents) {
  ContactRun run({flat_tool(8, 5, 20), flat_tool(6, 5, 60)}, {{-20, -20, -30}, {20, 20, 0}}, 0.5);
  run.start({{-30, 0, -25}, Vec3::UnitZ()});
  run.move({30, 0, -25});  // shank 20 mm and holder 5 mm deep
  run.start({{30, 14, -9}, Vec3::UnitZ()});
  run.move({-30, 14, -9}).tool = 1;
  const ToolClearance& found = run.cut();
  ASSERT_EQ(found.events.size(), 3U);
  EXPECT_EQ(found.events[0].part + found.events[1].part + found.events[2].part, "shankholdershank");
  EXPECT_EQ(found.events[2].tool, 1);
  EXPECT_NEAR(found.events[1].depth_mm, 5.0, 0.5);
  EXPECT_NEAR(found.events[2].depth_mm, 4.0, 0.5);
}

TEST(ToolClearance, SurvivesAStockFile) {
  ContactRun run = slot_run(0.5, 9.0, 3);
  const ToolClearance& found = run.cut();
  ToolClearance back;
  ASSERT_TRUE(parse_clearance(clearance_text(found), back));
  EXPECT_EQ(clearance_text(back), clearance_text(found));
  EXPECT_EQ(back.events.size(), 1U);
  EXPECT_FALSE(parse_clearance("1 2 3", back));
  EXPECT_FALSE(parse_clearance("1 0 1.5 0.5 2;shank 0 1;", back));
}

}  // namespace
}  // namespace swarf::sim::tool_clearance_test
