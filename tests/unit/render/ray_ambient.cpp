// Ambient light that neighbours share: less noise on a surface, nothing across its edges, means kept.
#include "render/ray/ambient_filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "base/rng.h"

namespace swarf::render::ray_ambient {
namespace {

constexpr int kWidth = 40, kHeight = 30;
constexpr float kTruth = 0.5F, kNoise = 0.2F;
const Vec3f kEye(0, 0, 1000);
constexpr float kMmPerPx = 1e-3F;  // a pixel is 1 mm wide at the plane z = 0

PixelLight pixel(int x, int y, float ambient) {
  PixelLight one;
  one.matt = Vec3f::Ones();
  one.ambient = Vec3f::Constant(ambient);
  one.normal = Vec3f::UnitZ();
  one.position = Vec3f(static_cast<float>(x), static_cast<float>(y), 0.0F);
  return one;
}

std::vector<PixelLight> noisy_plane() {
  Rng rng(5);
  std::vector<PixelLight> pixels;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      pixels.push_back(pixel(x, y, kTruth + static_cast<float>(rng.uniform(-kNoise, kNoise))));
  return pixels;
}

/// Root of the mean square about the truth.
double noise_of(const std::vector<PixelLight>& pixels) {
  double squares = 0.0;
  for (const PixelLight& one : pixels) squares += std::pow(one.ambient.x() - kTruth, 2);
  return std::sqrt(squares / static_cast<double>(pixels.size()));
}

void share(std::vector<PixelLight>& pixels) {
  share_ambient(pixels, kWidth, kHeight, kEye, kMmPerPx);
}

TEST(AmbientShare, APlaneLosesNearlyAllItsNoise) {
  std::vector<PixelLight> pixels = noisy_plane();
  const double before = noise_of(pixels);
  share(pixels);
  // 25 pixels in each of two steps: a fifth of it twice, were they all independent and none at the border.
  EXPECT_LT(noise_of(pixels), before / 12.0);
  EXPECT_GT(noise_of(pixels), before / 26.0);
}

TEST(AmbientShare, ASmoothSurfaceStaysAsItIs) {
  std::vector<PixelLight> pixels;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) pixels.push_back(pixel(x, y, 0.3F + 0.01F * static_cast<float>(x)));
  share(pixels);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 8; x < kWidth - 8; ++x)  // within the reach of both steps the ramp is even to both sides
      EXPECT_NEAR(pixels[static_cast<size_t>(y * kWidth + x)].ambient.x(),
                  0.3F + 0.01F * static_cast<float>(x), 1e-5);
}

/// Dark on the left and bright on the right of an edge: a step down, then a corner; both stay sharp.
TEST(AmbientShare, NothingCrossesAnEdge) {
  for (const bool corner : {false, true}) {
    std::vector<PixelLight> pixels;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const bool right = x >= kWidth / 2;
        pixels.push_back(pixel(x, y, right ? 0.9F : 0.1F));
        if (right && corner) {
          pixels.back().normal = Vec3f::UnitX();
          pixels.back().position =
              Vec3f(kWidth / 2, static_cast<float>(y), static_cast<float>(kWidth / 2 - x));
        }
        if (right && !corner) pixels.back().position.z() = -20.0F;
      }
    share(pixels);
    for (size_t i = 0; i < pixels.size(); ++i) {
      const bool right = static_cast<int>(i) % kWidth >= kWidth / 2;
      // The mean of all beside it weighs half a pixel against the nine or more of its own surface, twice.
      EXPECT_NEAR(pixels[i].ambient.x(), right ? 0.9F : 0.1F, 2 * 0.8 * 0.5 / 9.5) << i;
    }
  }
}

/// The pixels of an outline see several surfaces and are like none: else they would keep all their noise.
TEST(AmbientShare, APixelLikeNoOtherTakesTheMeanBesideIt) {
  std::vector<PixelLight> pixels = noisy_plane();
  const size_t lone = 15 * kWidth + 20;
  pixels[lone].normal = Vec3f(1, 1, 0).normalized();
  pixels[lone].ambient.setZero();
  share(pixels);
  EXPECT_NEAR(pixels[lone].ambient.x(), kTruth, 0.2 * kTruth);  // a third is its own, twice
}

TEST(AmbientShare, WhatIsNotMattIsLeftAloneAndGivesNothing) {
  std::vector<PixelLight> pixels = noisy_plane();
  const size_t metal = 15 * kWidth + 20;
  pixels[metal].matt.setZero();
  pixels[metal].ambient.setConstant(1000.0F);
  share(pixels);
  EXPECT_EQ(pixels[metal].ambient.x(), 1000.0F);
  EXPECT_LT(pixels[metal + 1].ambient.x(), 1.0F);
}

/// What dull surfaces mirror is shared as the ambient light is; a pixel without a sample of it takes the
/// others'.
TEST(AmbientShare, SheenIsSharedByDullSurfacesAlone) {
  std::vector<PixelLight> pixels = noisy_plane();
  for (PixelLight& one : pixels) {
    one.dull = 1.0F;
    one.knows_sheen = true;
    std::swap(one.sheen, one.ambient);
  }
  const size_t unknown = 15 * kWidth + 20, mirror = unknown + 5, lone = unknown - 5;
  pixels[unknown].sheen.setZero();
  pixels[unknown].knows_sheen = false;
  pixels[mirror].dull = 0.0F;
  pixels[mirror].knows_sheen = false;
  pixels[mirror].sheen.setConstant(1000.0F);
  pixels[lone].matt.setZero();  // all metal
  share(pixels);
  EXPECT_EQ(pixels[mirror].sheen.x(), 1000.0F);
  EXPECT_NEAR(pixels[unknown].sheen.x(), kTruth, 0.1 * kTruth);
  EXPECT_NEAR(pixels[lone].sheen.x(), kTruth, 0.1 * kTruth);
  EXPECT_EQ(pixels[lone].ambient.x(), 0.0F);
  for (PixelLight& one : pixels) std::swap(one.sheen, one.ambient);
  pixels[mirror].ambient.setConstant(kTruth);
  EXPECT_LT(noise_of(pixels), kNoise / std::sqrt(3.0) / 8.0);
}

TEST(AmbientShare, TheSameForAnyNumberOfThreads) {
  std::vector<PixelLight> one = noisy_plane(), many = one;
  set_thread_count(1);
  share(one);
  set_thread_count(0);
  share(many);
  for (size_t i = 0; i < one.size(); ++i) ASSERT_EQ(one[i].ambient, many[i].ambient);
}

}  // namespace
}  // namespace swarf::render::ray_ambient
