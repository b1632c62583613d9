// No sweep near a point is missed, against every sweep looked at.
#include "measure/near_sweeps.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "stock/contact/convex_contact.h"
#include "unit/stock/stock_test_support.h"

namespace swarf::measure {
namespace {

TEST(NearSweeps, MissesNoneThatIsNear) {
  Rng rng(417);
  const stock::CutterSolid cutter(5.0, 20.0);
  std::vector<stock::Sweep> sweeps;
  for (uint32_t n = 0; n < 300; ++n) {
    sweeps.push_back(stock::random_sweep(rng, 60.0, 30.0, n % 3 == 0 ? 0.6 : 0.0));
    sweeps.back().block = n;
  }
  const SweepCutters cutters(cutter);
  const NearSweeps near(sweeps, cutters);
  size_t found = 0;
  for (int k = 0; k < 200; ++k) {
    const Vec3 point = 70.0 * rng.direction() * rng.uniform();
    const double distance = rng.uniform(0.1, 3.0);
    const std::vector<uint32_t> list = near.around(point, distance);
    EXPECT_TRUE(std::is_sorted(list.begin(), list.end()));
    for (const stock::Sweep& sweep : sweeps) {
      if (stock::swept_contact(point, stock::sweep_map(sweep), cutter).distance_mm > distance) continue;
      ++found;
      EXPECT_TRUE(std::binary_search(list.begin(), list.end(), sweep.block))
          << "point " << stock::text(point) << " distance " << distance << " " << stock::text(sweep);
    }
  }
  EXPECT_GT(found, 500U);
}

/// As sim::EarlierCuts keeps them: what is near twice as far about a centre serves all points near it.
TEST(NearSweeps, WhatIsKeptAboutAPointServesThoseNear) {
  Rng rng(418);
  const stock::CutterSolid cutter(5.0, 20.0);
  std::vector<stock::Sweep> sweeps;
  for (uint32_t n = 0; n < 300; ++n) {
    sweeps.push_back(stock::random_sweep(rng, 60.0, 30.0, n % 3 == 0 ? 0.6 : 0.0));
    sweeps.back().block = n;
  }
  const SweepCutters cutters(cutter);
  const NearSweeps near(sweeps, cutters);
  size_t found = 0;
  for (int k = 0; k < 200; ++k) {
    const Vec3 centre = 70.0 * rng.direction() * rng.uniform();
    const double distance = rng.uniform(0.1, 3.0);
    const auto end = static_cast<size_t>(rng.uniform(0.0, 300.0));
    const Vec3 point = centre + rng.uniform(0.0, distance) * rng.direction();
    std::vector<uint32_t> list;
    for (const NearSweeps::Near& one : near.near(centre, 2.0 * distance, end))
      if (one.capsule.may_reach(point, distance)) list.push_back(one.number);
    EXPECT_TRUE(list.empty() || list.back() < end);
    for (size_t n = 0; n < end; ++n) {
      if (stock::swept_contact(point, stock::sweep_map(sweeps[n]), cutter).distance_mm > distance) continue;
      ++found;
      EXPECT_TRUE(std::binary_search(list.begin(), list.end(), sweeps[n].block))
          << "point " << stock::text(point) << " about " << stock::text(centre) << " distance " << distance
          << " " << stock::text(sweeps[n]);
    }
  }
  EXPECT_GT(found, 200U);
}

}  // namespace
}  // namespace swarf::measure
