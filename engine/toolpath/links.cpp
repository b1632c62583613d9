#include "toolpath/links.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/tool_axis.h"
#include "toolpath/surface_curve.h"

namespace swarf::toolpath {
namespace {

/// Links keep this share of the safe distance from points of the design that lie as far apart: no place
/// between them is farther than 0.71 of that from a point, so 0.29 of it always remains.
constexpr double kClearanceShare = 0.5;

ToolPose lifted(const ToolPose& pose, double distance) {
  return {pose.tip_W + distance * pose.axis_W, pose.axis_W};
}

/// Distance from a point to the solid cylinder that stands on the tip.
double distance_to_cutter(const Vec3& point, const Vec3& tip, const Vec3& axis, double radius,
                          double length) {
  const Vec3 gap = point - tip;
  const double along = gap.dot(axis);
  const double across = std::sqrt(std::max(0.0, gap.squaredNorm() - along * along));
  return std::hypot(std::max(0.0, across - radius), std::max({0.0, -along, along - length}));
}

/// The pose above a pass end from which the tool goes straight in: as high as the top of the stock, so that
/// the way through raw material is made at approach feed. Steep axes only; others start at the safe distance.
ToolPose entry_pose(const ToolPose& contact, const PlanOptions& options) {
  constexpr double kSteep = 0.5;  // axis within 60 degrees of the vertical
  double distance = options.safe_distance_mm;
  if (contact.axis_W.z() >= kSteep) {
    const double height = options.stock_top_mm + options.safe_distance_mm - contact.tip_W.z();
    distance = std::max(distance, height / contact.axis_W.z());
  }
  return lifted(contact, distance);
}

/// Straight above a pose, at the clearance height.
ToolPose high_pose(const ToolPose& pose, const PlanOptions& options) {
  ToolPose high = pose;
  high.tip_W.z() = std::max(high.tip_W.z(), options.stock_top_mm + options.rapid_clearance_mm);
  return high;
}

/// Appends elements of one operation.
struct Writer {
  ToolPath& path;
  int operation;
  SourceLocation where;

  void move(MoveKind kind, const ToolPose& from, const ToolPose& to, double feed_mm_s) {
    path.elements.push_back({FreeMove{kind, from, to, feed_mm_s}, operation, where});
    path.link_length_mm += (to.tip_W - from.tip_W).norm();
  }
  void pass(const SurfacePass& pass) {
    path.elements.push_back({pass, operation, where});
    path.pass_length_mm += curve_length(*pass.surface, pass.curve, pass.t_start, pass.t_end);
  }
};

/// From wherever the previous operation ended, to the first contact.
void begin(Writer& writer, const ToolPose& contact, double feed, const PlanOptions& options) {
  const ToolPose entry = entry_pose(contact, options);
  const ToolPose high = high_pose(entry, options);
  if (!writer.path.elements.empty())
    writer.move(MoveKind::kRapid, std::get<FreeMove>(writer.path.elements.back().what).to, high, 0.0);
  writer.move(MoveKind::kRapid, high, entry, 0.0);
  writer.move(MoveKind::kApproach, entry, contact, feed);
}

void finish(Writer& writer, const ToolPose& contact, const PlanOptions& options) {
  const ToolPose entry = entry_pose(contact, options);
  writer.move(MoveKind::kRetract, contact, entry, 0.0);
  writer.move(MoveKind::kRapid, entry, high_pose(entry, options), 0.0);
}

/// Least height along both axes, by steps of half as much again, at which the straight way is clear; negative
/// when there is none up to the limit.
double clear_height(const ToolPose& from, const ToolPose& to, const Obstacle& obstacle,
                    const cutter::Cutter& cutter, double safe_distance) {
  const double limit = 2.0 * obstacle.diagonal_mm + 10.0 * safe_distance;
  for (double height = safe_distance; height <= limit; height *= 1.5)
    if (move_is_clear(lifted(from, height), lifted(to, height), obstacle, cutter,
                      kClearanceShare * safe_distance))
      return height;
  return -1.0;
}

bool link(Writer& writer, const ToolPose& from, const ToolPose& to, double feed, const Obstacle& obstacle,
          const cutter::Cutter& cutter, const PlanOptions& options) {
  const double safe = options.safe_distance_mm;
  const double height = clear_height(from, to, obstacle, cutter, safe);
  if (height < 0.0) return false;
  writer.move(MoveKind::kRetract, from, lifted(from, height), 0.0);
  writer.move(MoveKind::kRapid, lifted(from, height), lifted(to, height), 0.0);
  if (height > safe) writer.move(MoveKind::kRapid, lifted(to, height), lifted(to, safe), 0.0);
  writer.move(MoveKind::kApproach, lifted(to, safe), to, feed);
  return true;
}

}  // namespace

Obstacle obstacle_of(const surface::Surface& surface, double spacing_mm) {
  const auto pieces = [&](bool along_u) {
    double longest = 0.0;
    for (int i = 0; i <= 4; ++i)
      longest =
          std::max(longest, curve_length(surface, {along_u, CubicSpline::constant(0.25 * i)}, 0.0, 1.0));
    return std::max(1, static_cast<int>(std::ceil(longest / spacing_mm)));
  };
  const int nu = pieces(true);
  const int nv = pieces(false);
  Obstacle obstacle;
  Vec3 lower = surface.point(0.0, 0.0);
  Vec3 upper = lower;
  for (int i = 0; i <= nu; ++i) {
    for (int j = 0; j <= nv; ++j) {
      const Vec3 point = surface.point(static_cast<double>(i) / nu, static_cast<double>(j) / nv);
      obstacle.points.push_back(point);
      lower = lower.cwiseMin(point);
      upper = upper.cwiseMax(point);
    }
  }
  obstacle.diagonal_mm = (upper - lower).norm();
  return obstacle;
}

bool move_is_clear(const ToolPose& from, const ToolPose& to, const Obstacle& obstacle,
                   const cutter::Cutter& cutter, double clearance) {
  // A step moves no point of the cutter by more than a quarter of the radius.
  const double turn = angle_between(from.axis_W, to.axis_W);
  const double travel = (to.tip_W - from.tip_W).norm() + turn * (cutter.length_mm + cutter.radius());
  const int steps = std::max(1, static_cast<int>(std::ceil(4.0 * travel / cutter.radius())));
  std::vector<ToolPose> poses(steps + 1);
  for (int i = 0; i <= steps; ++i) poses[i] = pose_between(from, to, static_cast<double>(i) / steps);
  for (const Vec3& point : obstacle.points) {
    for (int i = 0; i <= steps;) {
      const double distance =
          distance_to_cutter(point, poses[i].tip_W, poses[i].axis_W, cutter.radius(), cutter.length_mm);
      if (distance < clearance) return false;
      i += 1 + static_cast<int>((distance - clearance) / travel * steps);
    }
  }
  return true;
}

PassEnds ends_of(const SurfacePass& pass, const ContactEnd& end) {
  const double direction = pass.t_end > pass.t_start ? 1.0 : -1.0;
  const auto pose = [&](double t) {
    const CurvePoint point = curve_at(*pass.surface, pass.curve, t);
    return pose_in_contact(point.C, outward_normal(*pass.surface, point.surface),
                           direction * point.dC.normalized(), pass.lead_rad, pass.tilt_rad, end);
  };
  return {pose(pass.t_start), pose(pass.t_end)};
}

void append_passes(ToolPath& path, const std::vector<SurfacePass>& passes, int operation,
                   const SourceLocation& where, const cutter::Cutter& cutter, const PlanOptions& options,
                   Diagnostics& diagnostics) {
  if (passes.empty()) return;
  const double feed = options.approach_feed_fraction * passes.front().feed_mm_s;
  const Obstacle obstacle = obstacle_of(*passes.front().surface, kClearanceShare * options.safe_distance_mm);
  Writer writer{path, operation, where};
  PassEnds before;
  for (size_t i = 0; i < passes.size(); ++i) {
    const PassEnds ends = ends_of(passes[i], contact_end(cutter));
    if (i == 0) {
      begin(writer, ends.start, feed, options);
    } else if (!link(writer, before.end, ends.start, feed, obstacle, cutter, options)) {
      diagnostics.error(
          "link-not-clear", where,
          fmt::format("no straight rapid from the end of pass {} to the start of pass {} clears the part",
                      passes[i - 1].pass + 1, passes[i].pass + 1),
          "cut in zigzag (L1), or split the surface so that its ends face the same way");
      return;
    }
    writer.pass(passes[i]);
    before = ends;
  }
  finish(writer, before.end, options);
}

}  // namespace swarf::toolpath
