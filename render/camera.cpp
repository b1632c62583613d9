#include "render/camera.h"

#include <algorithm>
#include <cmath>

namespace swarf::render {
namespace {

constexpr double kMargin = 1.04;           // of the distance: a rim of 4 % around the box
constexpr double kAlmostVertical = 0.999;  // |cos| beyond which +Z no longer fixes the picture's upright

Vec3 upright_for(const Vec3& forward) {
  return std::abs(forward.z()) < kAlmostVertical ? Vec3(Vec3::UnitZ()) : Vec3(Vec3::UnitY());
}

}  // namespace

std::array<Vec3, 8> corners(const Box& box) {
  std::array<Vec3, 8> result;
  for (int i = 0; i < 8; ++i) {
    for (int k = 0; k < 3; ++k) result[i][k] = (i >> k & 1) != 0 ? box.upper[k] : box.lower[k];
  }
  return result;
}

Camera look_at_box(const Box& box, const Vec3& direction, double fov, double aspect) {
  Camera camera;
  const Vec3 forward = direction.normalized();
  camera.target = box.centre();
  camera.up = upright_for(forward);
  camera.vertical_fov_rad = fov;
  const Vec3 right = forward.cross(camera.up).normalized();
  const Vec3 up = right.cross(forward);
  const double tan_v = std::tan(0.5 * fov), tan_h = tan_v * aspect;
  double distance = 0.0;
  for (const Vec3& corner : corners(box)) {
    const Vec3 p = corner - camera.target;
    const double depth = p.dot(forward);  // the corner is inside when |p.right| <= (distance + depth) tan_h
    distance =
        std::max({distance, std::abs(p.dot(right)) / tan_h - depth, std::abs(p.dot(up)) / tan_v - depth});
  }
  camera.eye = camera.target - kMargin * distance * forward;
  return camera;
}

Eigen::Matrix4d view_matrix(const Camera& camera) {
  const Vec3 forward = (camera.target - camera.eye).normalized();
  Vec3 right = forward.cross(camera.up);
  if (right.norm() < 1e-9 * camera.up.norm()) right = forward.cross(upright_for(forward));
  right.normalize();
  Eigen::Matrix4d view = Eigen::Matrix4d::Identity();
  view.block<1, 3>(0, 0) = right;
  view.block<1, 3>(1, 0) = right.cross(forward);
  view.block<1, 3>(2, 0) = -forward;
  view.block<3, 1>(0, 3) = -view.block<3, 3>(0, 0) * camera.eye;
  return view;
}

Eigen::Matrix4d perspective_matrix(double vertical_fov_rad, double aspect, double near, double far) {
  const double f = 1.0 / std::tan(0.5 * vertical_fov_rad);
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  m(0, 0) = f / aspect;
  m(1, 1) = f;
  m(2, 2) = (far + near) / (near - far);
  m(2, 3) = 2.0 * far * near / (near - far);
  m(3, 2) = -1.0;
  return m;
}

Vec2 picture_place(const Camera& camera, const Vec3& place, int width, int height) {
  const Eigen::Vector4d at = view_matrix(camera) * place.homogeneous();
  const double px = 0.5 * height / (std::tan(0.5 * camera.vertical_fov_rad) * -at.z());  // per mm there
  return {0.5 * width + px * at.x(), 0.5 * height - px * at.y()};
}

double px_per_mm_at_target(const Camera& camera, int height) {
  return 0.5 * height / (std::tan(0.5 * camera.vertical_fov_rad) * (camera.target - camera.eye).norm());
}

}  // namespace swarf::render
