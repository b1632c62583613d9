#include "toolpath/pose_curve.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/check.h"

namespace swarf::toolpath {

PoseCurve::PoseCurve(double step_mm, std::span<const ToolPose> poses)
    : step_(step_mm), intervals_(poses.size() - 1) {
  SWARF_CHECK(poses.size() >= 4 && step_mm > 0.0, "a curve of four poses at least");
  for (size_t k = 0; k < 6; ++k) {
    std::vector<double> column;
    column.reserve(poses.size());
    for (const ToolPose& pose : poses)
      column.push_back(k < 3 ? pose.tip_W[static_cast<Eigen::Index>(k)]
                             : pose.axis_W[static_cast<Eigen::Index>(k - 3)]);
    values_[k] = CubicSpline(0.0, step_mm, std::move(column));
  }
  // Between two knots the vector lies within h^2/8 |d''| of their chord, and that within half of its length
  // of one of both unit vectors.
  for (size_t i = 0; i < intervals_; ++i) {
    const double s = step_ * static_cast<double>(i);
    const double bend = std::max(rates(s).axis_bend.norm(), rates(s + step_).axis_bend.norm());
    const double chord = (poses[i + 1].axis_W - poses[i].axis_W).norm();
    shortest_ = std::min(shortest_, 1.0 - 0.5 * chord - 0.125 * step_ * step_ * bend);
  }
  SWARF_CHECK(shortest_ > 0.5, "the axis turns little between two poses of a curve");
}

PoseCurve::Rates PoseCurve::rates(double s) const {
  Rates found;
  for (size_t k = 0; k < 3; ++k) {
    const CubicSpline::Value tip = values_[k].at(s), axis = values_[k + 3].at(s);
    const auto i = static_cast<Eigen::Index>(k);
    found.tip[i] = tip.dw;
    found.tip_bend[i] = tip.ddw;
    found.axis[i] = axis.dw;
    found.axis_bend[i] = axis.ddw;
  }
  return found;
}

ToolPose PoseCurve::pose(double s) const {
  Vec3 tip, axis;
  for (size_t k = 0; k < 3; ++k) {
    tip[static_cast<Eigen::Index>(k)] = values_[k].at(s).w;
    axis[static_cast<Eigen::Index>(k)] = values_[k + 3].at(s).w;
  }
  return {tip, axis.normalized()};
}

PoseCurve::Bounds PoseCurve::bounds(double from, double to) const {
  Bounds found;
  const auto look = [&](double s) {
    const Rates at = rates(s);
    found.tip_rate = std::max(found.tip_rate, at.tip.norm());
    found.tip_bend = std::max(found.tip_bend, at.tip_bend.norm());
    found.axis_rate = std::max(found.axis_rate, at.axis.norm());
    found.axis_bend = std::max(found.axis_bend, at.axis_bend.norm());
  };
  look(from);
  for (double k = std::floor(from / step_) + 1.0; k * step_ < to; k += 1.0) look(k * step_);
  look(to);
  // From a place that was looked at it is at most half a step to any other.
  const double longest = std::min(step_, to - from);
  found.tip_rate += 0.5 * longest * found.tip_bend;
  found.axis_rate += 0.5 * longest * found.axis_bend;
  const double rate = found.axis_rate / shortest_;
  found.axis_bend = found.axis_bend / shortest_ + 2.0 * rate * rate;
  found.axis_rate = rate;
  return found;
}

}  // namespace swarf::toolpath
