#include "program/control/work_space.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/diagnostics.h"
#include "kinematics/chain.h"

namespace swarf::program::nc {
namespace {

using kinematics::AxisValues;
using kinematics::MachineModel;

std::array<int, kAxisWords> axes_by_word(const MachineModel& machine) {
  std::array<int, kAxisWords> of{-1, -1, -1, -1, -1, -1};
  for (size_t i = 0; i < machine.axes.size(); ++i) {
    const std::string& name = machine.axes[i].name;
    const std::string_view letters = kAxisLetters;
    const size_t word = name.size() == 1 ? letters.find(name[0]) : std::string_view::npos;
    const bool linear = machine.axes[i].kind == kinematics::AxisKind::kLinear;
    if (word == std::string_view::npos || linear != (word < 3)) {
      throw InputError(
          "axis-names", {machine.name},
          fmt::format("axis {} cannot be programmed: NC words are X Y Z for linear and A B C for "
                      "rotary axes",
                      name),
          "rename the axis in the machine file");
    }
    of[word] = static_cast<int>(i);
  }
  for (size_t word = 0; word < 3; ++word) {
    if (of[word] < 0) {
      throw InputError("axis-names", {machine.name},
                       fmt::format("the machine has no axis {}", kAxisLetters[word]),
                       "name its linear axes X, Y and Z");
    }
  }
  return of;
}

}  // namespace

WorkSpace::WorkSpace(const MachineModel& machine)
    : machine_(kinematics::with_tool(machine, 0.0)),
      real_machine_(machine_),
      inverse_(machine_),
      axis_(axes_by_word(machine)) {
  kinematics::from_tool_to_work(machine_, [&](const kinematics::LinkStep& step) { chain_.push_back(step); });
  compute(machine_, {0.0, 0.0, 0.0}, at_zero_);
  gauge_zero_ = axis_values(at_zero_.inverse * -at_zero_.base_W, {0.0, 0.0, 0.0});
  origin_ = gauge_zero_;
  update();
}

void WorkSpace::set_length(double length_mm) {
  length_mm_ = length_mm;
  machine_ = kinematics::with_tool(machine_, length_mm);
  compensated_.valid = false;
  compute(machine_, {0.0, 0.0, 0.0}, at_zero_);
  update();
}

void WorkSpace::set_true_length(double length_mm) {
  real_machine_ = kinematics::with_tool(real_machine_, length_mm);
  real_.valid = false;
}

std::array<double, 3> WorkSpace::rotary_of(const AxisValues& q) const {
  std::array<double, 3> rotary{};
  for (size_t slot = 0; slot < 3; ++slot) {
    if (axis_[slot + 3] >= 0) rotary[slot] = q[axis_[slot + 3]];
  }
  return rotary;
}

Vec3 WorkSpace::linear_of(const AxisValues& q) const {
  return {q[axis_[0]], q[axis_[1]], q[axis_[2]]};
}

AxisValues WorkSpace::axis_values(const Vec3& linear, const std::array<double, 3>& rotary) const {
  AxisValues q = AxisValues::Zero();
  for (size_t i = 0; i < 3; ++i) {
    q[axis_[i]] = linear[static_cast<long>(i)];
    if (axis_[i + 3] >= 0) q[axis_[i + 3]] = rotary[i];
  }
  return q;
}

double WorkSpace::rotary_zero(int slot) const {
  const int axis = axis_of(slot + 3);
  return axis < 0 ? 0.0 : origin_[axis] + shift_[axis];
}

void WorkSpace::update() {
  const Vec3 shifted = linear_of(origin_) + linear_of(shift_);
  // With the rotary axes at zero, a longer tool lifts the gauge line by its length.
  const Vec3 lifted = at_zero_.inverse * -at_zero_.base_W;
  axes_base_ = shifted + (lifted - linear_of(gauge_zero_)) + frame_.translation();
  axes_rotation_ = frame_.linear();
  X_WP_ = frame_;
  X_WP_.translation() += at_zero_.columns_W * (shifted - linear_of(gauge_zero_));
}

Pose WorkSpace::X_WP() const {
  return X_WP_;
}

void WorkSpace::compute(const MachineModel& machine, const std::array<double, 3>& rotary,
                        LinearMap& map) const {
  const AxisValues q = axis_values(Vec3::Zero(), rotary);
  const kinematics::Sines of = kinematics::sines_of(machine, q);
  // One walk: a linear axis moves the tip along its direction, which the rotary axes behind it turn.
  Vec3 tip = machine.tip_M, tool_axis = machine.tool_axis_M;
  Mat3 columns = Mat3::Zero();
  for (const kinematics::LinkStep& step : chain_) {
    if (!step.rotary) {
      const auto word = std::find(axis_.begin(), axis_.begin() + 3, step.axis) - axis_.begin();
      columns.col(word) = step.sense * step.direction;
      continue;
    }
    carry(step, q, of, tip, tool_axis);
    const double sine = step.sense * of.sine[step.axis], cosine = of.cosine[step.axis];
    for (int i = 0; i < 3; ++i)
      columns.col(i) = rotate(step.along, step.direction, sine, cosine, Vec3(columns.col(i)));
  }
  const Mat3 to_work = machine.X_MW.linear().transpose();
  map.base_W = to_work * (tip - machine.X_MW.translation());
  map.axis_W = to_work * tool_axis;
  map.columns_W = to_work * columns;
  map.inverse = map.columns_W.inverse();
  map.rotary = rotary;
  map.valid = true;
}

const LinearMap& WorkSpace::compensated(const std::array<double, 3>& rotary) {
  if (!compensated_.valid || compensated_.rotary != rotary) compute(machine_, rotary, compensated_);
  return compensated_;
}

const LinearMap& WorkSpace::real(const std::array<double, 3>& rotary) {
  if (machine_.tip_M == real_machine_.tip_M) return compensated(rotary);
  if (!real_.valid || real_.rotary != rotary) compute(real_machine_, rotary, real_);
  return real_;
}

Vec3 WorkSpace::linear_from_program(const Vec3& p, const std::array<double, 3>& rotary) {
  if (coordinates_ == Coordinates::kAxes) return axes_base_ + axes_rotation_ * p;
  const LinearMap& map = compensated(rotary);
  return map.inverse * (X_WP_ * p - map.base_W);
}

Vec3 WorkSpace::program_from_linear(const Vec3& linear, const std::array<double, 3>& rotary) {
  if (coordinates_ == Coordinates::kAxes) return axes_rotation_.transpose() * (linear - axes_base_);
  const LinearMap& map = compensated(rotary);
  const Vec3 tip_W = map.base_W + map.columns_W * linear;
  return X_WP_.linear().transpose() * (tip_W - X_WP_.translation());
}

}  // namespace swarf::program::nc
