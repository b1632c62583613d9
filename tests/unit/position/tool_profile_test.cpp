// The underside of a cutter: heights, slopes and where planes touch, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "base/diagnostics.h"
#include "base/units.h"
#include "position/tool_profile.h"

namespace swarf::position {
namespace {

cutter::Cutter bull_nose(double diameter, double corner) {
  cutter::Cutter tool;
  tool.shape = cutter::Shape::kBullNose;
  tool.diameter_mm = diameter;
  tool.corner_radius_mm = corner;
  return tool;
}

TEST(ToolProfile, BullNoseIsFlatThenRound) {
  const ToolProfile profile(bull_nose(10.0, 2.0));
  EXPECT_NEAR(profile.radius(), 5.0, 2.0 * 0.5e-6);  // half a millionth of the corner radius
  EXPECT_DOUBLE_EQ(profile.height(2.9), 0.0);
  EXPECT_NEAR(profile.height(4.2), 2.0 - std::sqrt(4.0 - 1.44), 1e-14);
  EXPECT_NEAR(profile.height(5.0), 2.0, 1e-7);
}

// theory 3: bull nose R0 3, rc 2 on a plane of 20 degrees.
TEST(ToolProfile, PlaneLiftsTheTip) {
  EXPECT_NEAR(ToolProfile(bull_nose(10.0, 2.0)).lift(std::tan(rad_from_deg(20.0))), 1.220266248, 5e-10);
  cutter::Cutter ball = bull_nose(10.0, 5.0);
  ball.shape = cutter::Shape::kBall;
  const double b = rad_from_deg(50.0);
  EXPECT_NEAR(ToolProfile(ball).lift(std::tan(b)), 5.0 / std::cos(b) - 5.0, 1e-12);
  EXPECT_NEAR(ToolProfile(cutter::Cutter{}).lift(0.5), 2.5, 1e-14);
}

TEST(ToolProfile, WhatIsAboveTheWidestPlaceDoesNotCount) {
  cutter::Cutter disc;
  disc.shape = cutter::Shape::kWoodruff;
  disc.diameter_mm = 20.0;
  disc.corner_radius_mm = 1.5;
  disc.flute_length_mm = 3.0;
  disc.shank_diameter_mm = 6.0;
  const ToolProfile profile(disc);
  EXPECT_NEAR(profile.radius(), 10.0, 1.5 * 0.51e-6);
  EXPECT_NEAR(profile.height(10.0), 1.5, 1e-6);
}

TEST(ToolProfile, RefusesHollows) {
  cutter::Cutter hollow;
  hollow.shape = cutter::Shape::kProfile;
  hollow.profile = {{{0.0, 0.0}, 0.0}, {{3.0, 2.0}, 0.0}, {{5.0, 2.5}, 0.0}, {{5.0, 20.0}, 0.0}};
  EXPECT_THROW(ToolProfile{hollow}, InputError);
}

}  // namespace
}  // namespace swarf::position
