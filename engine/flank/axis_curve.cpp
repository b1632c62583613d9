#include "flank/axis_curve.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "base/parallel.h"

namespace swarf::flank {
namespace {

constexpr int kFewest = 16, kMost = 4096;
constexpr int kWayNodes = 2048;

/// Rulings at equal steps of the tip's way.
struct WayTable {
  double length = 0.0;
  CubicSpline u_of_way;
};

WayTable way_table(const FlankTask& task, const AxisFamily& family) {
  const double step = (task.u_high - task.u_low) / kWayNodes;
  std::vector<double> way{0.0};
  ToolPose before = family.pose(task.u_low);
  for (int i = 1; i <= kWayNodes; ++i) {
    const ToolPose next = family.pose(task.u_low + i * step);
    way.push_back(way.back() + (next.tip_W - before.tip_W).norm());
    before = next;
  }
  WayTable table;
  table.length = way.back();
  // The inverse at equal ways, by the spline of the way.
  const CubicSpline way_of_u(task.u_low, step, way);
  std::vector<double> u;
  for (int k = 0; k <= kWayNodes; ++k) {
    const double target = table.length * k / kWayNodes;
    const auto next = std::upper_bound(way.begin(), way.end(), target);
    const auto i = static_cast<double>(std::clamp<std::ptrdiff_t>(next - way.begin(), 1, kWayNodes) - 1);
    double at = task.u_low + step * (i + 0.5);
    for (int n = 0; n < 20; ++n) {
      const CubicSpline::Value value = way_of_u.at(at);
      at -= (value.w - target) / value.dw;
    }
    u.push_back(at);
  }
  table.u_of_way = CubicSpline(0.0, table.length / kWayNodes, std::move(u));
  return table;
}

AxisCurve curve_of(const FlankTask& task, const WayTable& table, int intervals) {
  const double step = table.length / intervals;
  std::vector<ToolPose> poses(static_cast<size_t>(intervals) + 1);
  parallel_chunks(poses.size(), 4, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i)
      poses[i] = pose_at(task, table.u_of_way.at(step * static_cast<double>(i)).w);
  });
  return {std::make_shared<const toolpath::PoseCurve>(step, poses), table.u_of_way};
}

bool strays(const FlankTask& task, const AxisCurve& axis, double way, double most) {
  const double u = axis.u_of_way.at(way).w;
  const AxisError on_curve = axis_error(task, axis.curve->pose(way), u);
  const AxisError exact = axis_error(task, pose_at(task, u), u);
  return std::max(std::abs(on_curve.least_mm - exact.least_mm),
                  std::abs(on_curve.greatest_mm - exact.greatest_mm)) > most;
}

}  // namespace

AxisCurve axis_curve(const FlankTask& task, const AxisFamily& family, double stray_mm,
                     const SourceLocation& where) {
  const WayTable table = way_table(task, family);
  for (int intervals = kFewest; intervals <= kMost; intervals *= 2) {
    const AxisCurve axis = curve_of(task, table, intervals);
    std::atomic<bool> away{false};
    parallel_chunks(static_cast<size_t>(intervals), 2, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end && !away; ++i)
        for (const double share : {0.25, 0.5, 0.75})
          if (!away &&
              strays(task, axis, table.length / intervals * (static_cast<double>(i) + share), stray_mm))
            away = true;
    });
    if (!away) return axis;
  }
  throw InputError("too-many-blocks", where,
                   "the curve of a flank pass needs more than 4096 pieces within flank.chord_um",
                   "a larger flank.chord_um needs fewer");
}

}  // namespace swarf::flank
