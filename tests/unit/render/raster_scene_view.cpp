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
  const Vec2 lower(-1.0, -1.0), upper(1.0, 1.0);
  int left_out = 0;
  for (const Camera& camera : cameras()) {
    const Eigen::Matrix4d clip = view_of(camera).clip_from_world;
    for (int k = 0; k < 300; ++k) {
      Pose X_world = Pose::Identity();
      X_world.linear() = Eigen::AngleAxisd(angle(random), Vec3(1, 2, 3).normalized()).toRotationMatrix();
      X_world.translation() = Vec3(place(random), place(random), place(random));
      const Box box{Vec3::Zero(), Vec3(size(random), size(random), size(random))};
      if (may_lie_within(clip, box, X_world, lower, upper)) continue;
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

}  // namespace
}  // namespace swarf::render::raster_scene_view
