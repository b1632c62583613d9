#include "measure/sweep_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "stock/sweep/sweep_map.h"

namespace swarf::measure {
namespace {

constexpr size_t kBoxesPerTask = 4096, kGroupsPerTask = 256;

Box nothing() {
  const double far = std::numeric_limits<double>::infinity();
  return {Vec3::Constant(far), Vec3::Constant(-far)};
}

Box joined(const Box& a, const Box& b) {
  return {a.lower.cwiseMin(b.lower), a.upper.cwiseMax(b.upper)};
}

bool meet(const Box& a, const Box& b) {
  return (a.lower.array() <= b.upper.array()).all() && (b.lower.array() <= a.upper.array()).all();
}

/// Around the standing cutter: a cylinder from its lowest to its highest point.
Box pose_box(const ToolPose& pose, double radius, double low, double high) {
  const Vec3 a = pose.tip_W + low * pose.axis_W, b = pose.tip_W + high * pose.axis_W;
  const Vec3 disc = radius * (Vec3::Ones() - pose.axis_W.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
  return {a.cwiseMin(b) - disc, a.cwiseMax(b) + disc};
}

}  // namespace

double lowest_z(const stock::CutterSolid& cutter) {
  double low = std::numeric_limits<double>::infinity();
  for (const cutter::ConvexPiece& piece : cutter.pieces) low = std::min(low, piece.low);
  return low;
}

Box sweep_box(const stock::Sweep& sweep, const stock::CutterSolid& cutter) {
  const double low = lowest_z(cutter);
  double high = low;
  for (const cutter::ConvexPiece& piece : cutter.pieces) high = std::max(high, piece.high);
  const double lever = std::hypot(cutter.radius, std::max(std::abs(low), std::abs(high)));
  const Box box =
      joined(pose_box(sweep.start, cutter.radius, low, high), pose_box(sweep.end, cutter.radius, low, high));
  // Between its ends a turning cutter bulges: the points of the rigid motion by theta^2 lever / 8, and the
  // sweep's own definition strays from the rigid motion by motion_bound.
  const Vec3 turn = sweep.end.axis_W - sweep.start.axis_W;
  constexpr double kRounding = 1e-6;  // mm
  const double bulge =
      0.25 * turn.squaredNorm() * lever + 2.0 * stock::motion_bound(sweep, lever) + kRounding;
  return {box.lower - Vec3::Constant(bulge), box.upper + Vec3::Constant(bulge)};
}

SweepIndex::SweepIndex(std::span<const stock::Sweep> sweeps, const SweepCutters& cutters)
    : sweeps_(sweeps), boxes_(sweeps.size()) {
  parallel_chunks(sweeps.size(), kBoxesPerTask, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n) boxes_[n] = sweep_box(sweeps[n], cutters[sweeps[n].block]);
  });
  size_t leaves = 1;
  while (leaves * kLeafSweeps < sweeps.size()) leaves *= 2;
  nodes_.assign(2 * leaves - 1, nothing());
  build(0, 0, leaves * kLeafSweeps);
  long_groups_ = planes_of_groups(cutters, kLongGroup);
  short_groups_ = planes_of_groups(cutters, kShortGroup);
}

std::vector<SweepIndex::Planes> SweepIndex::planes_of_groups(const SweepCutters& cutters,
                                                             size_t length) const {
  std::vector<Planes> groups((sweeps_.size() + length - 1) / length);
  parallel_chunks(groups.size(), kGroupsPerTask, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n)
      groups[n] = planes_of(cutters, n * length, std::min((n + 1) * length, sweeps_.size()));
  });
  return groups;
}

SweepIndex::Planes SweepIndex::planes_of(const SweepCutters& cutters, size_t begin, size_t end) const {
  const ToolPose& middle = sweeps_[begin + (end - begin) / 2].start;
  Planes planes{middle.axis_W, middle.tip_W};
  double rise = 0.0, low = std::numeric_limits<double>::infinity();
  for (size_t n = begin; n < end; ++n) {
    low = std::min(low, lowest_z(cutters[sweeps_[n].block]));
    for (const ToolPose* pose : {&sweeps_[n].start, &sweeps_[n].end}) {
      planes.axis_spread = std::max(planes.axis_spread, (pose->axis_W - middle.axis_W).norm());
      planes.tip_spread = std::max(planes.tip_spread, (pose->tip_W - middle.tip_W).norm());
      rise = std::max(rise, middle.axis_W.dot(middle.tip_W - pose->tip_W));
    }
  }
  planes.low = low - rise;
  return planes;
}

/// axis' . (x - tip') <= axis . (x - tip) + |axis' - axis| |x - tip'| + axis . (tip - tip'), and no more than
/// |x' - x| is added at another top.
bool SweepIndex::Planes::keep_above(const Columns& columns) const {
  constexpr double kRounding = 1e-9;  // mm
  const Vec3 offset = columns.top - tip;
  return axis.dot(columns.normal) - columns.normal_spread >= axis_spread &&
         axis.dot(offset) + columns.top_spread + axis_spread * (offset.norm() + tip_spread) + kRounding < low;
}

void SweepIndex::build(size_t node, size_t begin, size_t end) {
  if (end - begin <= kLeafSweeps) {
    for (size_t n = begin; n < std::min(end, boxes_.size()); ++n)
      nodes_[node] = joined(nodes_[node], boxes_[n]);
    return;
  }
  const size_t middle = begin + (end - begin) / 2;
  build(2 * node + 1, begin, middle);
  build(2 * node + 2, middle, end);
  nodes_[node] = joined(nodes_[2 * node + 1], nodes_[2 * node + 2]);
}

template <typename Skips>
void SweepIndex::visit(const Box& box, const Skips& skips, std::vector<uint32_t>& found) const {
  struct Open {
    size_t node, begin, end;
  };
  std::array<Open, 128> open;
  size_t count = 0;
  const size_t leaves = (nodes_.size() + 1) / 2;
  open[count++] = {0, 0, leaves * kLeafSweeps};
  while (count > 0) {
    const Open at = open[--count];
    if (!meet(nodes_[at.node], box) || skips(at.begin, at.end)) continue;
    if (at.end - at.begin <= kLeafSweeps) {
      for (size_t n = at.begin; n < std::min(at.end, boxes_.size()); ++n) {
        if (meet(boxes_[n], box)) found.push_back(static_cast<uint32_t>(n));
      }
      continue;
    }
    const size_t middle = at.begin + (at.end - at.begin) / 2;
    open[count++] = {2 * at.node + 2, middle, at.end};
    open[count++] = {2 * at.node + 1, at.begin, middle};
  }
}

void SweepIndex::find(const Box& box, std::vector<uint32_t>& found) const {
  visit(
      box, [](size_t, size_t) { return false; }, found);
}

void SweepIndex::find_below(const Columns& columns, const Box& box, std::vector<uint32_t>& found) const {
  const auto skips = [&](size_t begin, size_t end) {
    if (end - begin == kLongGroup) return long_groups_[begin / kLongGroup].keep_above(columns);
    if (end - begin == kShortGroup) return short_groups_[begin / kShortGroup].keep_above(columns);
    return false;
  };
  visit(box, skips, found);
}

bool passes_aside(const stock::Sweep& sweep, const stock::CutterSolid& cutter, const Vec3& centre,
                  double radius_mm) {
  const Vec3 offset = centre - sweep.start.tip_W;
  const double z = sweep.start.axis_W.dot(offset);
  const double rho = std::sqrt(std::max(0.0, offset.squaredNorm() - z * z));
  const double travel = (sweep.end.tip_W - sweep.start.tip_W).norm() +
                        (sweep.end.axis_W - sweep.start.axis_W).norm() * offset.norm();
  return std::max(rho - cutter.radius, z - cutter.height) > radius_mm + travel + 1e-6;
}

}  // namespace swarf::measure
