#include "motion/judged/motion_check.h"

#include <fmt/format.h>

#include <cmath>

#include "motion/judged/motion_statistics.h"

namespace swarf::motion {
namespace {

constexpr double kUnitTolerance = 1e-12;
constexpr double kTimeTolerance = 1e-9;
constexpr double kTipTolerance = 1e-9;    // mm
constexpr double kAxisTolerance = 1e-12;  // rad

bool is_finite(const ToolSample& sample) {
  return sample.pose.tip_W.allFinite() && sample.pose.axis_W.allFinite() && sample.contact_W.allFinite() &&
         std::isfinite(sample.t_s) && std::isfinite(sample.u) && std::isfinite(sample.v) &&
         std::isfinite(sample.feed_mm_s);
}

std::string check_numbers(const Trajectory& trajectory) {
  for (size_t k = 0; k < trajectory.samples.size(); ++k) {
    if (!is_finite(trajectory.samples[k]) || !trajectory.axes[k].allFinite())
      return fmt::format("2: sample {} holds a number that is not finite", k);
  }
  return "";
}

std::string check_unit_axes(const Trajectory& trajectory) {
  for (size_t k = 0; k < trajectory.samples.size(); ++k) {
    const double length = trajectory.samples[k].pose.axis_W.norm();
    if (std::abs(length - 1.0) > kUnitTolerance)
      return fmt::format("3: the tool axis of sample {} has length {:.15f}", k, length);
  }
  return "";
}

std::string check_times(const Trajectory& trajectory) {
  for (size_t k = 0; k < trajectory.samples.size(); ++k) {
    const double periods = trajectory.samples[k].t_s / trajectory.period_s;
    const auto count = static_cast<double>(k);
    if (std::abs(periods - count) > kTimeTolerance * (1.0 + count))
      return fmt::format("4: sample {} stands at {:.9f} periods", k, periods);
  }
  return "";
}

std::string check_forward(const Trajectory& trajectory, const kinematics::MachineModel& machine) {
  for (size_t k = 0; k < trajectory.samples.size(); ++k) {
    const ToolPose back = kinematics::forward(machine, trajectory.axes[k]);
    const double tip = (back.tip_W - trajectory.samples[k].pose.tip_W).norm();
    const double axis = (back.axis_W - trajectory.samples[k].pose.axis_W).norm();
    if (tip > kTipTolerance || axis > kAxisTolerance)
      return fmt::format("5: forward of the axes of sample {} misses the pose by {:.3g} mm, {:.3g} rad", k,
                         tip, axis);
  }
  return "";
}

std::string check_speeds(const Trajectory& trajectory, const kinematics::MachineModel& machine) {
  for (size_t k = 1; k < trajectory.samples.size(); ++k) {
    for (size_t i = 0; i < machine.axes.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const double speed =
          std::abs(trajectory.axes[k][row] - trajectory.axes[k - 1][row]) / trajectory.period_s;
      if (speed > machine.axes[i].speed_max * (1.0 + kAxisSpeedTolerance))
        return fmt::format("6: axis {} moves at {:.6g} per s to sample {}, its limit is {:.6g}",
                           machine.axes[i].name, speed, k, machine.axes[i].speed_max);
    }
  }
  return "";
}

}  // namespace

std::string check_motion(const Trajectory& trajectory, const kinematics::MachineModel& machine) {
  if (trajectory.axes.size() != trajectory.samples.size())
    return fmt::format("1: {} axis values for {} samples", trajectory.axes.size(), trajectory.samples.size());
  if (!(trajectory.period_s > 0.0)) return fmt::format("1: the period is {:g} s", trajectory.period_s);
  std::string reason = check_numbers(trajectory);
  if (reason.empty()) reason = check_unit_axes(trajectory);
  if (reason.empty()) reason = check_times(trajectory);
  if (reason.empty()) reason = check_forward(trajectory, machine);
  if (reason.empty()) reason = check_speeds(trajectory, machine);
  return reason;
}

}  // namespace swarf::motion
