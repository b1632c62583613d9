#include "post/tilted_plane.h"

#include <cmath>

#include <Eigen/Geometry>

#include "base/units.h"

namespace swarf::post {
namespace {

/// Sines below it do not tell an angle: the first and the third turn are about one axis then.
constexpr double kOneAxis = 1e-9;

Mat3 about(int axis, double angle_deg) {
  return Eigen::AngleAxisd(rad_from_deg(angle_deg), Vec3::Unit(axis)).toRotationMatrix();
}

/// The least turn that brings Z there; straight down it is half a turn about X.
Mat3 least_turn(const Vec3& axis_W) {
  const Vec3 across = Vec3::UnitZ().cross(axis_W);
  const double angle = std::atan2(across.norm(), axis_W.z());
  const Vec3 about_it = across.norm() > kOneAxis ? Vec3(across.normalized()) : Vec3(Vec3::UnitX());
  return Eigen::AngleAxisd(angle, about_it).toRotationMatrix();
}

Vec3 zxz(const Mat3& R) {
  const double middle = std::atan2(std::hypot(R(0, 2), R(1, 2)), R(2, 2));
  if (std::sin(middle) < kOneAxis) return {0.0, R(2, 2) > 0.0 ? 0.0 : kPi, std::atan2(-R(0, 1), R(0, 0))};
  return {std::atan2(R(0, 2), -R(1, 2)), middle, std::atan2(R(2, 0), R(2, 1))};
}

Vec3 zyx(const Mat3& R) {
  const double level = std::hypot(R(0, 0), R(1, 0)), middle = std::atan2(-R(2, 0), level);
  if (level < kOneAxis) return {0.0, middle, std::atan2(-R(1, 2), R(1, 1))};
  return {std::atan2(R(1, 0), R(0, 0)), middle, std::atan2(R(2, 1), R(2, 2))};
}

}  // namespace

TiltedPlane tilted_plane(const Vec3& axis_W, const PlaneRules& rules) {
  const Mat3 wanted = least_turn(axis_W.normalized());
  const Vec3 turns = rules.turns == PlaneTurns::kZXZ ? zxz(wanted) : zyx(wanted);
  const double steps = std::pow(10.0, rules.decimals);
  constexpr std::array<std::array<int, 3>, 2> kAxes{{{2, 0, 2}, {2, 1, 0}}};
  TiltedPlane plane;
  for (size_t i = 0; i < 3; ++i) {
    plane.turns_deg.at(i) = std::round(deg_from_rad(turns[static_cast<long>(i)]) * steps) / steps;
    plane.R *= about(kAxes.at(static_cast<size_t>(rules.turns)).at(i), plane.turns_deg.at(i));
  }
  return plane;
}

}  // namespace swarf::post
