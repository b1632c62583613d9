// The leaf kernel for any cutter against the double-precision contact, and its instruction sets bit by bit.
#include "stock/level_set/convex_leaf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "cutter_shapes.h"
#include "stock/contact/convex_contact.h"
#include "stock/level_set/leaf_kernel.h"
#include "stock_test_support.h"

namespace swarf::stock::convex_leaf_test {
namespace {

constexpr double kVoxel = 0.1, kBand = 0.3;

struct Case {
  CutterSolid cutter;
  Sweep sweep;
  LeafPlace place;
};

/// A leaf near the path of a point of the cutter's outline.
LeafPlace near_surface(Rng& rng, const CutterSolid& cutter, const Sweep& sweep) {
  const cutter::ConvexPiece& piece = cutter.pieces.front();
  const double t = rng.uniform();
  const Vec3 tip = (1.0 - t) * sweep.start.tip_W + t * sweep.end.tip_W;
  const Vec3 axis = ((1.0 - t) * sweep.start.axis_W + t * sweep.end.axis_W).normalized();
  const Vec3 side = axis.cross(rng.direction()).normalized();
  Vec3 place = tip + piece.high * rng.uniform() * axis + piece.radius * rng.uniform() * side;
  if (rng.uniform() < 0.5) place = tip + piece.radius * rng.uniform() * side;
  return {place + 0.8 * rng.direction() * rng.uniform() - Vec3::Constant(3.5 * kVoxel), kVoxel, kBand};
}

std::string describe(const Case& c) {
  return fmt::format("{} leaf at {} of {}", text(c.sweep), text(c.place.first_W),
                     text(c.cutter.pieces.front()));
}

struct Comparison {
  double error = 0.0;        ///< greatest difference between a leaf cut out of solid and swept_contact, mm
  bool has_surface = false;  ///< the swept surface passes through the leaf
};

Comparison compare(const Case& c) {
  const cutter::ConvexPiece& piece = c.cutter.pieces.front();
  const SweepMap map = sweep_map(c.sweep);
  float values[kLeafVoxels];
  std::fill(std::begin(values), std::end(values), static_cast<float>(-kBand));
  cut_leaf_by_piece(values, c.place, map, piece, kAllSlices);
  Comparison comparison;
  for (int n = 0; n < kLeafVoxels; ++n) {
    const Vec3 x = c.place.first_W + kVoxel * Vec3(n / 64, n / 8 % 8, n % 8);
    const double exact = std::clamp(-swept_contact(x, map, c.cutter).distance_mm, -kBand, kBand);
    comparison.error = std::max(comparison.error, std::abs(exact - values[n]));
    comparison.has_surface |= exact * values[0] < 0.0;
  }
  return comparison;
}

Case random_case(Rng& rng, double travel, double turn_rad) {
  Case c{solid_of({random_piece(rng)}), random_sweep(rng, 20.0, travel, turn_rad), {}};
  c.place = near_surface(rng, c.cutter, c.sweep);
  return c;
}

void expect_within_bound(uint64_t seed, double travel, double turn_rad) {
  Rng rng(seed);
  int surfaces = 0;
  for (int n = 0; n < 400; ++n) {
    const Case c = random_case(rng, travel, turn_rad);
    const Comparison comparison = compare(c);
    surfaces += comparison.has_surface ? 1 : 0;
    ASSERT_LE(comparison.error, convex_kernel_error_mm(c.cutter.pieces.front(), kVoxel, kBand))
        << "seed " << seed << " case " << n << ": " << describe(c);
  }
  EXPECT_GT(surfaces, 50);
}

TEST(ConvexLeaf, ErrorStaysWithinItsBoundForTicks) {
  expect_within_bound(81, 0.05, 0.01);
}
TEST(ConvexLeaf, ErrorStaysWithinItsBoundForBlocks) {
  expect_within_bound(82, 1.0, 0.05);
}
TEST(ConvexLeaf, ErrorStaysWithinItsBoundForLongBlocks) {
  expect_within_bound(83, 20.0, 0.3);
}
TEST(ConvexLeaf, ErrorStaysWithinItsBoundForLongTranslations) {
  expect_within_bound(84, 200.0, 0.0);
}
TEST(ConvexLeaf, ErrorStaysWithinItsBoundForATurnOnTheSpot) {
  expect_within_bound(85, 0.0, 0.3);
}

TEST(ConvexLeaf, ErrorStaysWithinItsBoundWhereTheMotionIsDegenerate) {
  constexpr uint64_t kSeed = 86;
  Rng rng(kSeed);
  for (int n = 0; n < 100; ++n) {
    Case c = random_case(rng, 0.0, 0.0);
    const double bound = convex_kernel_error_mm(c.cutter.pieces.front(), kVoxel, kBand);
    ASSERT_LE(compare(c).error, bound) << "zero length, seed " << kSeed << " case " << n << describe(c);
    c.sweep.start.axis_W = c.sweep.end.axis_W = Vec3::UnitZ();
    c.sweep.end.tip_W = c.sweep.start.tip_W + rng.uniform(-5, 5) * Vec3::UnitZ();
    c.place = near_surface(rng, c.cutter, c.sweep);
    ASSERT_LE(compare(c).error, bound) << "plunge, seed " << kSeed << " case " << n << describe(c);
    // A voxel stands on the axis, all along a plunge and once in a move across.
    c.place.first_W = c.sweep.start.tip_W - 4.0 * kVoxel * Vec3(1, 1, 1);
    ASSERT_LE(compare(c).error, bound) << "on the axis, seed " << kSeed << " case " << n << describe(c);
    c.sweep.end.tip_W = c.sweep.start.tip_W + Vec3(rng.uniform(-5, 5), 0, 0);
    ASSERT_LE(compare(c).error, bound) << "through the axis, seed " << kSeed << " case " << n << describe(c);
  }
}

TEST(ConvexLeaf, BoundIsATwentiethOfAMicrometreForASmallTool) {
  EXPECT_LT(convex_kernel_error_mm(ball_nose(5.0, 10.0).pieces.front(), kVoxel, kBand), 5e-5);
}

TEST(ConvexLeaf, EveryInstructionSetGivesTheSameBits) {
  constexpr uint64_t kSeed = 87;
  Rng rng(kSeed);
  const auto variants = convex_kernel_variants();
  ASSERT_STREQ(variants.back().instruction_set, "baseline");
  int changed = 0;
  for (int n = 0; n < 500; ++n) {
    const Case c = random_case(rng, std::vector{0.0, 0.05, 1.0, 50.0}[n % 4], n % 3 == 0 ? 0.0 : 0.2);
    ConvexLeaf leaf;
    if (!prepare_convex_leaf(c.place, sweep_map(c.sweep), c.cutter.pieces.front(), leaf)) continue;
    float reference[kLeafVoxels];
    std::fill(std::begin(reference), std::end(reference), -0.3F);
    const int evaluated = variants.back().kernel(reference, leaf, kAllSlices);
    changed += *std::max_element(std::begin(reference), std::end(reference)) > -0.3F ? 1 : 0;
    for (const ConvexKernelVariant& variant : variants) {
      float values[kLeafVoxels];
      std::fill(std::begin(values), std::end(values), -0.3F);
      ASSERT_EQ(variant.kernel(values, leaf, kAllSlices), evaluated) << variant.instruction_set;
      ASSERT_EQ(std::memcmp(values, reference, sizeof(values)), 0)
          << variant.instruction_set << " differs, seed " << kSeed << " case " << n << ": " << describe(c);
    }
  }
  EXPECT_GT(changed, 250);
}

TEST(ConvexLeaf, TheOrderOfSweepsDoesNotShow) {
  constexpr uint64_t kSeed = 88;
  Rng rng(kSeed);
  for (int n = 0; n < 200; ++n) {
    Case a = random_case(rng, 1.0, 0.1);
    Sweep other = a.sweep;
    other.end = a.sweep.start;
    other.start.tip_W = a.sweep.start.tip_W + 0.5 * rng.direction();
    const auto cut = [&](std::initializer_list<Sweep> order) {
      std::vector<float> values(kLeafVoxels, -0.3F);
      for (const Sweep& s : order)
        cut_leaf_by_piece(values.data(), a.place, sweep_map(s), a.cutter.pieces.front(), kAllSlices);
      return values;
    };
    const auto forward = cut({a.sweep, other}), backward = cut({other, a.sweep});
    ASSERT_EQ(forward, backward) << "seed " << kSeed << " case " << n << ": " << describe(a);
  }
}

TEST(ConvexLeaf, OnlyTheSlicesAskedForChange) {
  const CutterSolid cutter = bull_nose(5.0, 1.0, 10.0);
  const SweepMap map = sweep_map({{{0, 0, 0}, Vec3::UnitZ()}, {{1, 0, -0.2}, Vec3::UnitZ()}, 0});
  const LeafPlace place{{4.2, 0, 0.1}, kVoxel, kBand};
  std::vector<float> all(kLeafVoxels, -0.3F), some = all;
  cut_leaf_by_piece(all.data(), place, map, cutter.pieces[0], kAllSlices);
  cut_leaf_by_piece(some.data(), place, map, cutter.pieces[0], 0b00100010U);
  for (int i = 0; i < kLeafVoxels; ++i) {
    const bool asked = i / 64 == 1 || i / 64 == 5;
    EXPECT_EQ(some[i], asked ? all[i] : -0.3F) << i;
  }
}

}  // namespace
}  // namespace swarf::stock::convex_leaf_test
