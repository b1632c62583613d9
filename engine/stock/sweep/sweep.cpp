#include "stock/sweep/sweep.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "cutter/cutting_pieces.h"
#include "stock/sweep/sweep_map.h"

namespace swarf::stock {
namespace {

/// How far the cutter at `pose` lies from the sweep at its best matching instant: the tip's distance plus the
/// axis's deviation at the end of the lever. Both are linear in t, so the instant is a quadratic's minimum.
double deviation(const SweepMap& map, const ToolPose& pose, double lever_mm) {
  const Vec3 tip_start = map.start(pose.tip_W);
  const Vec3 tip_change = map.end(pose.tip_W) - tip_start;
  const Vec3 axis_start = map.R0t * pose.axis_W - Vec3::UnitZ();
  const Vec3 axis_change = map.R1t * pose.axis_W - map.R0t * pose.axis_W;
  const double lever2 = lever_mm * lever_mm;
  const double slope = tip_start.dot(tip_change) + lever2 * axis_start.dot(axis_change);
  const double bend = tip_change.squaredNorm() + lever2 * axis_change.squaredNorm();
  const double t = bend > 0.0 ? std::clamp(-slope / bend, 0.0, 1.0) : 0.0;
  return (tip_start + t * tip_change).norm() + lever_mm * (axis_start + t * axis_change).norm();
}

/// Merges one chain: of its poses, those from the start of the sweep under way on are held.
class ChainMerger {
 public:
  ChainMerger(size_t count, const std::function<ToolPose(size_t)>& pose, double lever_mm, double tolerance_mm)
      : count_(count), pose_(pose), lever_mm_(lever_mm), tolerance_mm_(tolerance_mm) {}

  MergeBound merge(const SweepVisitor& visit) {
    for (size_t first = 0; first + 1 < count_;) {
      const size_t last = reach(first);
      bound_.chain_mm = std::max(bound_.chain_mm, chain_deviation(first, last));
      visit(first, last);
      first = last;
      forget(first);
    }
    return bound_;
  }

 private:
  const ToolPose& at(size_t k) const { return held_[k - offset_]; }
  void read_up_to(size_t k) {
    while (offset_ + held_.size() <= k) {
      held_.push_back(pose_(offset_ + held_.size()));
      if (held_.size() > 1) {
        const Sweep tick{held_[held_.size() - 2], held_.back(), 0};
        bound_.tick_mm = std::max(bound_.tick_mm, motion_bound(tick, lever_mm_));
      }
    }
  }
  /// Poses before this one; they are moved out of the way now and then.
  void forget(size_t first) {
    constexpr size_t kForgotten = 1024;
    if (first - offset_ < kForgotten) return;
    held_.erase(held_.begin(), held_.begin() + static_cast<ptrdiff_t>(first - offset_));
    offset_ = first;
  }

  /// Greatest deviation of the poses between `first` and `last`; stops at the first above the tolerance.
  double chain_deviation(size_t first, size_t last) {
    read_up_to(last);
    const SweepMap map = sweep_map({at(first), at(last), 0});
    double worst = 0.0;
    for (size_t k = first + 1; k < last && worst <= tolerance_mm_; ++k)
      worst = std::max(worst, deviation(map, at(k), lever_mm_));
    return worst;
  }

  /// The farthest pose that one sweep from `first` reaches within the tolerance: doubled until it fails, then
  /// bisected. Every accepted end has been checked against all the poses it skips.
  size_t reach(size_t first) {
    const auto fits = [&](size_t last) { return chain_deviation(first, last) <= tolerance_mm_; };
    const size_t limit = count_ - 1;
    size_t good = first + 1;
    size_t step = 1;
    read_up_to(good);
    while (good < limit && fits(std::min(good + step, limit))) {
      good = std::min(good + step, limit);
      step *= 2;
    }
    size_t bad = std::min(good + step, limit + 1);
    while (bad - good > 1) {
      const size_t middle = good + (bad - good) / 2;
      (fits(middle) ? good : bad) = middle;
    }
    return good;
  }

  size_t count_;
  const std::function<ToolPose(size_t)>& pose_;
  double lever_mm_, tolerance_mm_;
  std::vector<ToolPose> held_;
  size_t offset_ = 0;  ///< number of held_.front()
  MergeBound bound_;
};

}  // namespace

CutterSolid::CutterSolid(double flat_radius, double flute_height)
    : radius(flat_radius),
      height(flute_height),
      pieces{cutter::ConvexPiece::cylinder(flat_radius, flute_height)} {}

CutterSolid::CutterSolid(const cutter::Cutter& cutter)
    : radius(0.0), height(cutter.flute_length_mm), pieces(cutter::cutting_pieces(cutter)) {
  for (const cutter::ConvexPiece& piece : pieces) radius = std::max(radius, piece.radius);
}

MergeBound merge_chain(size_t count, const std::function<ToolPose(size_t)>& pose, double lever_mm,
                       double tolerance_mm, const SweepVisitor& visit) {
  return ChainMerger(count, pose, lever_mm, tolerance_mm).merge(visit);
}

MergedSweeps merge_sweeps(std::span<const ToolPose> poses, std::span<const uint8_t> breaks, double lever_mm,
                          double tolerance_mm) {
  SWARF_CHECK(breaks.size() == poses.size(), "one break flag per pose");
  MergedSweeps merged;
  MergeBound worst;
  for (size_t first = 0, end = 1; first + 1 < poses.size(); first = end++) {
    while (end < poses.size() && !breaks[end]) ++end;
    const MergeBound bound = merge_chain(
        end - first, [&](size_t k) { return poses[first + k]; }, lever_mm, tolerance_mm,
        [&](size_t from, size_t to) {
          const auto last = static_cast<uint32_t>(first + to);
          merged.sweeps.push_back({poses[first + from], poses[last], last});
        });
    worst = {std::max(worst.chain_mm, bound.chain_mm), std::max(worst.tick_mm, bound.tick_mm)};
  }
  merged.error_bound_mm = worst.chain_mm + worst.tick_mm;
  return merged;
}

}  // namespace swarf::stock
