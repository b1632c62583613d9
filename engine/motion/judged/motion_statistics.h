// Measuring the cycles of a program against path and machine as they come, without asking the planner.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "motion/cycles/cycles.h"
#include "motion/result.h"
#include "motion/tool_sample.h"

namespace swarf::motion {

/// The worst excess of one kind on one axis.
struct AxisExcess {
  double excess = 0.0, value = 0.0, limit = 0.0, t_s = 0.0;
  void see(double e, double v, double l, double t) {
    if (e > excess) *this = {e, v, l, t};
  }
};

/// Whether it is travelled as fast as the axes can.
bool is_rapid_element(const toolpath::Element& element);

/// Fills statistics and findings of a result: "unreachable" by element, then travel limits and axis speeds
/// that are exceeded, the worst cycle for each element and axis. A cycle that passes from one block into the
/// next counts for the axes, not for the errors along a block.
class MotionMeter {
 public:
  /// Both must outlive it.
  MotionMeter(const Cycles& cycles, MotionResult& result);
  ~MotionMeter();
  MotionMeter(const MotionMeter&) = delete;
  MotionMeter& operator=(const MotionMeter&) = delete;
  /// The next cycles.
  void add(std::span<const Cycle> window);
  void finish();

 private:
  class TickMeter;
  class AxisMeter;
  struct AxisFault {
    AxisExcess travel, speed;
  };
  /// Costs of the first cycles are ranked; of more, no one learns more.
  static constexpr size_t kCostsMost = size_t{1} << 22U;

  const toolpath::Element& element_of(const Cycle& now);
  void see_time(const Cycle& now);
  void see_reach(const Cycle& now);
  void see_excess(const Cycle& now);
  void end_element();
  void rank_costs();

  const Cycles& cycles_;
  const kinematics::MachineModel& machine_;
  MotionResult& out_;
  std::unique_ptr<TickMeter> ticks_;
  std::vector<AxisMeter> axes_;
  std::optional<Cycle> last_;
  // Of the element under way:
  std::optional<toolpath::Element> element_;
  int element_number_ = 0;
  std::vector<AxisFault> excess_;  ///< by axis
  std::vector<double> feeds_;      ///< in contact
  size_t outside_reach_ = 0;
  ToolSample first_outside_;
  std::vector<MotionFinding> faults_;
  double feed_min_ = -1.0;
  std::vector<float> costs_ns_;
};

/// Excess over an axis' speed limit that counts as rounding of the sampled positions, relative.
inline constexpr double kAxisSpeedTolerance = 1e-6;

}  // namespace swarf::motion
