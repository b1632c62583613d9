#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angles.h"
#include "toolpath/driven/driven_path.h"

namespace swarf::toolpath {
namespace {

constexpr double kShortest_mm = 1e-6;

/// As many equal parts as keep the interval; at least one.
int parts_of(double width, double interval) {
  return std::max(1, static_cast<int>(std::ceil(width / interval - 1e-9)));
}

/// The share of the line p + t d that lies in the area.
std::optional<std::pair<Vec2, Vec2>> clipped(const std::array<Vec2, 2>& area, const Vec2& p, const Vec2& d) {
  double low = -1e12, high = 1e12;
  for (int i = 0; i < 2; ++i) {
    if (std::abs(d[i]) < 1e-12) {
      if (p[i] < area[0][i] - 1e-9 || p[i] > area[1][i] + 1e-9) return std::nullopt;
      continue;
    }
    const double a = (area[0][i] - p[i]) / d[i], b = (area[1][i] - p[i]) / d[i];
    low = std::max(low, std::min(a, b));
    high = std::min(high, std::max(a, b));
  }
  if (high - low <= kShortest_mm) return std::nullopt;
  return std::pair<Vec2, Vec2>(p + low * d, p + high * d);
}

std::vector<GuidedPass> scan(const DrivenPlan& plan) {
  const Vec2 along(std::cos(plan.angle_rad), std::sin(plan.angle_rad)), across(-along.y(), along.x());
  const std::array<Vec2, 2>& area = plan.area;
  double low = 1e300, high = -1e300;
  for (const Vec2& corner :
       {area[0], Vec2(area[1].x(), area[0].y()), Vec2(area[0].x(), area[1].y()), area[1]}) {
    low = std::min(low, corner.dot(across));
    high = std::max(high, corner.dot(across));
  }
  const int parts = parts_of(high - low, plan.interval_mm);
  std::vector<GuidedPass> passes;
  Vec2 last = Vec2::Zero();
  for (int i = 0; i <= parts; ++i) {
    const auto line = clipped(area, (low + (high - low) * i / parts) * across, along);
    if (!line) continue;  // it touches a corner of the area at the most
    const bool back = plan.zigzag && passes.size() % 2 == 1;
    const Vec2 from = back ? line->second : line->first, to = back ? line->first : line->second;
    const int pass = static_cast<int>(passes.size());
    std::vector<GuidePiece> pieces{guide_line(from, to)};
    const bool joined = plan.zigzag && pass > 0 && (from - last).norm() > kShortest_mm;
    if (joined) pieces.insert(pieces.begin(), guide_line(last, from));
    passes.push_back({GuideCurve(std::move(pieces)), joined, pass});
    last = to;
  }
  return passes;
}

std::vector<GuidedPass> contour(const DrivenPlan& plan) {
  const Vec2 size = plan.area[1] - plan.area[0];
  const double half = 0.5 * size.minCoeff();
  const int parts = parts_of(half, plan.interval_mm);
  std::vector<GuidedPass> passes;
  Vec2 last = Vec2::Zero();
  for (int i = 0; i < parts; ++i) {
    const Vec2 inward = Vec2::Constant(half * i / parts);
    const Vec2 low = plan.area[0] + inward, high = plan.area[1] - inward;
    std::vector<GuidePiece> pieces{
        guide_line(low, {high.x(), low.y()}), guide_line({high.x(), low.y()}, high),
        guide_line(high, {low.x(), high.y()}), guide_line({low.x(), high.y()}, low)};
    if (i > 0) pieces.insert(pieces.begin(), guide_line(last, low));
    passes.push_back({GuideCurve(std::move(pieces)), i > 0, i});
    last = low;
  }
  // What is left of the area is a line.
  const Vec2 low = plan.area[0] + Vec2::Constant(half), high = plan.area[1] - Vec2::Constant(half);
  std::vector<GuidePiece> pieces{guide_line(last, low)};
  if ((high - low).norm() > kShortest_mm) pieces.push_back(guide_line(low, high));
  passes.push_back({GuideCurve(std::move(pieces)), true, parts});
  return passes;
}

std::vector<GuidedPass> spiral(const DrivenPlan& plan) {
  const double change = plan.radius_to_mm - plan.radius_from_mm;
  const double turns = std::abs(change) / plan.interval_mm;
  std::vector<GuidePiece> pieces;
  const auto circle = [&](double radius, double angle) {
    if (radius > kShortest_mm) pieces.push_back(guide_spiral(plan.centre, radius, radius, angle, kTurn));
  };
  // A whole circle at either end, so that the spiral leaves no crescent.
  circle(plan.radius_from_mm, 0.0);
  if (turns > 0.0)
    pieces.push_back(guide_spiral(plan.centre, plan.radius_from_mm, plan.radius_to_mm, 0.0, kTurn * turns));
  if (turns > 0.0) circle(plan.radius_to_mm, kTurn * turns);
  if (pieces.empty()) return {};
  return {{GuideCurve(std::move(pieces)), false, 0}};
}

std::vector<GuidedPass> along_guide(const DrivenPlan& plan) {
  std::vector<GuidePiece> pieces;
  for (size_t i = 0; i + 1 < plan.guide.size(); ++i) {
    if ((plan.guide[i + 1] - plan.guide[i]).norm() > kShortest_mm)
      pieces.push_back(guide_line(plan.guide[i], plan.guide[i + 1]));
  }
  if (pieces.empty()) return {};
  return {{GuideCurve(std::move(pieces)), false, 0}};
}

}  // namespace

std::vector<GuidedPass> guided_passes(const DrivenPlan& plan, Diagnostics& diagnostics) {
  std::vector<GuidedPass> passes = plan.mode == GuideMode::kScan      ? scan(plan)
                                   : plan.mode == GuideMode::kContour ? contour(plan)
                                   : plan.mode == GuideMode::kSpiral  ? spiral(plan)
                                                                      : along_guide(plan);
  if (passes.empty())
    diagnostics.error("area-too-small", {}, "no guide lies in the area: it has no extent",
                      "give area_mm (or the points of guide_mm) an extent");
  return passes;
}

}  // namespace swarf::toolpath
