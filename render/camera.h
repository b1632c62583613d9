// Cameras: framing and the matrices of a view.
#pragma once

#include "render/draw_list.h"

namespace swarf::render {

/// A camera that looks along `direction` (from the eye into the scene, any length) at the centre of the box
/// and stands just far enough to show all of it. `fov` is vertical, rad; `aspect` is width / height. +Z is
/// up.
Camera look_at_box(const Box& box, const Vec3& direction, double fov, double aspect);

/// View matrix: world to eye space (x right, y up, the camera looks along -z).
Eigen::Matrix4d view_matrix(const Camera& camera);

/// OpenGL's perspective matrix; depths `near` and `far` map to -1 and 1.
Eigen::Matrix4d perspective_matrix(double vertical_fov_rad, double aspect, double near, double far);

/// Where a place in front of the camera is drawn, px from the upper left corner of a picture of this size.
Vec2 picture_place(const Camera& camera, const Vec3& place, int width, int height);

/// At the camera's target, along the picture's axes.
double px_per_mm_at_target(const Camera& camera, int height);

/// The eight corners of a box.
std::array<Vec3, 8> corners(const Box& box);

}  // namespace swarf::render
