#include "sim/tool_clearance.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/units.h"

namespace swarf::sim {
namespace {

constexpr double kPointSpacing = 2.0;  // mm; the stock's features are a cutter diameter wide
constexpr double kBandVoxels = 3.0;    // half width of the level set

}  // namespace

ToolClearanceCheck::ToolClearanceCheck(const cutter::Cutter& cutter, double voxel_mm)
    : tolerance_mm_(voxel_mm) {
  const auto ring = [&](double radius, double height, bool holder) {
    const int count = std::max(6, static_cast<int>(std::ceil(2.0 * kPi * radius / kPointSpacing)));
    for (int i = 0; i < count; ++i) {
      const double angle = 2.0 * kPi * i / count;
      points_.push_back({radius, height, std::cos(angle), std::sin(angle), holder});
    }
  };
  const auto wall = [&](double radius, double from, double to, bool holder) {
    const int steps = std::max(1, static_cast<int>(std::ceil((to - from) / kPointSpacing)));
    for (int i = 0; i <= steps; ++i) ring(radius, from + (to - from) * i / steps, holder);
  };
  if (cutter.length_mm > cutter.flute_length_mm) {
    wall(0.5 * cutter.shank_diameter_mm, cutter.flute_length_mm, cutter.length_mm, false);
  }
  const double holder_radius = 0.5 * cutter.holder_diameter_mm;
  for (double r = 0.5 * cutter.shank_diameter_mm; r < holder_radius; r += kPointSpacing) {
    ring(r, cutter.length_mm, true);
  }
  wall(holder_radius, cutter.length_mm, cutter.length_mm + cutter.holder_length_mm, true);
  result_.band_mm = kBandVoxels * voxel_mm;
  result_.nearest_mm = result_.band_mm;
}

double ToolClearanceCheck::depth_at(const stock::Stock& stock, const ToolPose& pose,
                                    const char** part) const {
  const Vec3 x = pose.axis_W.unitOrthogonal();
  const Vec3 y = pose.axis_W.cross(x);
  double nearest = result_.band_mm;
  for (const Point& p : points_) {
    const Vec3 point = pose.tip_W + p.height * pose.axis_W + p.radius * (p.cosine * x + p.sine * y);
    const double distance = stock.distance_mm(point);
    if (distance < nearest) {
      nearest = distance;
      *part = p.holder ? "holder" : "shank";
    }
  }
  return nearest;
}

void ToolClearanceCheck::check(const stock::Stock& stock, std::span<const stock::Sweep> sweeps) {
  std::vector<double> nearest(sweeps.size());
  std::vector<const char*> parts(sweeps.size(), "");
  parallel_chunks(sweeps.size(), 16, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) nearest[i] = depth_at(stock, sweeps[i].end, &parts[i]);
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
