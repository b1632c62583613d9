// Bounds of comparisons: errors of single facets, how close they come for how much work, and that no place
// lies beyond them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/rng.h"
#include "measure/flat_piece.h"
#include "measure/part_comparison.h"
#include "mesh/mesh_check.h"
#include "support/bored_plate.h"
#include "support/solids.h"

namespace swarf::measure {
namespace {

constexpr double kFloatsUm = 0.01;

/// Two meshes and what is known of them.
struct Pair {
  Pair(const TriMesh& stock_mesh, const TriMesh& design_mesh, double limit_um, double pitch_mm)
      : stock(stock_mesh), design(design_mesh) {
    input.stock = &stock;
    input.design = &design;
    input.excess = input.gouge = 1e-3 * limit_um;
    input.pitch = pitch_mm;
  }
  mesh::SignedDistance stock, design;
  ComparisonInput input;
};

TriMesh plain_block() {
  return test::block({-20, -20, 0}, {20, 20, 10});
}

/// Against a block whose top alone may be off by 2 um.
PartComparison against_a_block_of_uncertain_top(const TriMesh& stock, double limit_um) {
  Pair pair(stock, plain_block(), limit_um, 1.0);
  for (uint32_t t = 0; t < pair.design.mesh().triangles.size(); ++t)
    pair.input.design_errors.push_back(pair.design.face_normal(t).z() > 0.5 ? 0.002 : 0.0);
  return compare_parts(pair.input);
}

TEST(ComparisonBounds, CountTheErrorOfTheFacetThatIsSeen) {
  const PartComparison same = against_a_block_of_uncertain_top(plain_block(), 10.0);
  for (const DeviationExtreme* extreme : {&same.excess, &same.gouge}) {
    EXPECT_EQ(extreme->um, 0.0);
    EXPECT_GE(extreme->bound_um, 2.0);
    EXPECT_LE(extreme->bound_um, 2.06);
  }
  const PartComparison low =
      against_a_block_of_uncertain_top(test::block({-20, -20, -0.005}, {20, 20, 10}), 6.0);
  EXPECT_NEAR(low.excess.um, 5.0, kFloatsUm);
  EXPECT_GE(low.excess.bound_um, 5.0 - kFloatsUm);
  EXPECT_LE(low.excess.bound_um, 5.06);  // its facets are exact: within the limit
  const TriMesh high = test::block({-20, -20, 0}, {20, 20, 10.005});
  for (const double limit_um : {6.0, 7.2}) {
    const PartComparison r = against_a_block_of_uncertain_top(high, limit_um);
    EXPECT_NEAR(r.excess.um, 5.0, kFloatsUm);
    EXPECT_GE(r.excess.bound_um, 7.0 - kFloatsUm) << limit_um;
    EXPECT_LE(r.excess.bound_um, 7.1) << limit_um;
  }
}

/// A limit far away is no reason to leave a bound far away.
TEST(ComparisonBounds, AreCloseToWhatIsFoundWhereLimitsAreWide) {
  const TriMesh plate = test::OrdinaryPlate{64}.mesh();
  Pair pair(test::shifted(plate, {3e-3, 2e-3, 1e-3}), plate, 1000.0, 20.0);
  const PartComparison r = compare_parts(pair.input);
  constexpr double kShiftUm = 3.741658;
  for (const DeviationExtreme* extreme : {&r.excess, &r.gouge}) {
    EXPECT_GE(extreme->um, 3.0 - kFloatsUm);
    EXPECT_LE(extreme->um, kShiftUm + kFloatsUm);
    EXPECT_GE(extreme->bound_um, extreme->um);
    EXPECT_LE(extreme->bound_um, kShiftUm + 0.6);
  }
}

/// With cells of half the part, as many cuts as the first attempt allows prove little; the last ones do.
TEST(ComparisonBounds, OfFewLargeCellsReachTheLimit) {
  constexpr double kRadius = 25.0, kShiftUm = 7.0;
  const TriMesh design = test::sphere(kRadius, {0, 0, 0}, 120, 60);
  const TriMesh block = test::block({-20, -20, 0}, {20, 20, 10});
  const TriMesh lines = test::towers({-20, -19.99, -7, 0.013, 11, 20}, {-20, 3, 20}, 0,
                                     [](int i, int j) { return i == 2 && j == 0 ? 9.996 : 10.0; });
  Pair round(test::sphere(kRadius, {1e-3 * kShiftUm, 0, 0}, 120, 60), design, 7.1, 10.0);
  const PartComparison shifted = compare_parts(round.input);
  EXPECT_LE(shifted.excess.bound_um, 7.1);
  EXPECT_LE(shifted.gouge.bound_um, 7.1);
  EXPECT_GE(shifted.excess.bound_um, kShiftUm - 0.05);
  for (const double limit_um : {3.9, 4.1}) {
    Pair stepped(lines, block, limit_um, 60.0);
    const PartComparison r = compare_parts(stepped.input);
    EXPECT_NEAR(r.gouge.um, 4.0, kFloatsUm);
    EXPECT_GE(r.gouge.bound_um, 4.0 - kFloatsUm);
    EXPECT_LE(r.gouge.bound_um, 4.06);
    EXPECT_LE(r.excess.bound_um, 0.55);
  }
}

/// Nothing is proven below what the errors come to, and no work goes into it.
TEST(ComparisonBounds, ErrorsBeyondTheLimitCostNoWork) {
  Pair pair(test::sphere(25, {0.002, 0, 0}, 160, 80), test::sphere(25, {0, 0, 0}, 160, 80), 3.0, 0.8);
  pair.input.design_error = 0.005;
  const PartComparison r = compare_parts(pair.input);
  for (const DeviationExtreme* extreme : {&r.excess, &r.gouge}) {
    EXPECT_GE(extreme->bound_um, extreme->um + 5.0 - 0.1);
    EXPECT_LE(extreme->bound_um, extreme->um + 5.0 + 0.1);
  }
  for (const SideSummary* side : {&r.stock, &r.design}) EXPECT_LE(side->proof_samples, 8 * side->samples);
}

/// Ever more work brings bounds no closer to less than they are: it ends.
TEST(ComparisonBounds, TheWorkOfAllCellsTogetherIsLimited) {
  constexpr size_t kEachAtFirst = 20, kAllAfterwards = 1'400'000;
  Pair pair(test::sphere(25, {0.02, 0, 0}, 300, 150), test::sphere(25, {0, 0, 0}, 301, 151), 21.0, 0.3);
  // Every other facet is uncertain: the cells beside them are proven of them too.
  for (uint32_t t = 0; t < pair.design.mesh().triangles.size(); ++t)
    pair.input.design_errors.push_back(t % 2 == 0 ? 0.0 : 0.003);
  const PartComparison r = compare_parts(pair.input);
  for (const SideSummary* side : {&r.stock, &r.design})
    EXPECT_LE(side->proof_samples, kEachAtFirst * side->samples + kAllAfterwards);
  EXPECT_GE(r.excess.bound_um, r.excess.um);
  EXPECT_LE(r.excess.bound_um, r.excess.um + 3.2);
}

TEST(ComparisonBounds, DoNotDependOnTheNumberOfThreads) {
  const TriMesh plate = test::OrdinaryPlate{48}.mesh();
  Pair pair(test::shifted(plate, {3e-4, 2e-4, 1e-4}), plate, 0.3, 3.0);
  std::array<PartComparison, 2> found;
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    found[threads == 1 ? 0 : 1] = compare_parts(pair.input);
  }
  set_thread_count(0);
  const auto expect_same = [](const DeviationExtreme& a, const DeviationExtreme& b) {
    EXPECT_EQ(a.um, b.um);
    EXPECT_EQ(a.bound_um, b.bound_um);
    EXPECT_EQ(a.place, b.place);
    EXPECT_EQ(a.bound_place, b.bound_place);
  };
  expect_same(found[0].excess, found[1].excess);
  expect_same(found[0].gouge, found[1].gouge);
  EXPECT_EQ(found[0].stock.proof_samples, found[1].stock.proof_samples);
  EXPECT_EQ(found[0].design.proof_samples, found[1].design.proof_samples);
}

/// Greatest deviations of random places of both surfaces, um: excess, gouge.
std::array<double, 2> searched(const Pair& pair, Rng& rng, int places) {
  std::array<double, 2> worst{};
  const auto place_of = [&](const mesh::SignedDistance& mesh) {
    const auto t = static_cast<uint32_t>(rng.next() % mesh.mesh().triangles.size());
    // Corners and sides as well as what lies between.
    double u = std::clamp(rng.uniform(-0.3, 1.3), 0.0, 1.0), v = std::clamp(rng.uniform(-0.3, 1.3), 0.0, 1.0);
    if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
    return Vec3(mesh.corner(t, 0) + u * (mesh.corner(t, 1) - mesh.corner(t, 0)) +
                v * (mesh.corner(t, 2) - mesh.corner(t, 0)));
  };
  for (int i = 0; i < places; ++i) {
    for (const double um : {1e3 * pair.design.at(place_of(pair.stock)).distance_mm,
                            -1e3 * pair.stock.at(place_of(pair.design)).distance_mm}) {
      worst[0] = std::max(worst[0], um);
      worst[1] = std::max(worst[1], -um);
    }
  }
  return worst;
}

TriMesh turned_by(TriMesh mesh, const Mat3& turn) {
  for (auto& p : mesh.positions) {
    const Vec3 q = turn * Vec3(p[0], p[1], p[2]);
    for (size_t k = 0; k < 3; ++k) p[k] = static_cast<float>(q[static_cast<Eigen::Index>(k)]);
  }
  return mesh;
}

/// Thin walls and narrow slots, in mm and in inches, turned so that nothing lies along an axis, half a
/// micrometre to 50 um apart. Failing seeds are printed.
TEST(ComparisonBounds, HoldForThinWallsAtAnyAngleAndScale) {
  constexpr double kLeftOpenUm = 0.5;
  for (uint64_t seed = 1; seed <= 24; ++seed) {
    Rng rng(seed);
    const double scale = seed % 3 == 0 ? 25.4 : seed % 3 == 1 ? 1.0 : 0.1;
    const double apart = std::pow(10.0, rng.uniform(-3.3, -1.3));
    const double wall = rng.uniform(0.01, 0.1);
    std::vector<double> x{0, 2, 2 + wall, 3, 3 + wall, 5}, y{0, 1, 4}, moved = x;
    for (double& line : moved) line += apart / scale * rng.uniform(-0.4, 0.4);
    std::array<std::array<double, 2>, 5> heights{};
    for (auto& row : heights) {
      for (double& h : row) h = rng.uniform(1, 3);
    }
    auto other = heights;
    other[rng.next() % 5][rng.next() % 2] += apart / scale * rng.uniform(-1, 1);
    TriMesh stock = test::towers(moved, y, 0, [&](int i, int j) { return other[i][j]; });
    TriMesh design = test::towers(x, y, 0, [&](int i, int j) { return heights[i][j]; });
    const Vec3 axis = Vec3(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(0.1, 1)).normalized();
    const Mat3 turn = Eigen::AngleAxisd(rng.uniform(0, 3), axis).toRotationMatrix();
    test::scale(stock, scale);
    test::scale(design, scale);
    Pair pair(turned_by(stock, turn), turned_by(design, turn), 5.0, 0.5 * scale);
    const PartComparison r = compare_parts(pair.input);
    const auto [excess, gouge] = searched(pair, rng, 6000);
    EXPECT_GE(r.excess.bound_um, excess - 1e-6) << "seed " << seed;
    EXPECT_GE(r.gouge.bound_um, gouge - 1e-6) << "seed " << seed;
    EXPECT_LE(r.excess.bound_um, std::max(5.0, 1.003 * r.excess.um) + kLeftOpenUm) << "seed " << seed;
    EXPECT_LE(r.gouge.bound_um, std::max(5.0, 1.003 * r.gouge.um) + kLeftOpenUm) << "seed " << seed;
  }
}

double area_of_piece(const FlatPiece& piece) {
  Vec3 twice = Vec3::Zero();
  for (size_t i = 0; i < piece.count; ++i)
    twice += piece.points[i].cross(piece.points[(i + 1) % piece.count]);
  return 0.5 * twice.norm();
}

TEST(FlatPiece, IsCutIntoPartsOfItsWholeArea) {
  Rng rng(7);
  std::vector<FlatPiece> pieces{FlatPiece({Vec3(0, 0, 0), Vec3(9, 1, 0), Vec3(2, 7, 0)})};
  const double whole = area_of_piece(pieces[0]);
  for (int n = 0; n < 200; ++n) {
    const FlatPiece piece = pieces[rng.next() % pieces.size()];
    const Vec3 normal(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
    const CutPlane plane{normal, normal.dot(piece.centre()) + rng.uniform(-0.3, 0.3)};
    const auto parts = n % 3 == 0 ? std::optional(halves_of(piece)) : cut(piece, plane, 1e-7);
    if (!parts) continue;
    double sum = 0.0;
    for (const FlatPiece& part : *parts) {
      EXPECT_GE(part.count, 3U);
      EXPECT_LE(part.radius(), 2.0 * piece.radius());
      sum += area_of_piece(part);
      pieces.push_back(part);
    }
    ASSERT_NEAR(sum, area_of_piece(piece), 1e-12 * whole);
  }
  EXPECT_GT(pieces.size(), 100U);
}

}  // namespace
}  // namespace swarf::measure
