#include "sim/run/cut_along.h"

#include <algorithm>

#include "base/tool_axis.h"
#include "stock/sweep/sweep_map.h"

namespace swarf::sim {
namespace {

/// By which a part is held back at least, voxels: kernels round by less than a quarter of it unless a voxel
/// is less than a ten-thousandth of the tool (Stock::rounding_mm), and more is added there.
constexpr double kHeldBackVoxels = 0.01;
/// The tool is on a sweep that it is nearer to than this, voxels: rounded corners leave the path.
constexpr double kOnSweepVoxels = 1.0;

}  // namespace

std::optional<double> share_on(const stock::Sweep& sweep, const ToolPose& pose, double lever_mm,
                               double near_mm) {
  const Vec3 way = sweep.end.tip_W - sweep.start.tip_W, turn = sweep.end.axis_W - sweep.start.axis_W;
  const double length2 = way.squaredNorm() + lever_mm * lever_mm * turn.squaredNorm();
  if (length2 == 0.0) return std::nullopt;
  const double along = (pose.tip_W - sweep.start.tip_W).dot(way) +
                       lever_mm * lever_mm * (pose.axis_W - sweep.start.axis_W).dot(turn);
  const double share = std::clamp(along / length2, 0.0, 1.0);
  const ToolPose there = pose_between(sweep.start, sweep.end, share);
  const double away =
      std::max((pose.tip_W - there.tip_W).norm(), lever_mm * (pose.axis_W - there.axis_W).norm());
  if (away > near_mm) return std::nullopt;
  return share;
}

std::optional<stock::CutterSolid> held_back(const stock::CutterSolid& cutter, double by_mm) {
  stock::CutterSolid smaller = cutter;
  smaller.radius -= by_mm;
  for (cutter::ConvexPiece& piece : smaller.pieces) {
    // Each bound is one term of the greatest that the piece's distance is: it grows by as much everywhere.
    for (cutter::Face& face : piece.faces) face.offset -= by_mm;
    for (cutter::Round& round : piece.rounds) {
      if (round.radius < 2.0 * by_mm) return std::nullopt;
      round.radius -= by_mm;
    }
    piece.radius -= by_mm;
    piece.low += by_mm;
    piece.high -= by_mm;
    if (piece.radius < by_mm || piece.high - piece.low < by_mm) return std::nullopt;
  }
  return smaller;
}

CutAlong::CutAlong(const Job& job, const CarriedCuts& carried, const motion::Cycles& cycles, double voxel_mm)
    : stock_(starting_stock(job, carried, voxel_mm)),
      all_(stock_sweeps(job, cycles)),
      solids_(tool_solids(job.scene)) {
  for (const cutter::Cutter& tool : job.scene.tools) levers_mm_.push_back(lever_of(tool));
}

void CutAlong::advance(const motion::Cycle& cycle, const std::function<void(size_t tool)>& before) {
  advance_whole(cycle, before);
  if (done_ < all_.sweeps.size()) cut_part(cycle, before);
}

void CutAlong::advance_whole(const motion::Cycle& cycle, const std::function<void(size_t tool)>& before) {
  size_t end = done_;
  while (end < all_.sweeps.size() && is_done(all_.sources[all_.sweeps[end].block], cycle)) ++end;
  for_each_tool(
      std::span(all_.sweeps).subspan(done_, end - done_),
      [&](uint32_t block) { return all_.sources[block].tool; },
      [&](size_t tool, std::span<const stock::Sweep> part) {
        if (before) before(tool);
        stock_.cut(part, solids_[tool]);
      });
  if (end > done_) share_ = 0.0;
  done_ = end;
}

/// From where the last call has come on the sweep that is under way up to where the tool is.
void CutAlong::cut_part(const motion::Cycle& cycle, const std::function<void(size_t tool)>& before) {
  const stock::Sweep& sweep = all_.sweeps[done_];
  const auto tool = static_cast<size_t>(all_.sources[sweep.block].tool);
  if (static_cast<size_t>(cycle.sample.tool) != tool) return;
  const double voxel = stock_.voxel_mm(), lever = levers_mm_[tool];
  const std::optional<double> share = share_on(sweep, cycle.sample.pose, lever, kOnSweepVoxels * voxel);
  if (!share || *share <= share_) return;
  const double beside = 2.0 * (stock_.rounding_mm() + stock::motion_bound(sweep, lever));
  const double back = kHeldBackVoxels * voxel + beside;
  if (back > kProudVoxels * voxel) return;
  const auto smaller = held_back(solids_[tool], back);
  if (!smaller) return;
  const stock::Sweep part{pose_between(sweep.start, sweep.end, share_),
                          pose_between(sweep.start, sweep.end, *share), sweep.block};
  if (before) before(tool);
  stock_.cut(std::span(&part, 1), *smaller);
  share_ = *share;
}

}  // namespace swarf::sim
