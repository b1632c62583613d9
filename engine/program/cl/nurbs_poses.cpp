#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "program/cl/nurbs.h"
#include "program/control/curve.h"

namespace swarf::program {
namespace {

nc::NurbsCurve curve_of(const ClNurbs& nurbs, const std::vector<Vec3>& points) {
  std::vector<nc::CurvePoint> control(points.size());
  std::transform(points.begin(), points.end(), control.begin(), [](const Vec3& point) {
    return nc::CurvePoint{point, std::nullopt, {}};
  });
  return {nurbs.order, std::move(control), std::vector<double>(points.size(), 1.0), nurbs.knots};
}

}  // namespace

std::vector<ToolPose> nurbs_poses(const ClNurbs& nurbs, const Vec3& axis_W) {
  const nc::NurbsCurve low = curve_of(nurbs, nurbs.low_W);
  std::vector<double> at = nc::chord_ends(low, kNurbsChordMm);
  at.insert(at.begin(), 0.0);
  if (!nurbs.five_axis) {
    std::vector<ToolPose> poses;
    for (const double u : at) poses.push_back({low.at(u).tip, axis_W});
    return poses;
  }
  const nc::NurbsCurve high = curve_of(nurbs, nurbs.high_W);
  const std::vector<double> of_high = nc::chord_ends(high, kNurbsChordMm);
  at.insert(at.end(), of_high.begin(), of_high.end());
  std::sort(at.begin(), at.end());
  at.erase(std::unique(at.begin(), at.end()), at.end());
  std::vector<ToolPose> poses;
  for (const double u : at) {
    const Vec3 tip = low.at(u).tip, axis = high.at(u).tip - tip;
    if (!(axis.norm() > 1e-6)) throw std::invalid_argument("the upper curve meets the lower one");
    poses.push_back({tip, axis.normalized()});
  }
  return poses;
}

}  // namespace swarf::program
