#include "render/raster/scene_view.h"

#include <gtest/gtest.h>

#include <random>

#include "raster_scene.h"

namespace swarf::render::raster_scene_view {
namespace {

/// Over, under and within a scene of 100 mm; none looks along the level.
std::vector<Camera> cameras() {
  std::vector<Camera> list(4);
  list[0].eye = {120, -200, 150};
  list[1].eye = {20, -90, -160};
  list[2].eye = {10, 15, 30};
  list[2].target = {60, 20, 10};
  list[3].eye = {5, 5, 80};
  list[3].target = {10, 5, 200};
  list[3].up = Vec3::UnitX();
  return list;
}

SceneView view_of(const Camera& camera) {
  return scene_view(camera, {Vec3::Constant(-50.0), Vec3::Constant(50.0)}, 1.6);
}

TEST(SceneView, ALevelIsAsNearAsItsPoints) {
  constexpr double kHeight = -50.0;
  int before = 0;
  for (const Camera& camera : cameras()) {
    const SceneView view = view_of(camera);
    const Vec3 nearness = nearness_of_level(view, camera.eye, kHeight);
    for (double x = -400; x <= 400; x += 50) {
      for (double y = -400; y <= 400; y += 50) {
        const Eigen::Vector4d p = view.clip_from_world * Eigen::Vector4d(x, y, kHeight, 1.0);
        // Of a point behind the eye the picture sees the mirrored place, and no level there.
        EXPECT_NEAR(nearness.dot(Vec3(p.x() / p.w(), p.y() / p.w(), 1.0)), 1.0 / p.w(), 1e-9);
        before += p.w() > 0.0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(before, 300);
}

TEST(SceneView, ALevelOnEdgeIsNotSeen) {
  Camera level;
  level.eye = {0, -200, 10};
  level.target = {0, 0, 10};
  EXPECT_EQ(nearness_of_level(view_of(level), level.eye, 10.0), Vec3(0.0, 0.0, 0.0));
}

/// Against points of the boxes, many of which hold the eye or reach behind it.
TEST(SceneView, OnlyABoxBesideThePictureIsLeftOut) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-150.0, 150.0), size(1.0, 120.0), angle(0.0, 3.0);
  int left_out = 0;
  for (const Camera& camera : cameras()) {
    const Eigen::Matrix4d clip = view_of(camera).clip_from_world;
    for (int k = 0; k < 300; ++k) {
      Pose X_world = Pose::Identity();
      X_world.linear() = Eigen::AngleAxisd(angle(random), Vec3(1, 2, 3).normalized()).toRotationMatrix();
      X_world.translation() = Vec3(place(random), place(random), place(random));
      const Box box{Vec3::Zero(), Vec3(size(random), size(random), size(random))};
      if (may_lie_within(clip, box, X_world)) continue;
      ++left_out;
      for (int i = 0; i < 6 * 6 * 6; ++i) {
        const Vec3 share = Vec3(i % 6, i / 6 % 6, i / 36) / 5.0;
        const Eigen::Vector4d p = clip * (X_world * box.size().cwiseProduct(share)).homogeneous();
        EXPECT_FALSE(p.w() > 0.0 && std::abs(p.x()) <= p.w() && std::abs(p.y()) <= p.w());
      }
    }
  }
  EXPECT_GT(left_out, 300);
}

/// Of all places in the scene that the picture shows, with room for the taps beside them; no coarser than a
/// map of 2040 texels over the whole scene, and finer in a close-up.
TEST(SceneView, TheShadowMapHoldsWhatThePictureShows) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-50.0, 50.0), off(-30.0, 30.0);
  constexpr double kWhole_mm = 1.05 * 2.0 * 86.60254;  // about a sphere around the box
  std::vector<Camera> all = cameras();
  for (int k = 0; k < 40; ++k) {
    Camera close;
    close.target = {place(random), place(random), place(random)};
    close.eye = close.target + Vec3(off(random), off(random), 5.0 + std::abs(off(random)));
    all.push_back(close);
  }
  int shown = 0, finer = 0;
  for (const Camera& camera : all) {
    const SceneView view = view_of(camera);
    EXPECT_LE(view.shadow_texel_mm, kWhole_mm / 2040.0 * (1.0 + 1e-6));
    EXPECT_LE(std::max(view.shadow_columns, view.shadow_rows), 2048);
    finer += view.shadow_texel_mm < 0.5 * kWhole_mm / 2040.0 ? 1 : 0;
    const Vec2 half(0.5 * view.shadow_columns, 0.5 * view.shadow_rows);  // texels
    for (int k = 0; k < 3000; ++k) {
      const Eigen::Vector4d at(place(random), place(random), k % 3 == 0 ? -50.0 : place(random), 1.0);
      const Eigen::Vector4d seen = view.clip_from_world * at;
      if (seen.head<3>().cwiseAbs().maxCoeff() > seen.w()) continue;
      ++shown;
      const Vec3 lit = (view.light_clip_from_world * at).head<3>();
      for (int axis = 0; axis < 2; ++axis)
        EXPECT_LE(std::abs(lit[axis]) * half[axis], half[axis] - 3.0) << at.transpose();
      EXPECT_LE(std::abs(lit.z()), 1.0);
    }
  }
  EXPECT_GT(shown, 10000);
  EXPECT_GE(finer, 5);
}

}  // namespace
}  // namespace swarf::render::raster_scene_view
