#include "toolpath/driven/driven_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/units.h"
#include "toolpath/driven/leaned_guide.h"

namespace swarf::toolpath {
namespace {

/// A CAM system looks at the surface this often, mm; its blocks begin and end there.
constexpr double kCamStep_mm = 0.02;

/// Drawn back along its own axis until the tip is this high along `up`, which the axis does not lie square
/// to.
ToolPose at_height(const ToolPose& pose, const Vec3& up, double height) {
  ToolPose high = pose;
  const double missing = height - pose.tip_W.dot(up);
  if (missing > 0.0) high.tip_W += missing / pose.axis_W.dot(up) * pose.axis_W;
  return high;
}

/// The guides of the passes; those that are joined lean along one curve, so that each begins as the one
/// before has ended.
std::vector<std::shared_ptr<const Guide>> guides_of(const DrivenPlan& plan, const DrivenPart& on,
                                                    const std::vector<GuidedPass>& passes,
                                                    const SourceLocation& where) {
  std::vector<std::shared_ptr<const Guide>> guides;
  const position::GuideLine plane = position::turned_line(Vec3::Zero(), plan.axis_W);
  const LeanOptions lean{plan.lead_rad, plan.tilt_rad, plan.axis_smooth_mm};
  for (size_t i = 0; i < passes.size();) {
    size_t end = i + 1;
    while (end < passes.size() && passes[end].joined) ++end;
    std::vector<GuideCurve> chain;
    for (size_t k = i; k < end; ++k) chain.push_back(passes[k].curve);
    const auto curve = plan.follows ? lean_curve(on, chain, lean, where) : nullptr;
    double offset = 0.0;
    for (const GuideCurve& one : chain) {
      if (curve)
        guides.push_back(std::make_shared<LeanedGuide>(one, curve, offset, pivot_height(on.profile)));
      else
        guides.push_back(std::make_shared<PlaneGuide>(one, plane));
      offset += one.end();
    }
    i = end;
  }
  return guides;
}

/// The ends of the longest straight blocks that keep every looked-at position within the tolerance.
std::vector<ToolPose> cam_points(const DrivenPass& pass, double tolerance_mm) {
  const int count = std::max(1, static_cast<int>(std::ceil(pass.guide->end() / kCamStep_mm)));
  std::vector<ToolPose> seen;
  position::Near near;
  for (int i = 0; i <= count; ++i) seen.push_back(tip_at(pass, pass.guide->end() * i / count, near).pose);
  const double lever = pass.on->profile.radius();
  const auto fits = [&](size_t from, size_t to) {
    const Vec3 a = seen[from].tip_W, along = (seen[to].tip_W - a).normalized();
    for (size_t i = from + 1; i < to; ++i) {
      const Vec3 d = seen[i].tip_W - a;
      if ((d - d.dot(along) * along).norm() > tolerance_mm) return false;
      const double share = static_cast<double>(i - from) / static_cast<double>(to - from);
      const Vec3 axis = (1.0 - share) * seen[from].axis_W + share * seen[to].axis_W;
      if (lever * (axis - seen[i].axis_W).norm() > tolerance_mm) return false;
    }
    return true;
  };
  std::vector<ToolPose> points{seen.front()};
  for (size_t from = 0; from + 1 < seen.size();) {
    // As far as it fits; on curves that is without gaps.
    size_t to = from + 1;
    while (to + 1 < seen.size() && fits(from, to + 1)) ++to;
    points.push_back(seen[to]);
    from = to;
  }
  return points;
}

/// An override of a pass that does not exist would change nothing.
void require_passes(const DrivenPlan& plan, int passes, const SourceLocation& where,
                    Diagnostics& diagnostics) {
  for (const OverrideChange& change : plan.overrides) {
    if (change.pass < passes) continue;
    diagnostics.error("override-no-pass", where,
                      fmt::format("'override' names pass {}, and there are {}", change.pass + 1, passes),
                      fmt::format("name a pass from 1 to {}", passes));
    return;
  }
}

/// Elements of the path, as passes or as blocks.
class ElementWriter {
 public:
  ElementWriter(const DrivenPlan& plan, const SourceLocation& where, ToolPath& path)
      : plan_(plan), where_(where), path_(path) {}

  void move(MoveKind kind, const ToolPose& from, const ToolPose& to, double feed_mm_s) {
    if ((to.tip_W - from.tip_W).norm() == 0.0) return;
    path_.link_length_mm += (to.tip_W - from.tip_W).norm();
    if (blocks())
      block(from, to, feed_mm_s, -1);
    else
      path_.elements.push_back({FreeMove{kind, from, to, feed_mm_s}, 0, where_});
  }

  /// Returns where the pass has ended.
  ToolPose pass(const DrivenPass& pass) {
    if (!blocks()) {
      path_.elements.push_back({pass, 0, where_});
      position::Near near;
      path_.pass_length_mm += pass.guide->end();
      return tip_at(pass, pass.guide->end(), near).pose;
    }
    const std::vector<ToolPose> points = cam_points(pass, plan_.cam_tolerance_mm);
    for (size_t i = 0; i + 1 < points.size(); ++i) {
      block(points[i], points[i + 1], pass.feed_mm_s, pass.pass);
      path_.pass_length_mm += (points[i + 1].tip_W - points[i].tip_W).norm();
    }
    return points.back();
  }

 private:
  bool blocks() const { return plan_.cam_tolerance_mm > 0.0; }

  void block(const ToolPose& from, const ToolPose& to, double feed_mm_s, int pass) {
    BlockMove move;
    move.from = from;
    move.to = to;
    move.feed_mm_s = feed_mm_s;
    move.pass = pass;
    if (plan_.spindle_rpm > 0.0) move.spindle_rpm = plan_.spindle_rpm;
    SourceLocation where = where_;
    where.line = ++line_;
    path_.elements.push_back({move, 0, where});
  }

  const DrivenPlan& plan_;
  SourceLocation where_;
  ToolPath& path_;
  int line_ = 0;
};

}  // namespace

ToolPath driven_path(const DrivenPlan& plan, const std::shared_ptr<const DrivenPart>& on,
                     const SourceLocation& where, Diagnostics& diagnostics) {
  ToolPath path;
  path.planner = plan.cam_tolerance_mm > 0.0
                     ? fmt::format("CAM blocks within {:g} um", um_from_mm(plan.cam_tolerance_mm))
                     : "surface driven";
  ElementWriter writer(plan, where, path);
  const double high = plan.stock_top_mm + plan.rapid_clearance_mm;
  const double safe = plan.stock_top_mm + plan.safe_distance_mm;
  std::optional<ToolPose> at;
  const std::vector<GuidedPass> passes = guided_passes(plan, diagnostics);
  if (!passes.empty()) require_passes(plan, passes.back().pass + 1, where, diagnostics);
  std::vector<std::shared_ptr<const Guide>> guides;
  try {
    guides = guides_of(plan, *on, passes, where);
  } catch (const InputError& error) {
    diagnostics.append(error.diagnostics);
    return path;
  }
  for (size_t i = 0; i < passes.size(); ++i) {
    const GuidedPass& guided = passes[i];
    DrivenPass pass;
    pass.on = on;
    pass.guide = guides[i];
    pass.feed_mm_s = plan.feed_mm_s;
    pass.chord_tolerance_mm = plan.chord_tolerance_mm;
    pass.pass = guided.pass;
    for (const OverrideChange& change : plan.overrides)
      if (change.pass == guided.pass) pass.overrides.push_back(change);
    position::Near near;
    const TipPoint first = tip_at(pass, 0.0, near);
    if (!std::isfinite(first.rest.height)) {
      const Vec3 p = pass.guide->line(0.0).point_W;
      diagnostics.error("guide-misses-part", where,
                        fmt::format("pass {} begins at ({:.3f}, {:.3f}) mm, where the tool rests on nothing",
                                    guided.pass + 1, p.x(), p.y()),
                        "keep the guide on the part (area_mm), or say how low the tool may go: floor_mm");
      return path;
    }
    if (!guided.joined || !at) {
      const ToolPose entry = at_height(first.pose, plan.axis_W, safe);
      if (at) {
        const ToolPose up = at_height(*at, plan.axis_W, safe);
        writer.move(MoveKind::kRetract, *at, up, 0.0);
        writer.move(MoveKind::kRapid, up, entry, 0.0);
      } else {
        writer.move(MoveKind::kRapid, at_height(first.pose, plan.axis_W, high), entry, 0.0);
      }
      writer.move(MoveKind::kApproach, entry, first.pose, plan.approach_feed_fraction * plan.feed_mm_s);
    }
    at = writer.pass(pass);
    path.passes = guided.pass + 1;
  }
  if (at) writer.move(MoveKind::kRetract, *at, at_height(*at, plan.axis_W, high), 0.0);
  return path;
}

}  // namespace swarf::toolpath
