// Every contradiction in a cutter is told at its key, in words with numbers; a good one passes.
#include "cutter/cutter.h"

#include <gtest/gtest.h>

#include <limits>

#include "shapes.h"

namespace swarf::cutter::cutter_test {
namespace {

using namespace test;

TEST(Cutter, TheDefaultCanBeUsed) {
  EXPECT_TRUE(validate({}).empty());
  EXPECT_EQ(Cutter{}.radius(), 5.0);
}

TEST(Cutter, EveryGoodShapePasses) {
  for (const Named& one : every_shape()) {
    const std::vector<Problem> problems = validate(one.cutter);
    EXPECT_TRUE(problems.empty()) << one.name << ": " << problems[0].text;
  }
}

struct Length {
  const char* name;
  double Cutter::*field;
};

class Lengths : public testing::TestWithParam<Length> {};

TEST_P(Lengths, MustBePositiveAndFinite) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity}) {
    Cutter cutter;
    cutter.*(GetParam().field) = bad;
    const auto problems = validate(cutter);
    ASSERT_FALSE(problems.empty()) << GetParam().name << " = " << bad;
    EXPECT_EQ(problems[0].key, GetParam().name);
    EXPECT_NE(problems[0].text.find(GetParam().name), std::string::npos) << problems[0].text;
    EXPECT_NE(problems[0].text.find("mm"), std::string::npos) << problems[0].text;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Lengths,
                         testing::Values(Length{"diameter_mm", &Cutter::diameter_mm},
                                         Length{"flute_length_mm", &Cutter::flute_length_mm},
                                         Length{"shank_diameter_mm", &Cutter::shank_diameter_mm},
                                         Length{"length_mm", &Cutter::length_mm}),
                         [](const auto& one) { return one.param.name; });

/// A good cutter with one thing changed.
Cutter with(Cutter cutter, double Cutter::*field, double value) {
  cutter.*field = value;
  return cutter;
}

Cutter with_centre(Cutter cutter, double e, double f) {
  cutter.corner_centre_mm = Vec2(e, f);
  return cutter;
}

Cutter with_neck(Cutter cutter, double diameter, double length) {
  cutter.neck_diameter_mm = diameter;
  cutter.neck_length_mm = length;
  return cutter;
}

Cutter with_holder(std::vector<ToolSection> holder) {
  Cutter cutter;
  cutter.holder = std::move(holder);
  return cutter;
}

struct Bad {
  const char* name;
  Cutter cutter;
  const char* key;
  const char* text;  ///< the whole of it
};

void PrintTo(const Bad& bad, std::ostream* out) {
  *out << bad.name;
}

class BadCutter : public testing::TestWithParam<Bad> {};

TEST_P(BadCutter, IsToldAtItsKeyInWordsWithNumbers) {
  const auto problems = validate(GetParam().cutter);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].key, GetParam().key);
  EXPECT_EQ(problems[0].text, GetParam().text);
}

std::vector<Bad> bad_shapes() {
  const Cutter flat = of_shape(Shape::kFlat, 10, 0, 25);
  return {
      {"corner_below_0", with(flat, &Cutter::corner_radius_mm, -1), "corner_radius_mm",
       "corner_radius_mm must be 0 mm or more and finite, it is -1"},
      {"flat_with_corner", with(flat, &Cutter::corner_radius_mm, 1), "corner_radius_mm",
       "corner_radius_mm is 1, but a flat end has none; shape = \"bull_nose\" is the one with a corner "
       "radius"},
      {"ball_with_other_corner", of_shape(Shape::kBall, 10, 4, 25), "corner_radius_mm",
       "corner_radius_mm is 4, but a ball end of diameter 10 mm has 5 mm"},
      {"ball_with_short_flutes", of_shape(Shape::kBall, 10, 0, 4), "flute_length_mm",
       "flute_length_mm 4 ends below the flank, which begins 5 mm above the tip"},
      {"bull_nose_without_corner", of_shape(Shape::kBullNose, 10, 0, 25), "corner_radius_mm",
       "corner_radius_mm is 0: a bull nose needs one; shape = \"flat\" has none"},
      {"corner_above_radius", of_shape(Shape::kBullNose, 10, 5.5, 25), "corner_radius_mm",
       "corner_radius_mm 5.5 is above 5 mm, the cutter's radius"},
      {"taper_corner_above_end", taper(6, 3.5, 10, 20), "corner_radius_mm",
       "corner_radius_mm 3.5 is above 3 mm, the radius of the end"},
      {"taper_0", taper(6, 0, 0, 20), "taper_deg", "taper_deg is 0: it must lie between 0 and 90 degrees"},
      {"taper_90", taper(6, 0, 90, 20), "taper_deg", "taper_deg is 90: it must lie between 0 and 90 degrees"},
      {"taper_negative", taper(6, 0, -5, 20), "taper_deg",
       "taper_deg is -5: it must lie between 0 and 90 degrees"},
      {"drill_point_180", drill(8, 180, 40), "point_angle_deg",
       "point_angle_deg is 180: it must lie between 0 and 180 degrees"},
      {"drill_point_0", drill(8, 0, 40), "point_angle_deg",
       "point_angle_deg is 0: it must lie between 0 and 180 degrees"},
      {"drill_shorter_than_point", drill(8, 90, 3), "flute_length_mm",
       "flute_length_mm 3 ends below the flank, which begins 4 mm above the tip"},
      {"drill_with_corner", with(drill(8, 118, 40), &Cutter::corner_radius_mm, 1), "corner_radius_mm",
       "corner_radius_mm is 1, but shape = \"drill\" has none"},
      {"chamfer_with_corner", with(chamfer(10, 2, 90, 12), &Cutter::corner_radius_mm, 1), "corner_radius_mm",
       "corner_radius_mm is 1, but shape = \"chamfer\" has none"},
      {"chamfer_tip_above_diameter", chamfer(10, 12, 90, 12), "tip_diameter_mm",
       "tip_diameter_mm is 12: it must be 0 or more and below diameter_mm 10"},
      {"chamfer_tip_negative", chamfer(10, -1, 90, 12), "tip_diameter_mm",
       "tip_diameter_mm is -1: it must be 0 or more and below diameter_mm 10"},
      {"chamfer_point_200", chamfer(10, 2, 200, 12), "point_angle_deg",
       "point_angle_deg is 200: it must lie between 0 and 180 degrees"},
      {"chamfer_shorter_than_cone", chamfer(10, 2, 90, 3), "flute_length_mm",
       "flute_length_mm 3 ends below the cone's upper edge, 4 mm above the tip"},
      {"woodruff_corner_above_half_width", woodruff(20, 2.5, 4), "corner_radius_mm",
       "corner_radius_mm 2.5 is above 2 mm, half of width_mm"},
      {"woodruff_corner_above_radius", woodruff(6, 3.5, 10), "corner_radius_mm",
       "corner_radius_mm 3.5 is above 3 mm, the disc's radius"},
      {"woodruff_without_width", woodruff(20, 0, 0), "width_mm",
       "width_mm must be above 0 mm and finite, it is 0"},
      {"woodruff_on_its_own_shank", with(woodruff(20, 0, 4), &Cutter::shank_diameter_mm, 20),
       "shank_diameter_mm",
       "the disc has diameter_mm 20, but what carries it is 20 mm thick: nothing of it would reach under an "
       "edge"},
      {"woodruff_on_a_thick_neck", with_neck(woodruff(20, 0, 4), 22, 10), "neck_diameter_mm",
       "the disc has diameter_mm 20, but what carries it is 22 mm thick: nothing of it would reach under an "
       "edge"},
  };
}

std::vector<Bad> bad_apt() {
  return {
      {"alpha_negative", apt(10, 1, -5, 0, 25), "alpha_deg",
       "alpha_deg is -5: the bottom line must rise from the tip by 0 or more and less than 90 degrees"},
      {"alpha_90", apt(10, 1, 90, 0, 25), "alpha_deg",
       "alpha_deg is 90: the bottom line must rise from the tip by 0 or more and less than 90 degrees"},
      {"beta_100", apt(10, 1, 0, 100, 25), "beta_deg",
       "beta_deg is 100: it must lie between -90 and 90 degrees"},
      {"lines_that_never_cross", apt(10, 1, 50, 45, 25), "beta_deg",
       "alpha_deg 50 and beta_deg 45 add up to 90 or more: bottom line and flank never cross"},
      {"flank_meets_axis", apt(10, 0, 0, -45, 25), "beta_deg",
       "beta_deg -45 leads the flank to the axis 5 mm above the tip, below flute_length_mm 25"},
      {"corner_above_largest", apt(10, 6, 0, 0, 25), "corner_radius_mm",
       "corner_radius_mm 6 is above 5 mm, the largest circle between bottom line and flank"},
      {"flutes_below_corner", apt(10, 2, 0, 0, 1), "flute_length_mm",
       "flute_length_mm 1 ends below the flank, which begins 2 mm above the tip"},
      {"e_plus_r_above_half_d", with_centre(apt(10, 1, 0, 0, 25), 4.5, 1), "corner_centre_mm",
       "e + r = 4.5 + 1 = 5.5 mm, but without taper (beta_deg 0) the corner circle touches the flank at d/2 "
       "= 5 mm"},
      {"f_off_the_bottom", with_centre(apt(10, 1, 0, 0, 25), 4, 1.2), "corner_centre_mm",
       "the corner circle about e 4, f 1.2 mm does not touch bottom line and flank: d, r, alpha and beta put "
       "its "
       "centre at e 4.0000, f 1.0000 mm"},
      {"centre_off_the_taper", with_centre(apt(10, 1, 0, 10, 25), 4, 1), "corner_centre_mm",
       "the corner circle about e 4, f 1 mm does not touch bottom line and flank: d, r, alpha and beta put "
       "its "
       "centre at e 4.1609, f 1.0000 mm"},
  };
}

std::vector<Bad> bad_profiles() {
  const char* key = "profile";
  return {
      {"empty", profile({}), key, "the profile has 0 corners: it needs two or more"},
      {"one_corner", profile({{{0, 0}}}), key, "the profile has 1 corners: it needs two or more"},
      {"not_a_number", profile({{{0, 0}}, {{std::nan(""), 2}}}), key,
       "corner 2 of the profile is not a finite number"},
      {"starts_off_the_axis", profile({{{2, 0}}, {{5, 0}}, {{5, 20}}}), key,
       "the profile starts at [2, 0] mm: it must start on the axis, at [0, 0]"},
      {"starts_above_the_tip", profile({{{0, 1}}, {{5, 1}}, {{5, 20}}}), key,
       "the profile starts at [0, 1] mm: its first corner is the tip, [0, 0]"},
      {"first_corner_an_arc", profile({{{0, 0}, 3.0}, {{5, 0}}, {{5, 20}}}), key,
       "the first corner of the profile is a point: it has no radius_mm"},
      {"below_the_tip", profile({{{0, 0}}, {{5, -1}}, {{5, 20}}}), key,
       "corner 2 of the profile, [5, -1] mm, lies below the tip"},
      {"beyond_the_axis", profile({{{0, 0}}, {{5, 0}}, {{-1, 20}}}), key,
       "corner 3 of the profile, [-1, 20] mm, lies beyond the axis"},
      {"back_on_the_axis", profile({{{0, 0}}, {{5, 0}}, {{0, 5}}, {{5, 20}}}), key,
       "corner 3 of the profile, [0, 5] mm, lies on the axis before the end"},
      {"same_corner_twice", profile({{{0, 0}}, {{5, 0}}, {{5, 0}}, {{5, 20}}}), key,
       "corners 2 and 3 of the profile are the same, [5, 0] mm"},
      {"arc_too_small", profile({{{0, 0}}, {{5, 5}, 3.0}, {{5, 20}}}), key,
       "the arc to corner 2 of the profile, [5, 5] mm, has radius_mm 3, but the corners are 7.07107 mm "
       "apart"},
      {"hollow_through_the_axis", profile({{{0, 0}}, {{3, 0}}, {{3, 8}, -4.1}, {{3, 20}}}), key,
       "the hollow arc to corner 3 of the profile reaches the axis"},
      {"crosses_itself", profile({{{0, 0}}, {{5, 0}}, {{2, 10}}, {{2, 4}}, {{6, 8}}, {{6, 20}}}), key,
       "the profile crosses itself near [3.38462, 5.38462] mm"},
      {"turns_back", profile({{{0, 0}}, {{5, 0}}, {{3, 0}}, {{3, 20}}}), key,
       "the profile turns back on itself at [5, 0] mm"},
      {"dished", profile({{{0, 0}}, {{2, 0.5}}, {{5, 0}}, {{5, 20}}}), key,
       "the profile falls by 0.5 mm on the way from corner 2 to corner 3: dished ends and hooks cannot be "
       "cut, "
       "every part of it must rise or stay level"},
      {"arc_dips", profile({{{0, 0}}, {{4, 0}}, {{8, 0}, 4.0}, {{8, 20}}}), key,
       "the profile falls by 0.535898 mm on the way from corner 2 to corner 3: dished ends and hooks cannot "
       "be "
       "cut, "
       "every part of it must rise or stay level"},
      {"ends_with_a_step_out", profile({{{0, 0}}, {{3, 0}}, {{3, 20}}, {{5, 20}}}), key,
       "the profile ends with a level step outwards, at [5, 20] mm: a disc without thickness"},
      {"no_height", profile({{{0, 0}}, {{5, 0}}}), key, "the profile has no height"},
      {"other_flute_length", with(stepped(), &Cutter::flute_length_mm, 25), key,
       "the profile ends 30 mm above the tip, flute_length_mm is 25"},
  };
}

std::vector<Bad> bad_tools() {
  const Cutter flat = of_shape(Shape::kFlat, 10, 0, 25);
  return {
      {"flutes_longer_than_tool", with(flat, &Cutter::flute_length_mm, 60.5), "flute_length_mm",
       "flute_length_mm 60.5 is longer than the tool, length_mm 60"},
      {"neck_negative", with_neck(flat, 8, -1), "neck_length_mm",
       "neck_length_mm must be above 0 mm and finite, it is -1"},
      {"neck_without_diameter", with_neck(flat, 0, 10), "neck_diameter_mm",
       "neck_diameter_mm must be above 0 mm and finite, it is 0"},
      {"neck_longer_than_tool", with_neck(flat, 8, 36), "neck_length_mm",
       "flutes and neck, 25 + 36 mm, are longer than the tool, length_mm 60"},
      {"no_holder", with_holder({}), "holder", "the holder has no section"},
      {"holder_without_diameter", with_holder({{40, 40, 50}, {0, 40, 50}}), "holder",
       "the holder's diameter_mm must be above 0 mm and finite, it is 0"},
      {"holder_without_top", with_holder({{40, -1, 50}}), "holder",
       "the holder's top_diameter_mm must be above 0 mm and finite, it is -1"},
      {"holder_without_length", with_holder({{40, 40, 0}}), "holder",
       "the holder's length_mm must be above 0 mm and finite, it is 0"},
  };
}

const auto kName = [](const testing::TestParamInfo<Bad>& one) { return std::string(one.param.name); };

INSTANTIATE_TEST_SUITE_P(Shapes, BadCutter, testing::ValuesIn(bad_shapes()), kName);
INSTANTIATE_TEST_SUITE_P(Apt, BadCutter, testing::ValuesIn(bad_apt()), kName);
INSTANTIATE_TEST_SUITE_P(Profiles, BadCutter, testing::ValuesIn(bad_profiles()), kName);
INSTANTIATE_TEST_SUITE_P(Tools, BadCutter, testing::ValuesIn(bad_tools()), kName);

TEST(Cutter, WhatIsAllowedAtTheLimitPasses) {
  const Cutter flat = of_shape(Shape::kFlat, 10, 0, 25);
  EXPECT_TRUE(validate(with(flat, &Cutter::flute_length_mm, 60)).empty());
  EXPECT_TRUE(validate(with_neck(flat, 8, 35)).empty());
  EXPECT_TRUE(validate(of_shape(Shape::kBall, 10, 5, 5)).empty());
  EXPECT_TRUE(validate(of_shape(Shape::kBullNose, 10, 5, 25)).empty());
  EXPECT_TRUE(validate(taper(6, 3, 10, 20)).empty());
  EXPECT_TRUE(validate(woodruff(20, 2, 4)).empty());
  // (e, f) as a CL file writes them, with four decimals.
  EXPECT_TRUE(validate(with_centre(apt(10, 1, 0, 10, 25), 4.1609, 1.0)).empty());
  // A lens whose corner is written with four decimals dips by less than 1e-5 mm.
  EXPECT_TRUE(validate(profile({{{0, 0}}, {{5, 0.0625}, 200.0}, {{5, 20}}})).empty());
}

TEST(Cutter, EveryProblemIsTold) {
  Cutter cutter;
  cutter.diameter_mm = -10.0;
  cutter.corner_radius_mm = -2.0;
  cutter.length_mm = 0.0;
  // Diameter, length, corner radius, and flutes longer than the tool.
  EXPECT_EQ(validate(cutter).size(), 4U);
}

TEST(Cutter, DescriptionsNameWhatTheShapeIs) {
  EXPECT_EQ(describe({}), "flat, D 10 mm, flutes 25 mm, length 60 mm");
  EXPECT_EQ(describe(taper(6, 1, 10, 20)),
            "taper, D 6 mm, corner radius 1 mm, 10° a side, flutes 20 mm, length 60 mm");
  Cutter nose;
  nose.shape = Shape::kBullNose;
  nose.corner_radius_mm = 1;
  EXPECT_EQ(describe(nose), "bull nose, D 10 mm, corner radius 1 mm, flutes 25 mm, length 60 mm");
  EXPECT_EQ(describe(drill(8, 118, 40)), "drill, D 8 mm, point 118°, flutes 40 mm, length 60 mm");
}

}  // namespace
}  // namespace swarf::cutter::cutter_test
