#include "motion/interpolator.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "motion/blocks/block_turns.h"
#include "motion/judged/motion_statistics.h"

namespace swarf::motion {
namespace {

/// Warnings of whole blocks; each learns its time when its block is reached.
class TurnWarnings {
 public:
  explicit TurnWarnings(const Cycles& cycles)
      : warnings_(find_fast_turns(cycles.elements(), cycles.motions(), cycles.options())) {
    for (MotionFinding& warning : warnings_) in_order_.push_back(&warning);
    std::sort(in_order_.begin(), in_order_.end(),
              [](const MotionFinding* a, const MotionFinding* b) { return a->element < b->element; });
  }
  void see(const ToolSample& sample) {
    for (; reached_ < in_order_.size() && sample.element >= in_order_[reached_]->element; ++reached_)
      in_order_[reached_]->t_s = sample.t_s;
  }
  /// Blocks that are shorter than the last cycle lie at its end.
  std::vector<MotionFinding> take(double end_s) {
    for (; reached_ < in_order_.size(); ++reached_) in_order_[reached_]->t_s = end_s;
    return std::move(warnings_);
  }

 private:
  std::vector<MotionFinding> warnings_;
  std::vector<MotionFinding*> in_order_;
  size_t reached_ = 0;
};

}  // namespace

MotionResult interpolate(Cycles& cycles, Progress& progress, const CycleVisitor& visit) {
  MotionResult result;
  MotionMeter meter(cycles, result);
  TurnWarnings warnings(cycles);
  cycles.walk(
      [&](std::span<const Cycle> window) {
        meter.add(window);
        for (const Cycle& cycle : window) warnings.see(cycle.sample);
        if (visit) visit(window);
      },
      progress);
  meter.finish();
  for (MotionFinding& warning : warnings.take(cycles.time_s())) result.findings.push_back(std::move(warning));
  std::stable_sort(result.findings.begin(), result.findings.end(),
                   [](const MotionFinding& a, const MotionFinding& b) { return a.element < b.element; });
  return result;
}

Trajectory trajectory_of(const Cycles& cycles) {
  Trajectory all;
  all.period_s = cycles.period_s();
  all.samples.reserve(cycles.size());
  all.axes.reserve(cycles.size());
  CycleReader reader(cycles);
  for (size_t k = 0; k < cycles.size(); ++k) {
    const Cycle& cycle = reader.at(k);
    all.samples.push_back(cycle.sample);
    all.axes.push_back(cycle.q);
  }
  return all;
}

}  // namespace swarf::motion
