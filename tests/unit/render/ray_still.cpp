// Stills: the same for any thread count, true to geometry, shadows, colours, lines, and scallops that show.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "base/units.h"
#include "mesh/mesh_ops.h"
#include "render/figures/colour.h"
#include "render/figures/figure_mesh.h"
#include "render/ray/ray_scene.h"
#include "render/ray/sampler.h"
#include "render/ray/still.h"
#include "render/ray/studio.h"

namespace swarf::render {
namespace {

StillOptions small_picture() {
  StillOptions options;
  options.width = 160;
  options.height = 90;
  options.samples_per_pixel = 8;
  return options;
}

/// A square plate of 40 mm at height z, facing up.
TriMesh plate(float z) {
  TriMesh mesh;
  mesh.positions = {{-20, -20, z}, {20, -20, z}, {20, 20, z}, {-20, 20, z}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

Camera from_above() {
  Camera camera;
  camera.eye = {0, 0, 200};
  camera.target = {0, 0, 0};
  camera.up = {0, 1, 0};
  camera.vertical_fov_rad = 0.5;
  return camera;
}

std::array<int, 3> rgb_at(const Image& image, int x, int y) {
  const uint8_t* p = &image.rgba[4 * (static_cast<size_t>(y) * image.width + x)];
  return {p[0], p[1], p[2]};
}

int brightness(const Image& image, int x, int y) {
  const auto p = rgb_at(image, x, y);
  return p[0] + p[1] + p[2];
}

TEST(Still, SamePictureForAnyNumberOfThreadsAndADifferentOneForAnotherSeed) {
  const TriMesh body = cylinder_mesh(30, 20, 2);
  DrawList list;
  list.items.push_back({&body, Pose::Identity(), {}, false});
  StillOptions options = small_picture();
  set_thread_count(1);
  const Image one = render_still(list, options);
  set_thread_count(0);
  EXPECT_EQ(one.rgba, render_still(list, options).rgba);
  options.seed = 2;
  EXPECT_NE(one.rgba, render_still(list, options).rgba);
}

TEST(Still, DrawingsOfTheSameTrianglesShareATreeAndOthersDoNot) {
  TriMesh body = cylinder_mesh(30, 20, 2), floor = plate(-25);
  DrawList list;
  list.items.push_back({&body, Pose::Identity(), {}, false});
  list.items.push_back({&floor, Pose::Identity(), {}, false});
  StillOptions alone = small_picture(), sharing = alone;
  RayTreePtr tree;
  sharing.kept_tree = &tree;
  const auto same_picture = [&] {
    const Image image = render_still(list, alone);
    EXPECT_EQ(render_still(list, sharing).rgba, image.rgba);
    return image;
  };
  same_picture();
  const RayTree* const first = tree.get();
  ASSERT_NE(first, nullptr);
  list.items[0].material.colour = {0.9F, 0.1F, 0.1F};  // other looks alone
  list.camera.eye.x() += 50.0;
  const Image red = same_picture();
  EXPECT_EQ(tree.get(), first);
  const auto other_tree = [&](const char* what) {
    const RayTreePtr before = tree;  // so that no other can lie at its place
    EXPECT_NE(same_picture().rgba, red.rgba) << what;
    EXPECT_NE(tree, before) << what;
  };
  list.items[0].X_world.translation().z() += 4.0;
  other_tree("moved");
  list.items[0].X_world = Pose::Identity();
  const std::array<float, 3> last = body.positions.back();
  body.positions.back()[2] += 9.0F;
  other_tree("another vertex");
  body.positions.back() = last;
  const std::array<uint32_t, 3> corners = body.triangles.back();
  body.triangles.back() = body.triangles.front();
  other_tree("another triangle");
  body.triangles.back() = corners;
  list.items.pop_back();
  other_tree("one item less");
  list.items.clear();
  const RayTreePtr before = tree;
  same_picture();
  EXPECT_EQ(tree, before) << "an empty drawing needs none";
}

TEST(Still, EmptyDrawingIsTheBackdrop) {
  const StillOptions options = small_picture();
  const Image image = render_still(DrawList{}, options);
  ASSERT_EQ(image.rgba.size(), size_t{4} * 160 * 90);
  EXPECT_EQ(image.rgba[3], 255);
  EXPECT_NEAR(rgb_at(image, 80, 0)[0], srgb8_from_linear(options.backdrop_top)[0], 3);
  EXPECT_EQ(rgb_at(image, 3, 40), rgb_at(image, 150, 40));
}

TEST(Still, ATransparentOneHasNothingBehindTheDrawing) {
  const TriMesh mesh = plate(0);
  DrawList list;
  list.camera = from_above();
  list.items.push_back({&mesh, Pose::Identity(), {}, false});
  StillOptions options = small_picture();
  const Image solid = render_still(list, options);
  options.transparent = true;
  const Image image = render_still(list, options);
  EXPECT_EQ(image.rgba[3], 0);
  const size_t middle = 4 * (45 * 160 + 80);
  EXPECT_EQ(image.rgba[middle + 3], 255);
  EXPECT_EQ(image.rgba[middle], solid.rgba[middle]);
}

/// Root mean square of what one picture is off the other, green, of 255.
double green_rms(const Image& image, const Image& truth) {
  double squares = 0.0;
  for (size_t i = 1; i < image.rgba.size(); i += 4) {
    const double off = double{1} * image.rgba[i] - truth.rgba[i];
    squares += off * off;
  }
  return std::sqrt(4.0 * squares / static_cast<double>(image.rgba.size()));
}

/// Against a picture of very many samples: what stops early is no farther off than it says, nearly
/// everywhere.
TEST(Still, SamplingStopsAtTheStatedNoise) {
  const TriMesh post = cylinder_mesh(10, 30, 1);
  DrawList list;
  list.camera = from_above();
  list.items.push_back({&post, Pose::Identity(), {{0.6F, 0.6F, 0.6F}, 1.0F, 0.3F}, false});
  StillOptions options = small_picture();
  options.samples_per_pixel = 1024;
  const Image truth = render_still(list, options);
  options.samples_per_pixel = 256;
  options.noise = 3.0;
  const Image image = render_still(list, options);
  EXPECT_LT(green_rms(image, truth), options.noise);
}

/// Root mean square of what a picture is off one of very many samples with another seed, green, of 255.
double noise_of(const DrawList& list, StillOptions options) {
  options.samples_per_pixel = 16;
  options.noise = 5.0;
  const Image image = render_still(list, options);
  options.samples_per_pixel = 512;
  options.noise = 0.0;
  options.seed = 9;
  const Image truth = render_still(list, options);
  return green_rms(image, truth);
}

TriMesh ball() {
  constexpr int kSegments = 48;
  std::vector<Vec2> profile;
  for (int i = 0; i <= kSegments; ++i) {
    const double angle = kPi * i / kSegments;
    profile.emplace_back(i % kSegments == 0 ? 0.0 : 25.0 * std::sin(angle), -25.0 * std::cos(angle));
  }
  return revolved_profile(profile, 2 * kSegments);
}

/// Most of their noise is of the strip lights, which are known without rays.
TEST(Still, PolishedSurfacesHaveLittleNoise) {
  const TriMesh mesh = ball();
  DrawList list;
  list.camera = from_above();
  list.items.push_back({&mesh, Pose::Identity(), {{0.56F, 0.57F, 0.59F}, 1.0F, 0.16F}, false});
  EXPECT_LT(noise_of(list, small_picture()), 2.2);
}

/// A pixel's first samples may all miss a line through it.
TEST(Still, LinesAreFoundByThePixelsBesideThem) {
  const TriMesh mesh = plate(0);
  DrawList list;
  list.camera = from_above();
  list.items.push_back({&mesh, Pose::Identity(), {{0.75F, 0.76F, 0.78F}, 0.0F, 0.6F}, false});
  for (int k = 0; k < 12; ++k)
    list.lines.push_back({{{-15, 3.0 * k - 16, 5}, {15, 3.0 * k - 14.5, 5}}, {0.02F, 0, 0}, 1.0F});
  StillOptions options = small_picture();
  options.strip_strength = 0.0;
  EXPECT_LT(noise_of(list, options), 2.7);
}

/// A floor's pixel whose first samples see neither shadow nor drawing is no brighter than the others.
TEST(Still, SamplesAreNotTakenFewerWhereTheFirstMeetNothing) {
  const TriMesh post = cylinder_mesh(10, 30, 1);
  DrawList list;
  list.camera = from_above();
  list.items.push_back({&post, Pose::Identity(), {}, false});
  StillOptions options = small_picture();
  const auto mean = [&](int samples, uint32_t seeds) {
    options.samples_per_pixel = samples;
    double sum = 0.0;
    for (options.seed = 1; options.seed <= seeds; ++options.seed) {
      const Image image = render_still(list, options);
      for (size_t i = 1; i < image.rgba.size(); i += 4) sum += image.rgba[i];
    }
    return sum / (160.0 * 90.0 * seeds);
  };
  EXPECT_NEAR(mean(128, 1), mean(4, 16), 0.1);
}

TEST(Studio, IrradianceIsTheMeanOfTheSurroundings) {
  const Studio studio{StillOptions{}};
  Rng rng(5);
  for (int round = 0; round < 40; ++round) {
    Vec3f n = rng.direction().cast<float>();
    if (round % 4 == 0) n.z() = 0.0F;
    if (round % 8 == 0) n = round == 0 ? Vec3f::UnitZ() : round == 8 ? Vec3f(0, -1, 0) : Vec3f(1, 0, 0);
    n.normalize();
    const Eigen::Matrix3f frame = frame_about(n);
    constexpr int kSamples = 40000;
    double sum = 0.0;
    for (int i = 0; i < kSamples; ++i) {
      const double turn = i * 0.6180339887498949;
      sum += studio.surroundings(frame * sample_cosine({(static_cast<float>(i) + 0.5F) / kSamples,
                                                        static_cast<float>(turn - std::floor(turn))}));
    }
    EXPECT_NEAR(studio.irradiance(n) / (sum / kSamples), 1.0, 0.025) << n.transpose();
  }
}

TEST(Still, SilhouetteFallsWhereTheCameraPutsIt) {
  TriMesh mesh = plate(0);
  DrawList list;
  list.camera = from_above();
  list.items.push_back({&mesh, Pose::Identity(), {{0.9F, 0.0F, 0.0F}, 0.0F, 1.0F}, false});
  StillOptions options = small_picture();
  options.floor = false;
  const Image image = render_still(list, options);
  const double px_per_mm = 45.0 / (200 * std::tan(0.25));
  const int edge = static_cast<int>(std::lround(20 * px_per_mm));
  EXPECT_GT(rgb_at(image, 80 + edge - 3, 45)[0], 2 * rgb_at(image, 80 + edge - 3, 45)[2]);
  EXPECT_LT(rgb_at(image, 80 + edge + 3, 45)[0], 2 * rgb_at(image, 80 + edge + 3, 45)[2]);
}

TEST(Still, FloorTakesTheShadowOnTheSideAwayFromTheKeyLight) {
  const TriMesh post = cylinder_mesh(10, 30, 1);
  DrawList list;
  list.camera = from_above();
  list.items.push_back({&post, Pose::Identity(), {}, false});
  StillOptions options = small_picture();
  options.key_light_direction = {-1, 0, 1};
  const Image image = render_still(list, options);
  const int shaded = brightness(image, 80 + 18, 45), lit = brightness(image, 80 - 18, 45);
  EXPECT_LT(shaded, 0.8 * lit);
  EXPECT_GT(lit, 0.9 * brightness(image, 2, 45));
}

/// A white diffuse plate under an open sky: radiance is key * cosine + sky, so the byte is known.
TEST(Still, DiffusePlateHasTheRadianceOfTheLightsFormula) {
  const TriMesh mesh = plate(0);
  DrawList list;
  list.camera = from_above();
  list.items.push_back({&mesh, Pose::Identity(), {{0.5F, 0.5F, 0.5F}, 0.0F, 1.0F}, false});
  StillOptions options = small_picture();
  options.samples_per_pixel = 256;
  options.strip_strength = 0;
  options.key_light_direction = {0, 1, 1};
  const Image image = render_still(list, options);
  const double diffuse = 0.5 * (0.75 * std::cos(kPi / 4) + 0.40);
  const double low = 255 * srgb_from_linear(static_cast<float>(diffuse));
  // The coat adds up to about 4 % of the light.
  const double high = 255 * srgb_from_linear(static_cast<float>(diffuse + 0.05));
  EXPECT_GE(rgb_at(image, 80, 45)[1], low - 2);
  EXPECT_LE(rgb_at(image, 80, 45)[1], high);
}

TEST(Still, LinesAreAsWideAsTheySayAndHiddenBehindSolids) {
  const TriMesh mesh = plate(0);
  DrawList list;
  list.camera = from_above();
  list.items.push_back({&mesh, Pose::Identity(), {{0.5F, 0.5F, 0.5F}, 0.0F, 1.0F}, false});
  list.lines.push_back({{{-15, 0, 5}, {15, 0, 5}}, {1, 0, 0}, 4.0F});
  list.lines.push_back({{{-15, 10, -5}, {15, 10, -5}}, {1, 0, 0}, 4.0F});
  StillOptions options = small_picture();
  options.floor = false;
  options.strip_strength = 0;
  options.samples_per_pixel = 64;
  const Image image = render_still(list, options);
  double red_rows = 0;
  for (int y = 0; y < 90; ++y) {
    const auto p = rgb_at(image, 80, y);
    const Rgb linear = linear_from_srgb8(
        {static_cast<uint8_t>(p[0]), static_cast<uint8_t>(p[1]), static_cast<uint8_t>(p[2]), 255});
    const Rgb beside = linear_from_srgb8({static_cast<uint8_t>(rgb_at(image, 80, 60)[0]),
                                          static_cast<uint8_t>(rgb_at(image, 80, 60)[1]),
                                          static_cast<uint8_t>(rgb_at(image, 80, 60)[2]), 255});
    if (y > 30 && y < 60) red_rows += 1 - linear[1] / beside[1];
  }
  EXPECT_NEAR(red_rows, 4.0, 0.1) << "covered rows of one visible line";
}

/// Flat strips of 2.8 mm on R = 55 mm stand 10 um proud at their ridges: neighbours must differ in the
/// picture.
TEST(Still, ScallopsOfTenMicrometresShowAsStripes) {
  constexpr double kRadius = 55, kPitch = 2.1;
  std::vector<Vec3> points, smooth_normals, facet_normals;
  constexpr int kNu = 2, kNv = 401;
  for (int iv = 0; iv < kNv; ++iv) {
    const double angle = 0.4 * (2.0 * iv / (kNv - 1) - 1), step = kPitch / kRadius;
    const double facet = step * std::round(angle / step);
    const Vec3 facet_normal(0, std::sin(facet), std::cos(facet)), normal(0, std::sin(angle), std::cos(angle));
    for (int iu = 0; iu < kNu; ++iu) {
      const double r = kRadius / std::cos(angle - facet);
      points.push_back(r * normal + Vec3(40.0 * iu - 20, 0, -kRadius));
      facet_normals.push_back(facet_normal);
      smooth_normals.push_back(normal);
    }
  }
  StillOptions options = small_picture();
  options.height = 180;
  options.samples_per_pixel = 32;
  const auto roughness_of_column = [&](const std::vector<Vec3>& normals) {
    const TriMesh mesh = surface_grid_mesh(kNu, kNv, points, normals);
    DrawList list;
    list.camera = from_above();
    list.items.push_back({&mesh, Pose::Identity(), {{0.8F, 0.8F, 0.8F}, 1.0F, 0.15F}, false});
    const Image image = render_still(list, options);
    double jumps = 0;
    for (int y = 60; y < 120; ++y) {
      double now = 0, next = 0;  // mean over a row of the plate, to leave the noise out
      for (int x = 65; x < 95; ++x) {
        now += brightness(image, x, y) / 3.0 / 30;
        next += brightness(image, x, y + 1) / 3.0 / 30;
      }
      jumps += std::abs(next - now);
    }
    return jumps;
  };
  const double stripes = roughness_of_column(facet_normals);
  EXPECT_GT(stripes, 300.0) << "sum of steps in grey levels over 60 rows";
}

TEST(Studio, SpecularSamplesFollowTheirDensityAndNeverGainEnergy) {
  Rng rng(3);
  for (int round = 0; round < 20; ++round) {
    Hit hit;
    hit.colour = Vec3f::Ones();
    hit.metalness = 1;
    hit.roughness = static_cast<float>(rng.uniform(0.4, 1.0));
    const Reflection reflection(hit);
    const auto z = static_cast<float>(rng.uniform(0.2, 1.0));
    const Vec3f out(std::sqrt(1 - z * z), 0, z);
    constexpr int kSamples = 100000;
    double reflected = 0, by_density = 0;
    for (int i = 0; i < kSamples; ++i) {
      const Eigen::Vector2f xi(static_cast<float>(rng.uniform()), static_cast<float>(rng.uniform()));
      const Mirrored mirrored = MirrorLobe(reflection, out).sample(xi);
      const Vec3f& in = mirrored.in;
      if (in.z() > 0) {
        reflected += mirrored.weight.x();
        const float ratio = reflection.specular_times_cosine(out, in).x() / reflection.specular_pdf(out, in);
        ASSERT_NEAR(mirrored.weight.x(), ratio, 1e-3F * (1.0F + ratio));
      }
      const Vec3f uniform = rng.direction().cast<float>();
      const Vec3f up(uniform.x(), uniform.y(), std::abs(uniform.z()));
      by_density += reflection.specular_times_cosine(out, up).x() * 2 * kPi;
    }
    reflected /= kSamples;
    by_density /= kSamples;
    EXPECT_LE(reflected, 1.0 + 1e-3) << "roughness " << hit.roughness << " cosine " << z;
    EXPECT_NEAR(reflected, by_density, 0.06) << "roughness " << hit.roughness << " cosine " << z;
  }
}

TEST(Sampler, PairsOfOnePixelCoverTheSquareEvenly) {
  const BlueNoise noise;
  constexpr int kSamples = 64;
  int quadrant[4] = {0, 0, 0, 0};
  for (uint32_t i = 0; i < kSamples; ++i) {
    const Eigen::Vector2f p = Sampler(noise, 12, 34, i, 1).next();
    ASSERT_TRUE(p.x() >= 0 && p.x() < 1 && p.y() >= 0 && p.y() < 1);
    ++quadrant[(p.x() < 0.5F ? 0 : 1) + (p.y() < 0.5F ? 0 : 2)];
  }
  for (const int count : quadrant) EXPECT_NEAR(count, 0.25 * kSamples, 3);
}

TEST(Sampler, BlueNoiseHasEveryRankOnceAndFarNeighbours) {
  const BlueNoise noise;
  std::vector<float> ranks;
  double difference = 0;
  for (int y = 0; y < BlueNoise::kSize; ++y) {
    for (int x = 0; x < BlueNoise::kSize; ++x) {
      ranks.push_back(noise.at(x, y));
      difference += std::abs(noise.at(x, y) - noise.at(x + 1, y));
    }
  }
  std::sort(ranks.begin(), ranks.end());
  EXPECT_EQ(std::adjacent_find(ranks.begin(), ranks.end()), ranks.end());
  // Independent uniform numbers differ by 1/3 on average.
  EXPECT_GT(difference / static_cast<double>(ranks.size()), 0.36);
}

TEST(Still, RefusesNonsense) {
  StillOptions options;
  options.samples_per_pixel = 0;
  EXPECT_THROW(render_still(DrawList{}, options), InternalError);
  DrawList list;
  list.camera.up = list.camera.target - list.camera.eye;
  EXPECT_THROW(render_still(list, small_picture()), InternalError);
}

}  // namespace
}  // namespace swarf::render
