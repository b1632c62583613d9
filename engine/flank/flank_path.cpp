#include "flank/flank_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/parallel.h"
#include "flank/axis_curve.h"
#include "flank/feed.h"

namespace swarf::flank {
namespace {

using toolpath::BlockMove;

constexpr int kFewestBlocks = 16;
constexpr size_t kMostBlocks = 20000;
constexpr int kDeepest = 40;

/// How far the linear motion between two stations lies beside the axis surface, in terms of e.
double stray_of(const FlankTask& task, const Station& a, const Station& b, const Station& middle) {
  const ToolPose half = between(a.pose, b.pose);
  const AxisError linear = axis_error(task, half, middle.u), exact = axis_error(task, middle.pose, middle.u);
  return std::max(std::abs(linear.least_mm - exact.least_mm),
                  std::abs(linear.greatest_mm - exact.greatest_mm));
}

void divide(const FlankTask& task, double chord, const Station& a, const Station& b, int depth,
            std::vector<Station>& out) {
  Station middle;
  middle.u = 0.5 * (a.u + b.u);
  middle.pose = pose_at(task, middle.u);
  const bool close = stray_of(task, a, b, middle) <= 0.5 * chord &&
                     (between(a.pose, b.pose).tip_W - middle.pose.tip_W).norm() <= 100.0 * chord;
  if (close || depth >= kDeepest || out.size() > kMostBlocks) {
    out.push_back(b);
    return;
  }
  divide(task, chord, a, middle, depth + 1, out);
  divide(task, chord, middle, b, depth + 1, out);
}

void set_feeds(const FlankTask& task, const AxisFamily& family, const FlankMotion& motion,
               std::vector<Station>& stations) {
  const double left = motion.limit_mm - motion.chord_mm;
  parallel_chunks(stations.size(), 8, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      Station& at = stations[i];
      at.bisected_mm_s =
          bisected_feed(task, family, at.u, motion.period_s, left, motion.feed_mm_s, motion.middle);
      at.curvature_mm_s =
          curvature_feed(task, family, at.u, motion.period_s, motion.limit_mm, motion.feed_mm_s);
    }
  });
}

std::vector<Station> straight_stations(const FlankTask& task, const FlankMotion& motion,
                                       const SourceLocation& where) {
  std::vector<Station> stations;
  Station before{task.u_low, pose_at(task, task.u_low)};
  stations.push_back(before);
  for (int i = 1; i <= kFewestBlocks; ++i) {
    const double u = task.u_low + (task.u_high - task.u_low) * i / kFewestBlocks;
    const Station next{u, pose_at(task, u)};
    divide(task, motion.chord_mm, before, next, 0, stations);
    before = next;
  }
  if (stations.size() > kMostBlocks)
    throw InputError("too-many-blocks", where,
                     "a flank pass needs more than 20 000 blocks within flank.chord_um",
                     "a larger flank.chord_um needs fewer");
  return stations;
}

/// Between two of them the feed is even.
std::vector<Station> curve_stations(const AxisCurve& axis) {
  constexpr double kStep = 0.5;  // mm
  const double length = axis.curve->length_mm();
  const auto blocks = static_cast<int>(std::clamp(std::ceil(length / kStep), 16.0, 1024.0));
  std::vector<Station> stations;
  for (int i = 0; i <= blocks; ++i) {
    const double way = length * i / blocks;
    Station at{axis.u_of_way.at(way).w, axis.curve->pose(way)};
    at.way_mm = way;
    stations.push_back(at);
  }
  return stations;
}

double slowest(std::span<const FlankPass> passes) {
  double least = std::numeric_limits<double>::infinity();
  for (const FlankPass& pass : passes)
    for (const Station& at : pass.stations) least = std::min(least, at.bisected_mm_s);
  return least;
}

double feed_between(const Station& a, const Station& b, const FlankMotion& motion, FeedRule rule,
                    double constant) {
  switch (rule) {
    case FeedRule::kBisected:
      return std::min(a.bisected_mm_s, b.bisected_mm_s);
    case FeedRule::kConstant:
      return constant;
    case FeedRule::kCurvature:
      return std::min(a.curvature_mm_s, b.curvature_mm_s);
    case FeedRule::kProgrammed:
      break;
  }
  return motion.feed_mm_s;
}

/// Writes moves one behind the other.
class PathWriter {
 public:
  PathWriter() { path_.planner = "flank"; }
  void begin(const FlankPass& pass, int number, const ToolPose& pose) {
    pass_ = &pass;
    number_ = -1;
    if (started_) move(pose, 0.0, true);
    number_ = number;
    at_ = pose;
    started_ = true;
  }
  void move(const ToolPose& to, double feed, bool stop = false,
            const std::optional<toolpath::CurveSpan>& curve = std::nullopt) {
    const FlankMotion& motion = pass_->motion;
    BlockMove block;
    block.from = at_;
    block.to = to;
    const bool turned_rapid = feed == 0.0 && motion.law == toolpath::BlockLaw::kEnds;
    block.law = curve ? toolpath::BlockLaw::kCurve : turned_rapid ? toolpath::BlockLaw::kTcp : motion.law;
    block.curve = curve;
    block.feed_mm_s = feed;
    block.exact_stop = stop;
    if (motion.spindle_rpm != 0.0) block.spindle_rpm = motion.spindle_rpm;
    block.pass = number_;
    at_ = to;
    (feed == 0.0 ? path_.link_length_mm : path_.pass_length_mm) += toolpath::tip_way(block);
    path_.elements.push_back({std::move(block), 0, pass_->where});
  }
  toolpath::ToolPath take(int passes) {
    path_.passes = passes;
    return std::move(path_);
  }

 private:
  toolpath::ToolPath path_;
  const FlankPass* pass_ = nullptr;
  int number_ = -1;  ///< of the pass; -1 between passes
  ToolPose at_;
  bool started_ = false;
};

ToolPose moved(const ToolPose& pose, const Vec3& by) {
  return {pose.tip_W + by, pose.axis_W};
}

void write_pass(const FlankPass& pass, FeedRule rule, double constant, int number, PathWriter& writer) {
  const FlankMotion& motion = pass.motion;
  const std::vector<Station>& stations = pass.stations;
  const ToolPose &first = stations.front().pose, &last = stations.back().pose;
  writer.begin(pass, number, moved(first, motion.retract_mm * first.axis_W));
  // Along its own axis a tool stops: a rounded corner would leave the flank's surface.
  writer.move(first, motion.feed_mm_s, true);
  for (size_t i = 1; i < stations.size(); ++i) {
    const Station &from = stations[i - 1], &to = stations[i];
    std::optional<toolpath::CurveSpan> span;
    if (pass.curve) span = toolpath::CurveSpan{pass.curve, from.way_mm, to.way_mm};
    writer.move(to.pose, feed_between(from, to, motion, rule, constant), i + 1 == stations.size(), span);
  }
  writer.move(moved(last, motion.retract_mm * last.axis_W), motion.feed_mm_s);
}

}  // namespace

void plan_pass(FlankPass& pass) {
  const FlankTask& task = pass.task;
  const FlankMotion& motion = pass.motion;
  std::optional<AxisFamily> family;
  if (motion.on_curve || motion.limit_mm > 0.0) family.emplace(task);
  if (motion.on_curve) {
    const AxisCurve axis = axis_curve(task, *family, motion.chord_mm, pass.where);
    pass.curve = axis.curve;
    pass.stations = curve_stations(axis);
  } else {
    pass.stations = straight_stations(task, motion, pass.where);
  }
  if (motion.limit_mm > 0.0) set_feeds(task, *family, motion, pass.stations);
}

toolpath::ToolPath flank_path(std::span<const FlankPass> passes, FeedRule rule) {
  PathWriter writer;
  const double constant = rule == FeedRule::kConstant ? slowest(passes) : 0.0;
  for (size_t i = 0; i < passes.size(); ++i)
    write_pass(passes[i], rule, constant, static_cast<int>(i), writer);
  return writer.take(static_cast<int>(passes.size()));
}

}  // namespace swarf::flank
