// What a raw stock lacks within a design, against depths in closed form, and twins that lack nothing.
#include <gtest/gtest.h>

#include "mesh/mesh_check.h"
#include "proof/leftover_bound.h"
#include "proof/missing_bound.h"
#include "support/solids.h"

namespace missing_bound_test {
namespace {

using swarf::Box;
using swarf::Progress;
using swarf::TriMesh;
using swarf::Vec3;
using swarf::proof::MissingBound;
using swarf::proof::SolidDesign;

/// A block 40 x 30 x 10 mm, its top at z = 0, with a slot 10 wide and 4 deep along x through it.
TriMesh slotted_block(double floor = -4.0) {
  return swarf::test::towers({-20, 20}, {-15, -5, 5, 15}, -10,
                             [&](int, int j) { return j == 1 ? floor : 0.0; });
}

/// `body` with a closed void in it.
TriMesh with_void(TriMesh body, const Vec3& low, const Vec3& high) {
  TriMesh hole = swarf::test::block(low, high);
  const auto first = static_cast<uint32_t>(body.positions.size());
  body.positions.insert(body.positions.end(), hole.positions.begin(), hole.positions.end());
  for (const auto& t : hole.triangles) body.triangles.push_back({first + t[0], first + t[2], first + t[1]});
  return body;
}

MissingBound missing(const TriMesh& design, const TriMesh& raw, double limit_um = 2.0) {
  const SolidDesign body(design, 0.0);
  Progress silent;
  return swarf::proof::bound_missing({body, raw, limit_um * 1e-3, silent});
}

TEST(MissingBound, AStockFlushWithTheDesignLacksNothing) {
  for (const TriMesh& raw : {slotted_block(), swarf::test::block({-20, -15, -10}, {20, 15, 0}),
                             swarf::test::block({-25, -15, -12}, {20, 15, 3})}) {
    const MissingBound bound = missing(slotted_block(), raw);
    EXPECT_EQ(bound.found_mm, 0.0);
    EXPECT_LE(bound.bound_mm, 0.002);
  }
}

TEST(MissingBound, AClosedVoidIsToldToItsDepth) {
  // 1 mm below the floor of the slot, 3 below to the bottom of the block.
  const MissingBound bound = missing(slotted_block(), with_void(slotted_block(), {-3, -2, -7}, {3, 2, -5}));
  EXPECT_NEAR(bound.found_mm, 3.0, 3.1e-3);
  EXPECT_GE(bound.bound_mm, 3.0 - 1e-9);
  EXPECT_LE(bound.bound_mm, 3.1);
}

TEST(MissingBound, AVoidInMaterialThatIsCutAwayIsNone) {
  const TriMesh raw = with_void(swarf::test::block({-20, -15, -10}, {20, 15, 5}), {-3, -2, 1}, {3, 2, 4});
  EXPECT_EQ(missing(slotted_block(), raw).found_mm, 0.0);
}

TEST(MissingBound, ASlotOfTheStockThatIsTooDeepIsToldToTheDepth) {
  const MissingBound bound = missing(slotted_block(), slotted_block(-4.006));
  EXPECT_NEAR(bound.found_mm, 0.006, 2e-5);
  EXPECT_GE(bound.bound_mm, 0.006 - 1e-6);
}

// A ring round a block leaves posts at the corners of the stock: no bound lies below the farthest of them.
TEST(LeftoverBound, IsNotBelowWhatStandsFarOffTheCorners) {
  const SolidDesign design(swarf::test::block({-2, -2, -3}, {2, 2, 0}), 0.0);
  swarf::stock::Stock stock(Box{Vec3(-4, -4, -3), Vec3(4, 4, 0)}, 0.2);
  const auto line = [](const Vec3& a, const Vec3& b, uint32_t block) {
    return swarf::stock::Sweep{{a, Vec3::UnitZ()}, {b, Vec3::UnitZ()}, block};
  };
  const std::vector<swarf::stock::Sweep> ring{
      line({-3, -3, -3}, {3, -3, -3}, 0), line({3, -3, -3}, {3, 3, -3}, 1), line({3, 3, -3}, {-3, 3, -3}, 2),
      line({-3, 3, -3}, {-3, -3, -3}, 3)};
  const swarf::stock::CutterSolid cutter(1.0, 10.0);
  stock.cut(ring, cutter);
  const swarf::measure::SweepCutters cutters(cutter);
  Progress silent;
  const auto bound = swarf::proof::bound_leftover({design, ring, cutters, stock, 0.0, 0.010, 0.0, silent});
  EXPECT_GT(bound.found_mm, 2.0);
  EXPECT_GE(bound.bound_mm, 2.0 * std::sqrt(2.0) - 1e-6);
}

// A thin post stands off the corner of a block and higher than it: the corner of its top is the farthest
// place.
TEST(LeftoverBound, IsNotBelowTheTopOfAPostOffACorner) {
  const SolidDesign design(swarf::test::block({-2, -2, -3}, {2, 2, -1}), 0.0);
  swarf::stock::Stock stock(Box{Vec3(-2, -2, -3), Vec3(5.015, 5.015, 0)}, 0.2);
  std::vector<swarf::stock::Sweep> sweeps;
  const auto line = [&](const Vec3& a, const Vec3& b) {
    sweeps.push_back({{a, Vec3::UnitZ()}, {b, Vec3::UnitZ()}, static_cast<uint32_t>(sweeps.size())});
  };
  for (const double off : {3.0, 3.985}) {
    line({off, -8, -3.5}, {off, 8, -3.5});
    line({-8, off, -3.5}, {8, off, -3.5});
  }
  for (const double y : {-2.0, -1.0, 0.0, 1.0, 2.0}) line({-8, y, -1}, {3, y, -1});
  const swarf::stock::CutterSolid cutter(1.0, 10.0);
  stock.cut(sweeps, cutter);
  const swarf::measure::SweepCutters cutters(cutter);
  Progress silent;
  for (const double known : {4.2638}) {
    const auto bound =
        swarf::proof::bound_leftover({design, sweeps, cutters, stock, 0.0, 0.010, known, silent});
    EXPECT_GE(bound.bound_mm, std::hypot(std::hypot(3.015, 3.015), 1.0) - 1e-6)
        << "known " << known << " found " << bound.found_mm << " open " << bound.open;
  }
}

}  // namespace
}  // namespace missing_bound_test
