#include "render/camera.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/rng.h"
#include "base/units.h"

namespace swarf::render::raster_camera {
namespace {

/// Largest |x| or |y| of the box's corners on the picture, whose border is 1.
double reach(const Camera& camera, const Box& box, double aspect) {
  const Eigen::Matrix4d m =
      perspective_matrix(camera.vertical_fov_rad, aspect, 0.1, 1e5) * view_matrix(camera);
  double most = 0.0;
  for (const Vec3& corner : corners(box)) {
    const Eigen::Vector4d p = m * corner.homogeneous();
    EXPECT_GT(p.w(), 0.0);
    most = std::max({most, std::abs(p.x() / p.w()), std::abs(p.y() / p.w())});
  }
  return most;
}

TEST(Camera, FramesAnyBoxFromAnyDirectionWithANarrowRim) {
  Rng rng(11);
  for (int i = 0; i < 500; ++i) {
    const Vec3 corner(rng.uniform(-500, 500), rng.uniform(-500, 500), rng.uniform(-500, 500));
    const Box box{corner, corner + Vec3(rng.uniform(1, 400), rng.uniform(1, 400), rng.uniform(1, 400))};
    const Vec3 direction = i == 0 ? Vec3(0, 0, -1) : rng.direction();
    const double fov = rng.uniform(0.2, 1.2), aspect = rng.uniform(0.5, 2.5);
    const double r = reach(look_at_box(box, direction, fov, aspect), box, aspect);
    EXPECT_LT(r, 1.0) << "case " << i;
    EXPECT_GT(r, 0.85) << "case " << i;
  }
}

TEST(Camera, PlacesInThePictureAreThoseOfTheMatrices) {
  Rng rng(12);
  for (int i = 0; i < 100; ++i) {
    Camera camera;
    camera.eye = 200.0 * rng.direction();
    camera.vertical_fov_rad = rng.uniform(0.2, 1.2);
    const Vec3 place = rng.uniform(0.0, 50.0) * rng.direction();
    const Eigen::Vector4d p = perspective_matrix(camera.vertical_fov_rad, 1.5, 0.1, 1e5) *
                              view_matrix(camera) * place.homogeneous();
    const Vec2 at = picture_place(camera, place, 300, 200);
    EXPECT_NEAR(at.x(), 150.0 * (1.0 + p.x() / p.w()), 1e-9);
    EXPECT_NEAR(at.y(), 100.0 * (1.0 - p.y() / p.w()), 1e-9);
    // A mm across at the target.
    const Vec3 across = (camera.target - camera.eye).cross(camera.up).normalized();
    const double px = (picture_place(camera, camera.target + across, 300, 200) -
                       picture_place(camera, camera.target, 300, 200))
                          .norm();
    EXPECT_NEAR(px, px_per_mm_at_target(camera, 200), 1e-9);
  }
}

TEST(Camera, SeesXToTheRightAndZUpFromTheFront) {
  Camera camera;
  camera.eye = {0, -100, 0};
  const Eigen::Matrix4d view = view_matrix(camera);
  EXPECT_TRUE((view * Eigen::Vector4d(1, 0, 0, 1)).isApprox(Eigen::Vector4d(1, 0, -100, 1), 1e-12));
  EXPECT_TRUE((view * Eigen::Vector4d(0, 0, 1, 1)).isApprox(Eigen::Vector4d(0, 1, -100, 1), 1e-12));
}

TEST(Camera, DepthsMapToMinusOneAndOne) {
  const Eigen::Matrix4d m = perspective_matrix(rad_from_deg(90), 2.0, 10.0, 1000.0);
  const Eigen::Vector4d near = m * Eigen::Vector4d(20, 10, -10, 1), far = m * Eigen::Vector4d(0, 0, -1000, 1);
  EXPECT_TRUE((near / near.w()).isApprox(Eigen::Vector4d(1, 1, -1, 1), 1e-12));
  EXPECT_NEAR(far.z() / far.w(), 1.0, 1e-12);
}

}  // namespace
}  // namespace swarf::render::raster_camera
