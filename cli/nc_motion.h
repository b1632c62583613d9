// How long an NC program takes on its machine and how far its axes go: by the look-ahead and the cycles of
// `swarf run`, so to the same cycle.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "motion/result.h"
#include "program/nc_program.h"
#include "toolpath/nc_path.h"

namespace swarf::cli {

/// Hands every move on and keeps it for the motion, as long as there are no more than kMovesMost: each takes
/// about 60 bytes, five axes 100; look-ahead and cycles take what they take for a short program.
class NcMotionSink final : public program::NcSink {
 public:
  /// References must outlive it.
  NcMotionSink(const program::ControlSetup& setup, program::NcSink& next) : setup_(setup), next_(next) {}
  bool move(const program::NcMove& move) override;
  void note(const program::NcNote& note) override { next_.note(note); }

  static constexpr long kMovesMost = 20'000'000;
  /// They are not kept then, and not driven.
  bool too_many() const { return moves_ > kMovesMost; }
  /// Drives the machine along the program with the interpolator's defaults (scenes/README.md:
  /// [interpolator]). None when nothing moves with a tool in the spindle, or Ctrl-C was pressed. Throws
  /// InputError as a run does.
  std::optional<motion::MotionStatistics> drive(const program::NcSummary& summary);

 private:
  const program::ControlSetup& setup_;
  program::NcSink& next_;
  toolpath::NcPathSink path_;
  long moves_ = 0;
};

/// For people: one line for the time, one for what it rests on, one for each axis. Lines begin with a line
/// break.
std::string motion_text(const motion::MotionStatistics& motion, const kinematics::MachineModel& machine);

/// time_s, feed_time_s, rapid_time_s, dwell_time_s, the interpolator's settings, and by axis min, max,
/// travel, speed_max with their units.
nlohmann::ordered_json motion_json(const motion::MotionStatistics& motion,
                                   const kinematics::MachineModel& machine);

}  // namespace swarf::cli
