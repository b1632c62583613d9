#include "sim/run/driven_sweeps.h"

#include <algorithm>
#include <cmath>
namespace swarf::sim {
namespace {

using motion::Cycle;
using motion::ToolSample;
using toolpath::BlockMove;

/// How far the tool leaves one sweep over a whole cycle, mm: half way by the poses, and by what a sweep
/// itself errs when it turns (sweep.h). Both fall with the square of the number of pieces.
double stray(const ToolPose& from, const ToolPose& middle, const ToolPose& to, double lever_mm) {
  const Vec3 tip = middle.tip_W - 0.5 * (from.tip_W + to.tip_W);
  const Vec3 axis = middle.axis_W - (from.axis_W + to.axis_W).normalized();
  const double turn = (to.axis_W - from.axis_W).norm();
  return tip.norm() + lever_mm * (axis.norm() + turn * turn / 8.0);
}

/// Shares of the tolerance; the rest is for what the pieces err by when they are joined (merge_sweeps).
constexpr double kDivideShare = 0.2, kJoinShare = 0.5;

/// Collects the poses that the tool passes in a row of cycles of one kind, then the sweeps between them.
class CycleSweeper {
 public:
  CycleSweeper(const Job& job, const motion::Cycles& cycles, double tolerance_mm, bool join)
      : cycles_(cycles),
        machines_(machines_by_tool(job)),
        divide_mm_(join ? kDivideShare * tolerance_mm : tolerance_mm),
        join_mm_(join ? kJoinShare * tolerance_mm : 0.0) {
    for (const cutter::Cutter& tool : job.scene.tools) levers_mm_.push_back(lever_of(tool));
  }

  JobSweeps sweeps() {
    motion::CycleReader reader(cycles_);
    Cycle before;
    for (size_t i = 0; i < cycles_.size(); ++i) {
      const Cycle& now = reader.at(i);
      if (i > 0) {
        const bool changed = now.sample.tool != before.sample.tool;
        if (changed || !same_kind(now.sample, before.sample)) close_row();
        if (!changed) add_cycle(i, before, now);
      }
      before = now;
    }
    close_row();
    return std::move(out_);
  }

 private:
  bool same_kind(const ToolSample& a, const ToolSample& b) const {
    if (a.element == b.element) return true;
    if (!cycles_.elements().hold_blocks()) return false;
    const BlockMove first = block_of(a), second = block_of(b);
    return is_rapid(first) == is_rapid(second) && first.spindle_rpm == second.spindle_rpm;
  }
  BlockMove block_of(const ToolSample& sample) const {
    return cycles_.elements().block(static_cast<size_t>(sample.element));
  }

  void add_cycle(size_t i, const Cycle& before, const Cycle& now) {
    const ToolPose& from = before.sample.pose;
    const ToolPose& to = now.sample.pose;
    if (from.tip_W == to.tip_W && from.axis_W == to.axis_W) return;
    SweepSource source{now.sample.element, now.sample.tool, now.sample.u, i};
    if (row_.empty()) push(from, source);
    divide(before, now, source);
    push(to, source);
  }
  /// Poses inside the cycle, where the axes turn too much for one sweep.
  void divide(const Cycle& before, const Cycle& now, const SweepSource& source) {
    const auto tool = static_cast<size_t>(now.sample.tool);
    const kinematics::AxisValues change = now.q - before.q;
    const double error =
        stray(before.sample.pose, kinematics::forward(machines_[tool], before.q + 0.5 * change),
              now.sample.pose, levers_mm_[tool]);
    const double pieces = std::max(1.0, std::ceil(std::sqrt(error / divide_mm_)));
    for (double k = 1.0; k < pieces; k += 1.0)
      push(kinematics::forward(machines_[tool], before.q + k / pieces * change), source);
    divided_mm_ = std::max(divided_mm_, error / (pieces * pieces));
  }
  void push(const ToolPose& pose, const SweepSource& source) {
    row_.push_back(pose);
    source_of_.push_back(source);
  }

  void close_row() {
    if (row_.size() > 1) add_row();
    row_.clear();
    source_of_.clear();
  }
  void add_row() {
    if (join_mm_ <= 0.0) {
      for (size_t k = 1; k < row_.size(); ++k) add(row_[k - 1], row_[k], source_of_[k]);
    } else {
      const std::vector<uint8_t> breaks(row_.size(), 0);
      const auto tool = static_cast<size_t>(source_of_.back().tool);
      const stock::MergedSweeps merged = stock::merge_sweeps(row_, breaks, levers_mm_[tool], join_mm_);
      for (const stock::Sweep& sweep : merged.sweeps) add(sweep.start, sweep.end, source_of_[sweep.block]);
      joined_mm_ = std::max(joined_mm_, merged.error_bound_mm);
    }
    out_.error_bound_mm = joined_mm_ + divided_mm_;
  }
  void add(const ToolPose& start, const ToolPose& end, const SweepSource& source) {
    out_.sweeps.push_back({start, end, static_cast<uint32_t>(out_.sources.size())});
    out_.sources.push_back(source);
  }

  const motion::Cycles& cycles_;
  std::vector<kinematics::MachineModel> machines_;  ///< by tool
  std::vector<double> levers_mm_;                   ///< by tool
  double divide_mm_;
  double join_mm_;  ///< 0: nothing is joined
  std::vector<ToolPose> row_;
  std::vector<SweepSource> source_of_;  ///< by pose of the row: the cycle that ends at or behind it
  double joined_mm_ = 0.0, divided_mm_ = 0.0;
  JobSweeps out_;
};

}  // namespace

JobSweeps driven_sweeps(const Job& job, const motion::Cycles& cycles, double tolerance_mm, bool join) {
  return CycleSweeper(job, cycles, tolerance_mm, join).sweeps();
}

}  // namespace swarf::sim
