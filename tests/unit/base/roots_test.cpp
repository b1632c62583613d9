#include "base/roots.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "base/rng.h"

namespace swarf {
namespace {

/// Coefficients of scale (t - r0)(t - r1)...
std::vector<double> with_roots(const std::vector<double>& roots, double scale) {
  std::vector<double> c{scale};
  for (const double r : roots) {
    c.push_back(0.0);
    for (size_t k = c.size(); k-- > 0;) c[k] = (k > 0 ? c[k - 1] : 0.0) - r * c[k];
  }
  return c;
}

TEST(UnitRoots, FindsThoseThatWerePutIn) {
  for (uint64_t seed = 0; seed < 2000; ++seed) {
    Rng rng(seed);
    const int degree = 1 + static_cast<int>(rng.next() % kRootDegreeMax);
    std::vector<double> put;
    for (int i = 0; i < degree; ++i) put.push_back(rng.uniform(-0.5, 1.5));
    std::sort(put.begin(), put.end());
    bool apart = true;
    for (int i = 0; i < degree; ++i) {
      const auto k = static_cast<size_t>(i);
      apart = apart && (i == 0 || put[k] - put[k - 1] > 0.02) && std::abs(put[k]) > 1e-6 &&
              std::abs(put[k] - 1.0) > 1e-6;
    }
    if (!apart) continue;
    std::vector<double> inside;
    std::copy_if(put.begin(), put.end(), std::back_inserter(inside),
                 [](double r) { return r > 0.0 && r < 1.0; });
    const UnitRoots found = unit_roots(with_roots(put, rng.uniform(1.0, 1e6)));
    ASSERT_EQ(static_cast<size_t>(found.count), inside.size()) << "seed " << seed;
    for (size_t i = 0; i < inside.size(); ++i)
      EXPECT_NEAR(found.all()[i], inside[i], 1e-8) << "seed " << seed;
  }
}

TEST(UnitRoots, EndsTouchingAndNothing) {
  EXPECT_EQ(unit_roots(std::vector<double>{}).count, 0);
  EXPECT_EQ(unit_roots(std::vector<double>{3.0}).count, 0);
  EXPECT_EQ(unit_roots(std::vector<double>(7, 0.0)).count, 0);
  EXPECT_EQ(unit_roots(std::vector<double>{1.0, 0.0, 1.0}).count, 0);
  const UnitRoots ends = unit_roots(std::vector<double>{0.0, -1.0, 1.0});
  ASSERT_EQ(ends.count, 2);
  EXPECT_EQ(ends.t[0], 0.0);
  EXPECT_EQ(ends.t[1], 1.0);
  // Leading zeros do not matter.
  const UnitRoots line = unit_roots(std::vector<double>{-1.0, 4.0, 0.0, 0.0, 0.0});
  ASSERT_EQ(line.count, 1);
  EXPECT_NEAR(line.t[0], 0.25, 1e-16);
}

}  // namespace
}  // namespace swarf
