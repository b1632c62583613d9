// Contacts that the grid shows badly or not at all: shallower than a voxel, or with material thinner than
// one.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "base/rng.h"
#include "contact_run.h"

namespace swarf::sim::shallow_contacts_test {
namespace {

constexpr double kVoxel = 0.2;  // mm

TEST(ShallowContacts, AShankHalfAVoxelDeepIsNamed) {
  // Flutes of 0.5 mm, a slot 1 mm deep: the shank, of the flutes' diameter, ploughs 0.5 mm of solid.
  for (const double voxel : {0.1, 0.25, 0.5, 1.0}) {
    ContactRun run({flat_tool(4, 0.5, 60)}, {{-20, -20, -10}, {20, 20, 0}}, voxel);
    run.start({{-30, 0, 5}, Vec3::UnitZ()});
    run.move({-30, 0, -1});
    run.move({30, 0, -1});
    const ToolClearance& found = run.cut();
    ASSERT_EQ(found.events.size(), 1U) << voxel;
    EXPECT_EQ(found.events[0].part, "shank");
    EXPECT_EQ(found.events[0].first.element, 1);
    EXPECT_NEAR(found.events[0].depth_mm, 0.5, 0.1 * voxel) << voxel;
    ContactRun free({flat_tool(4, 1.0, 60)}, {{-20, -20, -10}, {20, 20, 0}}, voxel);
    free.start({{-30, 0, 5}, Vec3::UnitZ()});
    free.move({-30, 0, -1});
    free.move({30, 0, -1});
    EXPECT_TRUE(free.cut().events.empty()) << voxel;
  }
}

/// Two slots of D4 along X leave a wall between them, thinner than a voxel and anywhere between the grid
/// points; then a D4 tool comes over the wall, its edge at the slots' middles, `deep` below the wall's top.
struct Wall {
  double y, thickness, top, deep, slot_depth;
  bool with_shank;  ///< a feed move in which the shank, not the flutes, meets the wall

  static Wall of(uint64_t seed) {
    Rng rng(seed);
    return {rng.uniform(0.0, kVoxel),
            rng.uniform(0.005, 0.1),
            rng.uniform(0.0, kVoxel),
            rng.uniform(0.5 * kVoxel, 2.0 * kVoxel),
            3.0,
            seed % 2 == 0};
  }
  /// `below_top` < 0: that much above the wall.
  ContactRun run(double below_top) const {
    ContactRun run({flat_tool(4, 5, 60), flat_tool(4, 0.5, 60)}, {{-20, -20, -10}, {20, 20, top}}, kVoxel);
    const double middle = y + 2.0 + 0.5 * thickness, from_y[] = {y, y + 4.0 + thickness, middle};
    // The second tool's shank begins 0.5 mm above its tip; its flutes pass through the wall below.
    const double z[] = {-slot_depth, -slot_depth, with_shank ? top - 0.5 - below_top : top - below_top};
    run.start({{-30, y, -slot_depth}, Vec3::UnitZ()});
    for (int n = 0; n < 3; ++n) {
      const int tool = with_shank && n == 2 ? 1 : 0;
      if (n > 0) run.move({-30, from_y[n], z[n]}).tool = tool;
      run.move({30, from_y[n], z[n]}, n == 2 && !with_shank ? 0.0 : 20.0).tool = tool;
      if (n < 2) {
        run.move({30, from_y[n], 20});
        run.move({-30, from_y[n], 20});
      }
    }
    run.cut();
    return run;
  }
  std::string text() const {
    return fmt::format("{{{}, {}, {}, {}, {}, {}}}", y, thickness, top, deep, slot_depth, with_shank);
  }
};

class ThinWall : public testing::TestWithParam<uint64_t> {};

TEST_P(ThinWall, IsFoundAndItsTwinIsFree) {
  const Wall wall = Wall::of(GetParam());
  const ContactRun fault = wall.run(wall.deep);
  const std::vector<ContactEvent>& contacts = fault.result.clearance.events;
  const std::vector<BadCut>& cuts = fault.bad_cuts();
  ASSERT_EQ(contacts.size(), wall.with_shank ? 1U : 0U) << wall.text();
  ASSERT_EQ(cuts.size(), wall.with_shank ? 0U : 1U) << wall.text();
  const ContactEvent& event = wall.with_shank ? contacts[0] : cuts[0].event;
  EXPECT_EQ(event.first.element, 8) << wall.text();
  EXPECT_NEAR(event.depth_mm, wall.deep, 0.5 * kVoxel) << wall.text();
  const ContactRun twin = wall.run(-0.02);
  EXPECT_TRUE(twin.result.clearance.events.empty()) << wall.text();
  EXPECT_TRUE(twin.bad_cuts().empty()) << wall.text();
}

INSTANTIATE_TEST_SUITE_P(Seeds, ThinWall, testing::Range<uint64_t>(0, 40));

}  // namespace
}  // namespace swarf::sim::shallow_contacts_test
