#include "sim/driven_sweeps.h"

#include <algorithm>
#include <cmath>
namespace swarf::sim {
namespace {

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
  CycleSweeper(const Job& job, const toolpath::ToolPath& path, const motion::Trajectory& trajectory,
               double tolerance_mm, bool join)
      : path_(path),
        trajectory_(trajectory),
        machines_(machines_by_tool(job)),
        divide_mm_(join ? kDivideShare * tolerance_mm : tolerance_mm),
        join_mm_(join ? kJoinShare * tolerance_mm : 0.0) {
    for (const cutter::Cutter& tool : job.scene.tools) levers_mm_.push_back(lever_of(tool));
  }

  JobSweeps sweeps() {
    const std::vector<ToolSample>& samples = trajectory_.samples;
    for (size_t i = 1; i < samples.size(); ++i) {
      const bool changed = samples[i].tool != samples[i - 1].tool;
      if (changed || !same_kind(samples[i], samples[i - 1])) close_row();
      if (!changed) add_cycle(i);
    }
    close_row();
    return std::move(out_);
  }

 private:
  bool same_kind(const ToolSample& a, const ToolSample& b) const {
    if (a.element == b.element) return true;
    const auto* first = block_of(a);
    const auto* second = block_of(b);
    return first != nullptr && second != nullptr && is_rapid(*first) == is_rapid(*second) &&
           first->spindle_rpm == second->spindle_rpm;
  }
  const BlockMove* block_of(const ToolSample& sample) const {
    return std::get_if<BlockMove>(&path_.elements[static_cast<size_t>(sample.element)].what);
  }

  void add_cycle(size_t i) {
    const ToolPose& from = trajectory_.samples[i - 1].pose;
    const ToolPose& to = trajectory_.samples[i].pose;
    if (from.tip_W == to.tip_W && from.axis_W == to.axis_W) return;
    if (row_.empty()) push(from, i);
    divide(i);
    push(to, i);
  }
  /// Poses inside the cycle that ends with sample i, where the axes turn too much for one sweep.
  void divide(size_t i) {
    const auto tool = static_cast<size_t>(trajectory_.samples[i].tool);
    const kinematics::AxisValues& q_from = trajectory_.axes[i - 1];
    const kinematics::AxisValues change = trajectory_.axes[i] - q_from;
    const double error =
        stray(trajectory_.samples[i - 1].pose, kinematics::forward(machines_[tool], q_from + 0.5 * change),
              trajectory_.samples[i].pose, levers_mm_[tool]);
    const double pieces = std::max(1.0, std::ceil(std::sqrt(error / divide_mm_)));
    for (double k = 1.0; k < pieces; k += 1.0)
      push(kinematics::forward(machines_[tool], q_from + k / pieces * change), i);
    divided_mm_ = std::max(divided_mm_, error / (pieces * pieces));
  }
  void push(const ToolPose& pose, size_t sample) {
    row_.push_back(pose);
    sample_of_.push_back(static_cast<uint32_t>(sample));
  }

  void close_row() {
    if (row_.size() > 1) add_row();
    row_.clear();
    sample_of_.clear();
  }
  void add_row() {
    if (join_mm_ <= 0.0) {
      for (size_t k = 1; k < row_.size(); ++k) add(row_[k - 1], row_[k], sample_of_[k]);
    } else {
      const std::vector<uint8_t> breaks(row_.size(), 0);
      const auto tool = static_cast<size_t>(trajectory_.samples[sample_of_.back()].tool);
      const stock::MergedSweeps merged = stock::merge_sweeps(row_, breaks, levers_mm_[tool], join_mm_);
      for (const stock::Sweep& sweep : merged.sweeps) add(sweep.start, sweep.end, sample_of_[sweep.block]);
      joined_mm_ = std::max(joined_mm_, merged.error_bound_mm);
    }
    out_.error_bound_mm = joined_mm_ + divided_mm_;
  }
  void add(const ToolPose& start, const ToolPose& end, uint32_t sample) {
    out_.sweeps.push_back({start, end, static_cast<uint32_t>(out_.sources.size())});
    const ToolSample& at = trajectory_.samples[sample];
    out_.sources.push_back({at.element, sample, at.tool});
  }

  const toolpath::ToolPath& path_;
  const motion::Trajectory& trajectory_;
  std::vector<kinematics::MachineModel> machines_;  ///< by tool
  std::vector<double> levers_mm_;                   ///< by tool
  double divide_mm_;
  double join_mm_;  ///< 0: nothing is joined
  std::vector<ToolPose> row_;
  std::vector<uint32_t> sample_of_;  ///< by pose of the row: the cycle that ends at or behind it
  double joined_mm_ = 0.0, divided_mm_ = 0.0;
  JobSweeps out_;
};

}  // namespace

JobSweeps driven_sweeps(const Job& job, const toolpath::ToolPath& path, const motion::Trajectory& trajectory,
                        double tolerance_mm, bool join) {
  return CycleSweeper(job, path, trajectory, tolerance_mm, join).sweeps();
}

}  // namespace swarf::sim
