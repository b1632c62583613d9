// Shading of what OSMesa found: every instruction set alike, and pixels as the mean of their surfaces.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "render/raster/sample_resolver.h"

namespace swarf::render::raster_shading {
namespace {

constexpr int kMap = 64;
const std::vector<std::array<float, 2>> kMaterials{{0.0F, 0.6F}, {1.0F, 0.2F}, {0.4F, 0.9F}};

SceneView view_of(const Camera& camera) {
  return scene_view(camera, {Vec3::Constant(-60.0), Vec3::Constant(60.0)}, 16.0 / 9.0);
}

/// A map whose texels are drawn by lot.
ShadowMap random_shadows(std::mt19937& random) {
  std::uniform_real_distribution<float> share(0.0F, 1.0F);
  ShadowMap map{{}, kMap - 16, kMap - 9};
  map.depths.resize(static_cast<size_t>(map.width) * static_cast<size_t>(map.rows));
  for (float& depth : map.depths) depth = share(random);
  return map;
}

/// Wild numbers, too: what lies beyond `count` is shaded along.
TEST(ShadeKernel, EveryInstructionSetGivesTheSameColours) {
  constexpr size_t kPlaces = 1024;
  std::mt19937 random(5);
  std::uniform_real_distribution<float> share(0.0F, 1.0F), place(-400.0F, 400.0F);
  std::uniform_int_distribution<uint32_t> word(0, 0xffffffU), kind(kGroundKind, kFirstMaterial + 2);
  const ShadowMap map = random_shadows(random);
  const Camera camera;
  const Lighting light = lighting(view_of(camera), camera.eye, 1280, 720, kMaterials, map);
  ShadeBatch filled(kPlaces);
  for (size_t i = 0; i < kPlaces; ++i) {
    filled.x[i] = i % 50 == 0 ? 1e20F : place(random);
    filled.y[i] = place(random);
    filled.depth[i] = i % 9 == 0 ? 1.0F : share(random);
    for (auto* normal : {&filled.normal_u, &filled.normal_v}) (*normal)[i] = 65535.0F * share(random);
    filled.paint[i] = word(random) | kind(random) << 24;
  }
  ShadeBatch first = filled;
  shade_kernels().front().shade(light, kPlaces - 5, first);
  for (const ShadeKernel& kernel : shade_kernels()) {
    ShadeBatch batch = filled;
    kernel.shade(light, kPlaces - 5, batch);
    EXPECT_EQ(batch.red, first.red) << kernel.name;
    EXPECT_EQ(batch.green, first.green) << kernel.name;
    EXPECT_EQ(batch.blue, first.blue) << kernel.name;
    for (const auto* channel : {&batch.red, &batch.green, &batch.blue})
      for (const float seen : *channel) ASSERT_TRUE(seen >= 0.0F && seen <= 1.0F) << kernel.name;
    std::vector<uint8_t> bytes(4 * kPlaces), expected(4 * kPlaces, 255);
    kernel.write_bytes(batch, kPlaces, bytes.data());
    for (size_t i = 0; i < kPlaces; ++i) {
      expected[4 * i] = static_cast<uint8_t>(std::floor(255.0F * batch.red[i] + 0.5F));
      expected[4 * i + 1] = static_cast<uint8_t>(std::floor(255.0F * batch.green[i] + 0.5F));
      expected[4 * i + 2] = static_cast<uint8_t>(std::floor(255.0F * batch.blue[i] + 0.5F));
    }
    EXPECT_EQ(bytes, expected) << kernel.name;
  }
}

/// Samples by lot, few kinds of each, so that pixels of one to four surfaces come up.
SampleBand random_band(int width, int rows, int side, std::mt19937& random) {
  std::uniform_int_distribution<uint32_t> normal(0, 3), kind(kPaintKind, kFirstMaterial + 2), eighth(0, 7);
  SampleBand band;
  band.width = width;
  band.side = side;
  band.resize(rows);
  SeenWords words{};
  for (size_t i = 0; i < band.depths.size(); ++i) {
    if (eighth(random) < 4)  // else as before
      words = {0x30002000U + 2500U * normal(random) + (3500U * normal(random) << 16),
               0x00402010U * eighth(random) % 0xffffffU | kind(random) << 24};
    band.words[2 * i] = words[0];
    band.words[2 * i + 1] = words[1];
    band.depths[i] = eighth(random) == 0 ? 1.0F : 0.3F;
  }
  return band;
}

/// By the definition, one sample after the other.
TEST(SampleResolver, APixelIsTheMeanOfItsSurfaces) {
  std::mt19937 random(9);
  const ShadowMap map = random_shadows(random);
  const Camera camera;
  const SceneView view = view_of(camera);
  int several = 0;
  for (const int side : {1, 2}) {
    for (const std::array<int, 2>& size : {std::array{1, 1}, std::array{37, 5}, std::array{530, 3}}) {
      const int width = size[0], rows = size[1], height = rows + 4, top = 2;
      const SampleBand band = random_band(width, rows, side, random);
      const Lighting light = lighting(view, camera.eye, width, height, kMaterials, map);
      Image image{width, height, std::vector<uint8_t>(size_t{4} * width * height)};
      resolve(band, light, top, image);
      for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < width; ++column) {
          struct Group {
            SeenWords words;
            int first;
            float count, u, v;
          };
          std::vector<Group> groups;
          const auto at = [&](int s) {
            return static_cast<size_t>((side * (rows - row) - 1 - s / side) * side * width + side * column +
                                       s % side);
          };
          for (int s = 0; s < side * side; ++s) {
            SeenWords words{band.words[2 * at(s)], band.words[2 * at(s) + 1]};
            if (band.depths[at(s)] == 1.0F) words = kGroundWords;
            auto found = std::find_if(groups.begin(), groups.end(),
                                      [&](const Group& g) { return one_surface(g.words, words); });
            if (found == groups.end()) found = groups.insert(found, {words, s, 0.0F, 0.0F, 0.0F});
            found->count += 1.0F;
            found->u += static_cast<float>(words[0] & 0xffffU);
            found->v += static_cast<float>(words[0] >> 16);
          }
          several += groups.size() > 1 ? 1 : 0;
          std::array<float, 3> sum{};
          for (const Group& g : groups) {
            ShadeBatch one(kShadedAtOnce);
            const float step = 1.0F / static_cast<float>(side);
            one.x[0] = static_cast<float>(column) - 0.5F * static_cast<float>(width) +
                       step * (0.5F + static_cast<float>(g.first % side));
            one.y[0] = static_cast<float>(top + row) - 0.5F * static_cast<float>(height) +
                       step * (0.5F + static_cast<float>(g.first / side));
            one.depth[0] = band.depths[at(g.first)];
            one.normal_u[0] = g.u / g.count;
            one.normal_v[0] = g.v / g.count;
            one.paint[0] = g.words[1];
            shade_kernels().back().shade(light, 1, one);
            const float share = g.count * step * step;
            sum[0] += share * one.red[0];
            sum[1] += share * one.green[0];
            sum[2] += share * one.blue[0];
          }
          for (size_t k = 0; k < 3; ++k)
            ASSERT_NEAR(image.rgba[4 * static_cast<size_t>((top + row) * width + column) + k],
                        255.0F * sum[k], 0.51)
                << side << ' ' << width << ' ' << row << ' ' << column;
        }
      }
      for (int column = 0; column < width; ++column)
        EXPECT_EQ(image.rgba[4 * static_cast<size_t>(column)], 0);
    }
  }
  EXPECT_GT(several, 1000);
}

}  // namespace
}  // namespace swarf::render::raster_shading
