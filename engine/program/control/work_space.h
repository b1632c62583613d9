// Where program coordinates lie on the machine: axis values <-> tip in W <-> program coordinates (control.h).
#pragma once

#include <array>
#include <vector>

#include "kinematics/machine_model.h"
#include "program/control/target.h"

namespace swarf::program::nc {

/// With the rotary axes standing, the tip in W is affine in the three linear values.
struct LinearMap {
  Vec3 base_W = Vec3::Zero();         ///< tip with the linear axes at zero
  Mat3 columns_W = Mat3::Identity();  ///< of X, Y, Z
  Mat3 inverse = Mat3::Identity();
  Vec3 axis_W = Vec3::UnitZ();
  std::array<double, 3> rotary{};  ///< A B C of this map
  bool valid = false;
};

class WorkSpace {
 public:
  /// Throws InputError like Control's constructor.
  explicit WorkSpace(const kinematics::MachineModel& machine);

  int axis_of(int word) const { return axis_[static_cast<size_t>(word)]; }
  const kinematics::InverseKinematics& inverse() const { return inverse_; }

  // Compensated length, offsets, frame: each invalidates what was computed with it.
  void set_length(double length_mm);
  double length() const { return length_mm_; }
  void set_true_length(double length_mm);
  void set_origin(const kinematics::AxisValues& origin) { origin_ = origin, update(); }
  const kinematics::AxisValues& origin() const { return origin_; }
  void set_shift(const kinematics::AxisValues& shift) { shift_ = shift, update(); }
  const kinematics::AxisValues& shift() const { return shift_; }
  void set_frame(const Pose& frame) { frame_ = frame, update(); }
  const Pose& frame() const { return frame_; }
  void set_coordinates(Coordinates coordinates) { coordinates_ = coordinates, update(); }
  Coordinates coordinates() const { return coordinates_; }
  /// Axis values with the gauge line on W's origin, rotary axes at zero.
  const kinematics::AxisValues& gauge_zero() const { return gauge_zero_; }

  /// Linear axis values of program coordinates; `rotary`: machine values of A B C.
  Vec3 linear_from_program(const Vec3& p, const std::array<double, 3>& rotary);
  Vec3 program_from_linear(const Vec3& linear, const std::array<double, 3>& rotary);
  /// Machine value of a rotary word and back; `slot` 0 1 2: A B C.
  double rotary_zero(int slot) const;
  /// Tool axis in W with the rotary axes at zero.
  const Vec3& axis_at_zero_W() const { return at_zero_.axis_W; }
  /// W from program coordinates (kWork).
  Pose X_WP() const;

  /// Tip and axis in W: of a tool with the compensated length, and of the true tool.
  const LinearMap& compensated(const std::array<double, 3>& rotary);
  const LinearMap& real(const std::array<double, 3>& rotary);
  std::array<double, 3> rotary_of(const kinematics::AxisValues& q) const;
  Vec3 linear_of(const kinematics::AxisValues& q) const;
  kinematics::AxisValues axis_values(const Vec3& linear, const std::array<double, 3>& rotary) const;

 private:
  void update();
  void compute(const kinematics::MachineModel& machine, const std::array<double, 3>& rotary,
               LinearMap& map) const;

  kinematics::MachineModel machine_;       ///< with the compensated length
  kinematics::MachineModel real_machine_;  ///< with the true length
  kinematics::InverseKinematics inverse_;  ///< of the gauge-line tool: only its rotary values are used
  std::array<int, kAxisWords> axis_{};
  std::vector<kinematics::LinkStep> chain_;  ///< from the tool to the work; no tool changes it
  double length_mm_ = 0.0;
  kinematics::AxisValues gauge_zero_ = kinematics::AxisValues::Zero();
  kinematics::AxisValues origin_ = kinematics::AxisValues::Zero(), shift_ = kinematics::AxisValues::Zero();
  Pose frame_ = Pose::Identity();
  Coordinates coordinates_ = Coordinates::kAxes;
  LinearMap compensated_, real_, at_zero_;
  Vec3 axes_base_ = Vec3::Zero();  ///< kAxes: linear = axes_base_ + axes_rotation_ p
  Mat3 axes_rotation_ = Mat3::Identity();
  Pose X_WP_ = Pose::Identity();
};

}  // namespace swarf::program::nc
