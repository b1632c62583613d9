// The deviation scale: its landmarks, its order in grey, and what red-green blindness leaves of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "render/figures/colour.h"

namespace swarf::render {
namespace {

float luminance(const Rgb& c) {
  return 0.2126F * c[0] + 0.7152F * c[1] + 0.0722F * c[2];
}

TEST(DeviationColour, GougeIsBlueOnSizeIsNearWhiteExcessIsYellowThenRed) {
  const Rgb gouge = deviation_colour(-8, 10), on_size = deviation_colour(0, 10);
  const Rgb little = deviation_colour(3.3, 10), much = deviation_colour(10, 10);
  EXPECT_GT(gouge[2], 2 * gouge[0]);
  EXPECT_GT(*std::min_element(on_size.begin(), on_size.end()), 0.8F);
  EXPECT_GT(little[0], 3 * little[2]);
  EXPECT_GT(little[1], 0.5F * little[0]);
  EXPECT_GT(much[0], 10 * much[1]);
}

TEST(DeviationColour, LightnessFallsOnBothSidesInStepsOfEqualSign) {
  for (int i = 0; i < 100; ++i) {
    for (const int side : {-1, 1}) {
      EXPECT_GT(luminance(deviation_colour(side * i, 100)), luminance(deviation_colour(side * (i + 1), 100)))
          << side * i;
    }
  }
}

/// Machado, Oliveira & Fernandes 2009, severity 1: linear RGB as seen with protanopia and deuteranopia.
TEST(DeviationColour, SidesDifferForColourBlindEyes) {
  constexpr float kMatrices[2][3][3] = {{{0.152286F, 1.052583F, -0.204868F},
                                         {0.114503F, 0.786281F, 0.099216F},
                                         {-0.003882F, -0.048116F, 1.051998F}},
                                        {{0.367322F, 0.860646F, -0.227968F},
                                         {0.280085F, 0.672501F, 0.047413F},
                                         {-0.011820F, 0.042940F, 0.968881F}}};
  for (const auto& matrix : kMatrices) {
    const auto blueness = [&](double place) {
      const Rgb c = deviation_colour(place, 1.0);
      float seen[3];
      for (int i = 0; i < 3; ++i) seen[i] = matrix[i][0] * c[0] + matrix[i][1] * c[1] + matrix[i][2] * c[2];
      return seen[2] / (seen[0] + seen[1] + seen[2]);
    };
    for (const double place : {0.2, 0.4, 0.6, 0.8, 1.0}) {
      EXPECT_GT(blueness(-place), blueness(place) + 0.15F) << "deviation " << place;
    }
  }
}

TEST(DeviationColour, EndColoursBeyondTheScaleAndGreyForUnknown) {
  EXPECT_EQ(deviation_colour(25, 10), deviation_colour(10, 10));
  EXPECT_EQ(deviation_colour(-1e9, 10), deviation_colour(-10, 10));
  const Rgb unknown = deviation_colour(std::numeric_limits<double>::quiet_NaN(), 10);
  EXPECT_EQ(unknown[0], unknown[2]);
  EXPECT_LT(luminance(unknown), luminance(deviation_colour(-10, 10)));
  EXPECT_THROW(deviation_colour(1, 0), InternalError);
}

TEST(DeviationColour, VerticesGetTheirColourAndUnknownOnesTheirGrey) {
  TriMesh mesh;
  mesh.positions.resize(4);
  mesh.deviation_um = {-5, 0, 2.5F, std::numeric_limits<float>::quiet_NaN()};
  colour_by_deviation(mesh, 5);
  ASSERT_EQ(mesh.colours.size(), 4U);
  for (size_t v = 0; v < 4; ++v) {
    EXPECT_EQ(mesh.colours[v], srgb8_from_linear(deviation_colour(mesh.deviation_um[v], 5))) << v;
  }
}

TEST(Srgb, EightBitsSurviveTheRoundTrip) {
  for (int i = 0; i < 256; ++i) {
    const auto byte = static_cast<uint8_t>(i);
    const std::array<uint8_t, 4> colour{byte, byte, byte, 255};
    EXPECT_EQ(srgb8_from_linear(linear_from_srgb8(colour)), colour);
  }
  EXPECT_NEAR(linear_from_srgb(0.5F), 0.21404F, 1e-5);  // IEC 61966-2-1
}

}  // namespace
}  // namespace swarf::render
