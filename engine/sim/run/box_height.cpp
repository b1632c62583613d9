#include "sim/run/box_height.h"

#include <algorithm>
#include <cmath>

namespace swarf::sim {
namespace {

constexpr double kBoxSlack = 1e-9;  // mm: rounding of points that lie on the box's border

/// Keeps the highest of the points that belong to both.
class HighestPoint {
 public:
  HighestPoint(const Box& box, const ToolPose& pose, double radius)
      : box_(box), pose_(pose), radius_(radius) {}

  Vec3 off_axis(const Vec3& direction) const {
    return direction - pose_.axis_W * pose_.axis_W.dot(direction);
  }

  void corner(const Vec3& point) {
    if (off_axis(point - pose_.tip_W).norm() <= radius_) take(point);
  }

  /// Where the edge goes through the cylinder's wall.
  void edge(const Vec3& from, const Vec3& to) {
    const Vec3 start = off_axis(from - pose_.tip_W), along = off_axis(to - from);
    const double a = along.squaredNorm(), b = start.dot(along);
    const double c = start.squaredNorm() - radius_ * radius_;
    const double root = b * b - a * c;
    if (a <= 0.0 || root < 0.0) return;
    for (const double sign : {-1.0, 1.0}) {
      const double share = (-b + sign * std::sqrt(root)) / a;
      if (share >= 0.0 && share <= 1.0) take(from + share * (to - from));
    }
  }

  /// The highest point of the plane x_i = `at` within the cylinder, where the face holds it.
  void face(int i, double at) {
    const double slope = pose_.axis_W[i];
    if (std::abs(slope) < kBoxSlack) return;  // along the axis: its edges are higher
    const Vec3 normal = Vec3::Unit(i), tilt = off_axis(normal);
    Vec3 aside = Vec3::Zero();
    if (tilt.norm() > kBoxSlack) {
      aside = -radius_ * (slope > 0.0 ? 1.0 : -1.0) * tilt.normalized();
    } else {  // level: all of it is as high
      const Vec3 foot = pose_.tip_W + pose_.axis_W * ((at - pose_.tip_W[i]) / slope);
      aside = off_axis(foot.cwiseMax(box_.lower).cwiseMin(box_.upper) - foot);
      if (aside.norm() > radius_) return;
    }
    const double height = (at - pose_.tip_W[i] - aside[i]) / slope;
    const Vec3 point = pose_.tip_W + height * pose_.axis_W + aside;
    const bool inside = ((point - box_.lower).array() >= -kBoxSlack).all() &&
                        ((box_.upper - point).array() >= -kBoxSlack).all();
    if (inside) take(point);
  }

  std::optional<double> height;

 private:
  void take(const Vec3& point) {
    const double here = pose_.axis_W.dot(point - pose_.tip_W);
    if (!height || here > *height) height = here;
  }

  const Box& box_;
  const ToolPose& pose_;
  double radius_;
};

}  // namespace

std::optional<double> height_in_cylinder(const Box& box, const ToolPose& pose, double radius_mm) {
  HighestPoint highest(box, pose, radius_mm);
  const auto corner = [&](int i) {
    return Vec3((i & 1) != 0 ? box.upper.x() : box.lower.x(), (i & 2) != 0 ? box.upper.y() : box.lower.y(),
                (i & 4) != 0 ? box.upper.z() : box.lower.z());
  };
  for (int i = 0; i < 8; ++i) {
    highest.corner(corner(i));
    for (const int step : {1, 2, 4})
      if ((i & step) == 0) highest.edge(corner(i), corner(i | step));
  }
  for (int i = 0; i < 3; ++i)
    for (const double at : {box.lower[i], box.upper[i]}) highest.face(i, at);
  return highest.height;
}

double height_of_box(const Box& box, const ToolPose& pose) {
  return pose.axis_W.dot(box.centre() - pose.tip_W) + 0.5 * pose.axis_W.cwiseAbs().dot(box.size());
}

}  // namespace swarf::sim
