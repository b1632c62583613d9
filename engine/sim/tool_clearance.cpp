#include "sim/tool_clearance.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/units.h"
#include "cutter/profile.h"
#include "cutter/tool_walls.h"

namespace swarf::sim {
namespace {

constexpr double kPointSpacing = 2.0;  // mm; the stock's features are a cutter diameter wide
constexpr double kBandVoxels = 3.0;    // half width of the level set

double flute_end_radius(const cutter::Cutter& cutter) {
  return cutter::outline(cutter).back().to.x();
}

}  // namespace

ToolClearanceCheck::ToolClearanceCheck(std::span<const cutter::Cutter> tools, double voxel_mm)
    : tolerance_mm_(voxel_mm) {
  for (const cutter::Cutter& tool : tools) points_.push_back(points_of(tool));
  result_.band_mm = kBandVoxels * voxel_mm;
  result_.nearest_mm = result_.band_mm;
}

ToolClearanceCheck::Points ToolClearanceCheck::points_of(const cutter::Cutter& cutter) {
  Points points;
  const auto ring = [&](double radius, double height, const char* part) {
    const int count = std::max(6, static_cast<int>(std::ceil(2.0 * kPi * radius / kPointSpacing)));
    for (int i = 0; i < count; ++i) {
      const double angle = 2.0 * kPi * i / count;
      points.push_back({radius, height, std::cos(angle), std::sin(angle), part});
    }
  };
  // Rings along a line of the outline, without its first end.
  const auto line = [&](const Vec2& from, const Vec2& to, const char* part) {
    const int steps = static_cast<int>(std::ceil((to - from).norm() / kPointSpacing));
    for (int i = 1; i <= steps; ++i) {
      const Vec2 p = from + (to - from) * i / steps;
      ring(p.x(), p.y(), part);
    }
  };
  const std::vector<cutter::ToolWall> walls = cutter::tool_walls(cutter);
  // The flutes' own upper end cuts.
  Vec2 last(std::min(flute_end_radius(cutter), walls.front().low_radius), cutter.flute_length_mm);
  for (const cutter::ToolWall& wall : walls) {
    const Vec2 low(wall.low_radius, wall.low), high(wall.high_radius, wall.high);
    line(last, low, wall.part);  // the shoulder between two parts belongs to the upper one
    if (last == low) ring(low.x(), low.y(), wall.part);
    line(low, high, wall.part);
    last = high;
  }
  return points;
}

double ToolClearanceCheck::depth_at(const stock::Stock& stock, const ToolPose& pose, const Points& points,
                                    const char** part) const {
  const Vec3 x = pose.axis_W.unitOrthogonal();
  const Vec3 y = pose.axis_W.cross(x);
  double nearest = result_.band_mm;
  for (const Point& p : points) {
    const Vec3 point = pose.tip_W + p.height * pose.axis_W + p.radius * (p.cosine * x + p.sine * y);
    const double distance = stock.distance_mm(point);
    if (distance < nearest) {
      nearest = distance;
      *part = p.part;
    }
  }
  return nearest;
}

void ToolClearanceCheck::check(const stock::Stock& stock, std::span<const stock::Sweep> sweeps, size_t tool) {
  std::vector<double> nearest(sweeps.size());
  std::vector<const char*> parts(sweeps.size(), "");
  parallel_chunks(sweeps.size(), 16, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i)
      nearest[i] = depth_at(stock, sweeps[i].end, points_[tool], &parts[i]);
  });
  for (size_t i = 0; i < sweeps.size(); ++i) {
    ++result_.checked_poses;
    result_.nearest_mm = std::min(result_.nearest_mm, nearest[i]);
    if (nearest[i] >= -tolerance_mm_) continue;
    if (result_.contacts++ == 0) {
      result_.part = parts[i];
      result_.first_block = sweeps[i].block;
    }
    result_.deepest_mm = std::max(result_.deepest_mm, -nearest[i]);
  }
}

}  // namespace swarf::sim
