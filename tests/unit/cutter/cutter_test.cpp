#include "cutter/cutter.h"

#include <gtest/gtest.h>

#include <limits>

namespace swarf::cutter {
namespace {

TEST(Cutter, TheDefaultCanBeUsed) {
  EXPECT_TRUE(validate({}).empty());
  EXPECT_EQ(Cutter{}.radius(), 5.0);
}

struct Case {
  const char* name;
  double Cutter::*field;
};

class Lengths : public testing::TestWithParam<Case> {};

TEST_P(Lengths, MustBePositive) {
  for (const double bad :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
    Cutter cutter;
    cutter.*(GetParam().field) = bad;
    const auto problems = validate(cutter);
    ASSERT_FALSE(problems.empty()) << GetParam().name << " = " << bad;
    EXPECT_NE(problems[0].find(GetParam().name), std::string::npos) << problems[0];
    EXPECT_NE(problems[0].find("mm"), std::string::npos) << problems[0];
  }
}

TEST_P(Lengths, MustBeFinite) {
  Cutter cutter;
  cutter.*(GetParam().field) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(validate(cutter).empty()) << GetParam().name;
}

INSTANTIATE_TEST_SUITE_P(All, Lengths,
                         testing::Values(Case{"diameter_mm", &Cutter::diameter_mm},
                                         Case{"flute_length_mm", &Cutter::flute_length_mm},
                                         Case{"shank_diameter_mm", &Cutter::shank_diameter_mm},
                                         Case{"length_mm", &Cutter::length_mm},
                                         Case{"holder_diameter_mm", &Cutter::holder_diameter_mm},
                                         Case{"holder_length_mm", &Cutter::holder_length_mm}),
                         [](const auto& one) { return one.param.name; });

TEST(Cutter, OnlyFlatEndsAreCutByThisVersion) {
  Cutter cutter;
  for (const double radius : {5.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    cutter.corner_radius_mm = radius;
    ASSERT_EQ(validate(cutter).size(), 1U) << radius;
    EXPECT_NE(validate(cutter)[0].find("corner_radius_mm"), std::string::npos);
  }
}

TEST(Cutter, FlutesEndBelowTheHolder) {
  Cutter cutter;
  cutter.flute_length_mm = 60.5;
  ASSERT_EQ(validate(cutter).size(), 1U);
  EXPECT_EQ(validate(cutter)[0], "flute_length_mm 60.5 is longer than the tool, length_mm 60");
  cutter.flute_length_mm = 60.0;
  EXPECT_TRUE(validate(cutter).empty());
}

TEST(Cutter, EveryProblemIsTold) {
  Cutter cutter;
  cutter.diameter_mm = -10.0;
  cutter.corner_radius_mm = 2.0;
  cutter.length_mm = 0.0;
  // Diameter, length, corner radius, and flutes longer than the tool.
  EXPECT_EQ(validate(cutter).size(), 4U);
}

}  // namespace
}  // namespace swarf::cutter
