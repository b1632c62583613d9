// Depth of an overlap with a stock as cut, a mesh of many facets: no corner is deeper than what is found. The
// oracle looks at every corner.
#include <gtest/gtest.h>

#include <algorithm>

#include "base/rng.h"
#include "collision/overlap_bound.h"
#include "stock/stock.h"
#include "unit/collision/toy_machine.h"

namespace swarf::collision {
namespace {

/// The deepest corner of the triangles of either body in the other.
double deepest_of_all_corners(const Encounter& pair, const BodyDepth& in_a, const BodyDepth& in_b,
                              const AxisValues& q) {
  double depth = 0.0;
  for (const Triangle& triangle : pair.b->triangles)
    for (const Vec3& corner : triangle) depth = std::max(depth, in_a.depth(pair.b_from_a.pose(q) * corner));
  for (const Triangle& triangle : pair.a->triangles)
    for (const Vec3& corner : triangle) depth = std::max(depth, in_b.depth(pair.a_from_b.pose(q) * corner));
  return depth;
}

TEST(OverlapBound, NoCornerOfAStockIsDeeper) {
  const machine::MachineScene scene = toy_machine();
  stock::Stock stock({Vec3(0, 0, 0), Vec3(12, 8, 6)}, 0.5);
  const std::vector<stock::Sweep> sweeps{
      {{Vec3(-5, 4, 3), Vec3::UnitZ()}, {Vec3(20, 4, 3), Vec3::UnitZ()}, 0}};
  stock.cut(sweeps, stock::CutterSolid(2.0, 30.0));
  const Body work = work_body(scene, "stock", BodyKind::kStock, stock.mesh());
  const BodyDepth in_work(work);
  Rng rng(3);
  int deep = 0;
  for (int i = 0; i < 60; ++i) {
    const double z = rng.uniform(-2.0, 7.0), wide = rng.uniform(0.5, 6.0);
    const Body bar =
        mesh_body("bar", BodyKind::kLink, kZSlide, box_mesh({0, 0, z}, {wide, 0.7 * wide, z + 20.0}));
    const BodyDepth in_bar(bar);
    const Encounter pair = encounter(scene, bar, work);
    const AxisValues q = axes(rng.uniform(-4.0, 12.0), rng.uniform(-4.0, 8.0));
    const double exact = deepest_of_all_corners(pair, in_bar, in_work, q);
    EXPECT_GE(deepest_overlap(pair, in_bar, in_work, q).depth_mm, exact - kDepthTolerance) << i;
    if (exact > 0.5) ++deep;
  }
  EXPECT_GT(deep, 20);
}

}  // namespace
}  // namespace swarf::collision
