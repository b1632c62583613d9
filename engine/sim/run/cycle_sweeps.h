// The sweeps of a surface job's measuring rays, while its cycles are made or as they are read.
#pragma once

#include <cstdint>
#include <span>
#include <utility>

#include "sim/run/job_sweeps.h"

namespace swarf::sim {

/// ray_sweeps() of the job are those of CycleSweeps.
bool one_sweep_each_cycle(const Job& job);

/// As told at cycle_sweeps(), with their sources. A path that is only compared needs no second look at its
/// cycles, most of which would have to be made again.
class CycleSweeps {
 public:
  /// Borrows the machine.
  explicit CycleSweeps(const kinematics::MachineModel& machine) : machine_(machine) {}
  /// The next cycles, in their order.
  void add(std::span<const motion::Cycle> window);
  /// All, when the last cycle has been added.
  JobSweeps take() { return std::move(all_); }

 private:
  const kinematics::MachineModel& machine_;
  JobSweeps all_;
  ToolPose node_;  ///< where the last sweep begins
  kinematics::AxisValues q_ = kinematics::AxisValues::Zero();
};

}  // namespace swarf::sim
