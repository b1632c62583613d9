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

/// The eight corners of a box.
std::array<Vec3, 8> corners(const Box& box);

}  // namespace swarf::render
