#include "sim/bad_cuts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <variant>

#include "base/units.h"
#include "cutter/profile.h"

namespace swarf::sim {
namespace {

using toolpath::BlockMove;

constexpr double kPointSpacing = 2.0;   // mm
constexpr double kOutlineError = 0.02;  // mm, of the lines that rounded ends are walked along
constexpr double kStepOfRadius = 0.25;  // poses of a sweep are this share of the radius apart
constexpr double kBandVoxels = 3.0;     // half width of the level set

std::optional<BadCutKind> kind_of(const BlockMove& block, const cutter::Cutter& tool) {
  if (toolpath::is_rapid(block)) return BadCutKind::kRapid;
  if (!block.spindle_rpm) return std::nullopt;
  if (*block.spindle_rpm == 0.0) return BadCutKind::kSpindleStands;
  const bool counter_clockwise = *block.spindle_rpm < 0.0;
  return counter_clockwise == tool.left_hand ? std::nullopt : std::optional(BadCutKind::kSpindleReversed);
}

/// Rings on the flutes, the end's face included.
std::vector<Vec3> flute_points(const cutter::Cutter& tool) {
  std::vector<Vec3> points;
  const auto ring = [&](double radius, double height) {
    const int count = std::max(1, static_cast<int>(std::ceil(2.0 * kPi * radius / kPointSpacing)));
    for (int i = 0; i < count; ++i) {
      const double angle = 2.0 * kPi * i / count;
      points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
    }
  };
  const std::vector<Vec2> line = cutter::sample_outline(cutter::outline(tool), kOutlineError);
  ring(line.front().x(), line.front().y());
  double since = 0.0;
  for (size_t i = 1; i < line.size(); ++i) {
    const double length = (line[i] - line[i - 1]).norm();
    const int steps = std::max(1, static_cast<int>(std::ceil(length / kPointSpacing)));
    since += length;
    // Short chords of an arc share their rings.
    if (steps == 1 && since < kPointSpacing && i + 1 < line.size()) continue;
    since = 0.0;
    for (int k = 1; k <= steps; ++k) {
      const Vec2 p = line[i - 1] + (line[i] - line[i - 1]) * k / steps;
      ring(p.x(), p.y());
    }
  }
  return points;
}

}  // namespace

BadCutCheck::BadCutCheck(const Job& job, const toolpath::ToolPath& path, const JobSweeps& sweeps)
    : sweeps_(sweeps), voxel_mm_(job.scene.stock.voxel_mm) {
  for (const cutter::Cutter& tool : job.scene.tools) {
    points_.push_back(flute_points(tool));
    reach_mm_.push_back(std::hypot(cutter::greatest_radius(cutter::outline(tool)), tool.flute_length_mm));
    step_mm_.push_back(std::max(voxel_mm_, kStepOfRadius * tool.radius()));
  }
  int row = 0;
  for (const toolpath::Element& element : path.elements) {
    Element entry;
    if (const auto* block = std::get_if<BlockMove>(&element.what)) {
      entry.kind = kind_of(*block, job.scene.tools[static_cast<size_t>(block->tool)]);
    }
    const bool same = !elements_.empty() && elements_.back().kind == entry.kind;
    entry.row = same && entry.kind != BadCutKind::kRapid ? row : ++row;
    elements_.push_back(entry);
  }
}

bool BadCutCheck::suspicious(const stock::Sweep& sweep) const {
  const Element& element = element_of(sweep.block);
  if (!element.kind) return false;
  return std::none_of(found_.begin(), found_.end(),
                      [&](const BadCut& cut) { return element_of(cut.block).row == element.row; });
}

double BadCutCheck::depth_at(const stock::Stock& stock, const ToolPose& pose, size_t tool) const {
  const Vec3 nearest = pose.tip_W.cwiseMax(stock.box().lower).cwiseMin(stock.box().upper);
  if ((nearest - pose.tip_W).norm() > reach_mm_[tool]) return 0.0;
  const Vec3 x = pose.axis_W.unitOrthogonal();
  const Vec3 y = pose.axis_W.cross(x);
  double deepest = 0.0;
  for (const Vec3& p : points_[tool]) {
    const Vec3 point = pose.tip_W + p.x() * x + p.y() * y + p.z() * pose.axis_W;
    deepest = std::max(deepest, -stock.distance_mm(point));
  }
  return deepest;
}

void BadCutCheck::check(const stock::Stock& stock, const stock::Sweep& sweep) {
  const SweepSource& source = sweeps_.sources[sweep.block];
  const auto tool = static_cast<size_t>(source.tool);
  // A turn moves the flutes' far end even where the tip stands.
  const double way = (sweep.end.tip_W - sweep.start.tip_W).norm() +
                     (sweep.end.axis_W - sweep.start.axis_W).norm() * reach_mm_[tool];
  const int steps = std::max(1, static_cast<int>(std::ceil(way / step_mm_[tool])));
  double deepest = 0.0;
  for (int i = 1; i <= steps; ++i) {
    const double s = static_cast<double>(i) / steps;
    const ToolPose pose{sweep.start.tip_W + s * (sweep.end.tip_W - sweep.start.tip_W),
                        (sweep.start.axis_W + s * (sweep.end.axis_W - sweep.start.axis_W)).normalized()};
    deepest = std::max(deepest, depth_at(stock, pose, tool));
    if (deepest >= kBandVoxels * voxel_mm_ * (1.0 - 1e-6)) break;
  }
  if (deepest <= voxel_mm_) return;
  found_.push_back({*element_of(sweep.block).kind, sweep.block, deepest});
}

std::string bad_cuts_text(const std::vector<BadCut>& cuts) {
  std::string text;
  for (const BadCut& cut : cuts) {
    text += fmt::format("{} {} {};", static_cast<int>(cut.kind), cut.block, cut.depth_mm);
  }
  return text;
}

bool parse_bad_cuts(const std::string& text, std::vector<BadCut>& cuts) {
  std::istringstream in(text);
  int kind = 0;
  BadCut cut;
  char end = ';';
  while (in >> kind >> cut.block >> cut.depth_mm >> end) {
    if (kind < 0 || kind > static_cast<int>(BadCutKind::kSpindleReversed) || end != ';') return false;
    cut.kind = static_cast<BadCutKind>(kind);
    cuts.push_back(cut);
  }
  return in.eof() && end == ';';
}

}  // namespace swarf::sim
