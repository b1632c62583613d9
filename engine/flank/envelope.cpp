#include "flank/envelope.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/minima.h"
#include "flank/feed.h"

namespace swarf::flank {
namespace {

/// A height farther from the design is not that of this flank pass, mm.
constexpr double kFarthest = 1.0;
constexpr double kSolved = 1e-9;

}  // namespace

PoseTrack::PoseTrack(std::vector<ToolPose> poses, const FlankProfile& profile)
    : poses_(std::move(poses)), profile_(profile) {
  SWARF_CHECK(poses_.size() >= 2, "a track of two poses at least");
  way_.push_back(0.0);
  for (size_t i = 1; i < poses_.size(); ++i) {
    const Vec3 tip = poses_[i].tip_W - poses_[i - 1].tip_W, axis = poses_[i].axis_W - poses_[i - 1].axis_W;
    way_.push_back(way_.back() +
                   std::max((tip + profile_.low * axis).norm(), (tip + profile_.high * axis).norm()));
  }
}

double PoseTrack::distance(const ToolPose& pose, const Vec3& point) const {
  const Vec3 d = point - pose.tip_W;
  const double height = d.dot(pose.axis_W);
  return flank_distance(profile_, height, (d - height * pose.axis_W).norm());
}

void PoseTrack::search_step(const Vec3& point, size_t step, Nearest& best) const {
  const auto at = [&](double s) { return distance(between(poses_[step], poses_[step + 1], s), point); };
  const Minimum least = least_between(at, 0.0, 1.0);
  if (least.value < best.distance_mm) best.distance_mm = least.value, best.step = step, best.share = least.at;
}

void PoseTrack::search(const Vec3& point, size_t first, size_t last, double at_first, double at_last,
                       Nearest& best) const {
  if (0.5 * (at_first + at_last - (way_[last] - way_[first])) >= best.distance_mm) return;
  if (last == first + 1) return search_step(point, first, best);
  const size_t middle = (first + last) / 2;
  const double at_middle = distance(poses_[middle], point);
  if (at_middle < best.distance_mm) {
    best.distance_mm = at_middle;
    best.step = middle - 1;
    best.share = 1.0;
  }
  // The nearer half first: it rules out most of the other.
  if (at_first < at_last) {
    search(point, first, middle, at_first, at_middle, best);
    search(point, middle, last, at_middle, at_last, best);
  } else {
    search(point, middle, last, at_middle, at_last, best);
    search(point, first, middle, at_first, at_middle, best);
  }
}

PoseTrack::Nearest PoseTrack::nearest(const Vec3& point) const {
  Nearest best;
  const size_t last = poses_.size() - 1;
  const double at_first = distance(poses_.front(), point), at_last = distance(poses_.back(), point);
  best.distance_mm = std::min(at_first, at_last);
  best.step = at_first <= at_last ? 0 : last - 1;
  best.share = at_first <= at_last ? 0.0 : 1.0;
  search(point, 0, last, at_first, at_last, best);
  const ToolPose pose = between(poses_[best.step], poses_[best.step + 1], best.share);
  const Vec3 d = point - pose.tip_W;
  const double height = d.dot(pose.axis_W);
  const double c = nearest_ball(profile_, height, (d - height * pose.axis_W).norm());
  best.on_flank = c >= profile_.low && c <= profile_.high;
  best.outward = (d - std::clamp(c, profile_.low, profile_.high) * pose.axis_W).normalized();
  return best;
}

std::optional<double> PoseTrack::height(const Vec3& point, const Vec3& normal) const {
  double h = 0.0;
  for (int i = 0; i < 12; ++i) {
    const Nearest near = nearest(point + h * normal);
    if (std::abs(near.distance_mm) > kFarthest || !near.on_flank) return std::nullopt;
    const double slope = near.outward.dot(normal);
    // The cutter lies on the outward side: going out leads into it.
    if (slope > -0.5) return std::nullopt;
    h -= near.distance_mm / slope;
    if (std::abs(near.distance_mm) < kSolved) return h;
  }
  return std::nullopt;
}

}  // namespace swarf::flank
