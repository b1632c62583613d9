#include "render/raster/scene_view.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "render/camera.h"

namespace swarf::render {
namespace {

constexpr double kGroundReach = 2.2;  // radius of the floor in radii of the scene
constexpr double kNearShare = 0.002;  // nearest plane as a share of the farthest: 24-bit depth stays fine
/// Of the scene's radius: how far below it the floor lies, so that the inside of a bottom that a section
/// opens is not mixed with it.
constexpr double kFloorGap = 1e-3;
constexpr double kLightMargin = 1.05;  // of the scene's radius: nothing touches the border of the shadow map

/// Texels along the longer side of the shadow map: of the whole scene, and the least where the picture can
/// look at less of it. A close-up has its own shadows so, and no map costs much more than any other.
constexpr double kShadowMost = 2040.0, kShadowLeast = 1528.0;
/// Texels beyond what can be looked at: a place is looked up off its surface, by two taps of four texels.
constexpr int kShadowBeside = 4;
constexpr double kLeastShadowed = 1e-4;  // of the scene's radius: where nothing of it is looked at

/// A direction `left` and `elevation` (degrees) as the camera's bearing sees it: 0 is from behind the camera.
Vec3 light_direction(const Vec3& forward, double left_deg, double elevation_deg) {
  const double bearing = std::atan2(-forward.y(), -forward.x()) - left_deg * (M_PI / 180.0);
  const double elevation = elevation_deg * (M_PI / 180.0);
  return {std::cos(bearing) * std::cos(elevation), std::sin(bearing) * std::cos(elevation),
          std::sin(elevation)};
}

Eigen::Matrix4d parallel_projection(const Vec3& towards_light, const Vec3& centre, double radius) {
  const Vec3 right = Vec3::UnitZ().cross(towards_light).normalized();
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.block<1, 3>(0, 0) = right / radius;
  m.block<1, 3>(1, 0) = towards_light.cross(right) / radius;
  m.block<1, 3>(2, 0) = -towards_light / radius;
  m.block<3, 1>(0, 3) = -m.block<3, 3>(0, 0) * centre;
  return m;
}

/// Where the edges of the pyramid that the picture shows pass through the heights of the scene: the corners
/// of all that is seen of items and floor.
std::vector<Vec3> seen_corners(const Vec3& eye, const SceneView& view, double lowest, double highest) {
  const auto corner = [&](int i) {
    const Vec3 direction =
        view.forward + ((i & 1) != 0 ? view.right : -view.right) + ((i & 2) != 0 ? view.up : -view.up);
    return Vec3(eye + ((i & 4) != 0 ? view.far : view.near) * direction);
  };
  std::vector<Vec3> found;
  for (int i = 0; i < 8; ++i) {
    for (const int bit : {1, 2, 4}) {
      if ((i & bit) != 0) continue;
      const Vec3 a = corner(i), along = corner(i | bit) - a;
      double from = 0.0, to = 1.0;
      for (const auto& [above, rise] :
           {std::pair(a.z() - lowest, along.z()), std::pair(highest - a.z(), -along.z())}) {
        // Kept where above + t * rise >= 0.
        if (rise > 0.0) from = std::max(from, -above / rise);
        if (rise < 0.0) to = std::min(to, -above / rise);
        if (rise == 0.0 && above < 0.0) to = -1.0;
      }
      if (from > to) continue;
      found.push_back(a + from * along);
      found.push_back(a + to * along);
    }
  }
  return found;
}

/// Of a sphere that holds the scene, what lies under the light of the places.
void fit_shadow_map(SceneView& view, const Vec3& centre, double radius, const std::vector<Vec3>& places) {
  const Eigen::Matrix4d whole = parallel_projection(view.key, centre, radius);
  Vec2 lower = Vec2::Ones(), upper = -lower;
  for (const Vec3& place : places) {
    const Vec2 at = (whole * place.homogeneous()).head<2>();
    lower = lower.cwiseMin(at.cwiseMax(-1.0));
    upper = upper.cwiseMax(at.cwiseMin(1.0));
  }
  const Vec2 middle = 0.5 * (lower + upper), size = (upper - lower).cwiseMax(kLeastShadowed);
  const double texel =
      size.maxCoeff() / std::clamp(0.5 * size.maxCoeff() * kShadowMost, kShadowLeast, kShadowMost);
  view.shadow_columns = static_cast<int>(std::ceil(size.x() / texel)) + 2 * kShadowBeside;
  view.shadow_rows = static_cast<int>(std::ceil(size.y() / texel)) + 2 * kShadowBeside;
  view.shadow_texel_mm = radius * texel;
  view.light_clip_from_world = whole;
  const Vec2 half = 0.5 * texel * Vec2(view.shadow_columns, view.shadow_rows);
  for (int k = 0; k < 2; ++k) {
    view.light_clip_from_world(k, 3) -= middle[k];
    view.light_clip_from_world.row(k) /= half[k];
  }
}

}  // namespace

void extend(Box& bounds, const Box& box, const Pose& X_world) {
  for (const Vec3& corner : corners(box)) {
    const Vec3 p = X_world * corner;
    bounds.lower = bounds.lower.cwiseMin(p);
    bounds.upper = bounds.upper.cwiseMax(p);
  }
}

bool may_lie_within(const Eigen::Matrix4d& clip_from_world, const Box& box, const Pose& X_world) {
  int beyond[4] = {};
  for (const Vec3& corner : corners(box)) {
    const Eigen::Vector4d p = clip_from_world * (X_world * corner).homogeneous();
    for (int k = 0; k < 2; ++k) {
      beyond[k] += p[k] < -p.w() ? 1 : 0;
      beyond[k + 2] += p[k] > p.w() ? 1 : 0;
    }
  }
  return std::none_of(std::begin(beyond), std::end(beyond), [](int count) { return count == 8; });
}

bool is_looked_into(const SceneView& view, const Vec3& eye, const DrawItem& item) {
  if (item.enclosed == nullptr) return false;
  const Vec3 at = item.X_world.inverse() * eye;
  const double reach = view.near * (view.forward + view.right + view.up).norm();  // to a corner of that plane
  return std::any_of(item.enclosed->around.begin(), item.enclosed->around.end(), [&](const Box& box) {
    return (at - at.cwiseMax(box.lower).cwiseMin(box.upper)).norm() <= reach;
  });
}

Vec3 nearness_of_level(const SceneView& view, const Vec3& eye, double height) {
  constexpr double kInItsPlane_mm = 1e-9;
  const double rise = height - eye.z();
  if (std::abs(rise) < kInItsPlane_mm) return Vec3::Zero();
  return Vec3(view.right.z(), view.up.z(), view.forward.z()) / rise;
}

SceneView scene_view(const Camera& camera, const Box& bounds, double aspect) {
  SceneView view;
  const double radius = std::max(0.5 * bounds.size().norm(), 1e-3);
  const Vec3 forward = (camera.target - camera.eye).normalized();
  view.key = light_direction(forward, 38.0, 52.0);
  view.fill = light_direction(forward, -55.0, 20.0);
  view.rim = light_direction(forward, -150.0, 35.0);
  view.ground_centre = {bounds.centre().x(), bounds.centre().y(), bounds.lower.z() - kFloorGap * radius};
  view.ground_radius = kGroundReach * radius;
  view.far = (camera.eye - bounds.centre()).norm() + std::sqrt(2.0) * view.ground_radius + radius;
  view.near = std::max((camera.eye - bounds.centre()).norm() - radius, kNearShare * view.far);
  const Eigen::Matrix4d from_world = view_matrix(camera);
  view.clip_from_world =
      perspective_matrix(camera.vertical_fov_rad, aspect, view.near, view.far) * from_world;
  const double half = std::tan(0.5 * camera.vertical_fov_rad);
  view.right = half * aspect * from_world.block<1, 3>(0, 0).transpose();
  view.up = half * from_world.block<1, 3>(1, 0).transpose();
  view.forward = -from_world.block<1, 3>(2, 0).transpose();
  fit_shadow_map(view, bounds.centre(), kLightMargin * radius,
                 seen_corners(camera.eye, view, view.ground_centre.z(), bounds.upper.z()));
  return view;
}

}  // namespace swarf::render
