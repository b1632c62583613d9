// What each tool does in a program, operation by operation.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "motion/cycles/cycles.h"
#include "sim/job/scene.h"

namespace swarf::sim {

/// The program from one tool change to the next.
struct Operation {
  int tool = 0;                                       ///< index into Scene::tools
  int first_line = 0;                                 ///< of the program; 0: it has none
  double feed_s = 0.0, rapid_s = 0.0, dwell_s = 0.0;  ///< the cycle of the change counts as rapid
  double feed_mm = 0.0;                               ///< way of the tip in feed moves
  /// In the feed moves' cycles: from the tip up to the face of the raw stock's box, along the axis and within
  /// the tool's radius, at most; 0: the tip stays out of it.
  double deepest_mm = 0.0;
  /// Tip to holder's face with which the holder stays out of the raw stock's box over the whole motion:
  /// enough, and more than is needed where earlier cuts have made room. 0: any length is.
  double stick_out_mm = 0.0;

  double total_s() const { return feed_s + rapid_s + dwell_s; }
};

class OperationMeter {
 public:
  /// Both must outlive it.
  OperationMeter(const Job& job, const motion::Cycles& cycles);
  /// Cycles that follow each other.
  void add(std::span<const motion::Cycle> window);
  const std::vector<Operation>& operations() const { return operations_; }

 private:
  void see_time(const motion::Cycle& now);
  void see_depth(const motion::Cycle& now);
  void see_holder(const motion::Cycle& now, double way_mm);

  const Job& job_;
  const motion::Cycles& cycles_;
  Box raw_W_;
  std::optional<motion::Cycle> last_;
  int element_ = -1;  ///< that the next three are of
  bool rapid_ = false, dwells_ = false;
  int line_ = 0;
  std::vector<Operation> operations_;
};

}  // namespace swarf::sim
