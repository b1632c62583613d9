// Hash, generator and units.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <set>
#include <string>

#include "base/hash.h"
#include "base/rng.h"
#include "base/units.h"

namespace swarf {
namespace {

std::string hash_of(std::initializer_list<double> values) {
  Hash hash;
  for (const double value : values) hash.add(value);
  return hash.text();
}

TEST(Hash, IsSixteenDigitsAndKnowsOrder) {
  EXPECT_EQ(hash_of({1, 2}).size(), 16U);
  EXPECT_EQ(hash_of({1, 2}), hash_of({1, 2}));
  EXPECT_NE(hash_of({1, 2}), hash_of({2, 1}));
  EXPECT_NE(hash_of({1, 2}), hash_of({1, 2, 0}));
}

TEST(Hash, SeesTheLastBitAndTheSignOfZero) {
  EXPECT_NE(hash_of({1.0}), hash_of({std::nextafter(1.0, 2.0)}));
  EXPECT_NE(hash_of({0.0}), hash_of({-0.0}));
}

TEST(Hash, EveryBitOfAWordMatters) {
  std::set<uint64_t> values;
  for (int bit = 0; bit < 64; ++bit) {
    Hash hash;
    hash.add(uint64_t{1} << bit);
    values.insert(hash.value());
  }
  EXPECT_EQ(values.size(), 64U);
}

TEST(Hash, OfFloatsIsThatOfTheirBits) {
  Hash a;
  Hash b;
  a.add(1.5F);
  b.add(uint64_t{std::bit_cast<uint32_t>(1.5F)});
  EXPECT_EQ(a.value(), b.value());
}

TEST(Rng, GivesTheNumbersOfSplitmix64) {
  // The published first outputs for the seed 1234567.
  Rng rng(1234567);
  EXPECT_EQ(rng.next(), 6457827717110365317ULL);
  EXPECT_EQ(rng.next(), 3203168211198807973ULL);
  EXPECT_EQ(rng.next(), 9817491932198370423ULL);
}

TEST(Rng, IsUniformInItsRange) {
  Rng rng(1);
  double sum = 0.0;
  for (int i = 0; i < 100000; ++i) {
    const double value = rng.uniform(-3.0, 5.0);
    ASSERT_GE(value, -3.0);
    ASSERT_LT(value, 5.0);
    sum += value;
  }
  // Standard error of the mean: 8 / sqrt(12 * 1e5) = 0.0073; five of them.
  EXPECT_NEAR(sum / 100000, 1.0, 0.037);
}

TEST(Rng, DirectionsAreUnitVectorsAllAround) {
  Rng rng(2);
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < 100000; ++i) {
    const Vec3 d = rng.direction();
    ASSERT_NEAR(d.norm(), 1.0, 1e-14);
    sum += d;
  }
  // Each component has a standard error of 1 / sqrt(3e5) = 0.0018.
  EXPECT_LT((sum / 100000).norm(), 0.01);
}

TEST(Units, ConvertAndConvertBack) {
  EXPECT_DOUBLE_EQ(rad_from_deg(180.0), kPi);
  EXPECT_DOUBLE_EQ(deg_from_rad(kPi / 2), 90.0);
  EXPECT_DOUBLE_EQ(mm_s_from_mm_min(3000.0), 50.0);
  EXPECT_DOUBLE_EQ(mm_min_from_mm_s(50.0), 3000.0);
  EXPECT_DOUBLE_EQ(um_from_mm(0.25), 250.0);
  EXPECT_DOUBLE_EQ(um_from_mm(kMicrometre), 1.0);
}

}  // namespace
}  // namespace swarf
