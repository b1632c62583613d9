// What an NC program adds up to: path lengths, times, extents. Keeps no move.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "program/nc_program.h"

namespace swarf::cli {

/// How long a program takes as programmed, accelerations left out: what a run takes at the least.
class ProgramHours {
 public:
  void add(double seconds, const program::Move& move, int file = 0);
  /// Throws InputError "too-many-cycles" at the slowest block where a run refuses the program for its time.
  void refuse_too_long(const std::vector<std::string>& files) const;

 private:
  double seconds_ = 0.0, longest_s_ = 0.0;
  int file_ = 0, line_ = 0, column_ = 0;
};

class NcTotals final : public program::NcSink {
 public:
  explicit NcTotals(const kinematics::MachineModel& machine) : machine_(machine) {}
  /// False once Ctrl-C was pressed.
  bool move(const program::NcMove& move) override;

  long rapids = 0, feeds = 0, arcs = 0;
  double feed_mm = 0.0,
         rapid_mm = 0.0;               ///< way of the tip: arcs along the arc, the others between their ends
  double feed_s = 0.0, dwell_s = 0.0;  ///< at the programmed feed
  ProgramHours hours;                  ///< of both
  /// Every axis at its rapid speed, without acceleration; counts only while rapids_timed.
  double rapid_s = 0.0;
  bool rapids_timed = true;  ///< the machine says how fast its axes are
  /// Of all axis values.
  kinematics::AxisValues low = kinematics::AxisValues::Zero(), high = kinematics::AxisValues::Zero();
  Eigen::AlignedBox3d cut_W;  ///< of the tip in feed moves, arcs with their bulge; empty without one
  std::string out_of_travel;  ///< the first axis that leaves its travel, and the line; "": none
  int out_of_travel_line = 0;

 private:
  void add_rapid(const program::NcMove& move);
  void check_travel(const program::NcMove& move);

  const kinematics::MachineModel& machine_;
};

}  // namespace swarf::cli
