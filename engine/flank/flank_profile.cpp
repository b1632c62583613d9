#include "flank/flank_profile.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "cutter/profile.h"

namespace swarf::flank {
namespace {

/// Steeper than this from the axis a line is the bottom of the cutter, not its flank.
constexpr double kSteepestFlank_rad = kPi / 4.0;

FlankProfile straight(const cutter::OutlineElement& line) {
  FlankProfile profile;
  const Vec2 way = line.to - line.from;
  profile.taper_rad = std::atan2(way.x(), way.y());
  const double slope = std::tan(profile.taper_rad);
  profile.radius = line.from.x() - line.from.y() * slope;
  profile.low = line.from.y() + line.from.x() * slope;
  profile.high = line.to.y() + line.to.x() * slope;
  return profile;
}

FlankProfile barrel(const cutter::OutlineElement& arc) {
  FlankProfile profile;
  profile.arc_radius = arc.radius;
  profile.arc_offset = -arc.centre.x();
  profile.arc_height = arc.centre.y();
  profile.low = nearest_ball(profile, arc.from.y(), arc.from.x());
  profile.high = nearest_ball(profile, arc.to.y(), arc.to.x());
  return profile;
}

}  // namespace

std::optional<FlankProfile> flank_profile(const cutter::Cutter& cutter) {
  std::optional<FlankProfile> found;
  double longest = 0.0;
  for (const cutter::OutlineElement& element : cutter::outline(cutter)) {
    const Vec2 way = element.to - element.from;
    const bool flank = std::atan2(std::abs(way.x()), way.y()) < kSteepestFlank_rad;
    // A corner whose centre is not beyond the axis is the end of a cutter, no barrel.
    const bool corner = !element.is_line() && (element.radius < 0.0 || element.centre.x() >= 0.0);
    if (!flank || corner || way.y() <= longest) continue;
    longest = way.y();
    found = element.is_line() ? straight(element) : barrel(element);
  }
  return found;
}

double ball_radius(const FlankProfile& profile, double c) {
  if (profile.arc_radius > 0.0)
    return profile.arc_radius - std::hypot(profile.arc_offset, c - profile.arc_height);
  return profile.radius * std::cos(profile.taper_rad) + c * std::sin(profile.taper_rad);
}

double ball_slope(const FlankProfile& profile, double c) {
  if (profile.arc_radius > 0.0)
    return (profile.arc_height - c) / std::hypot(profile.arc_offset, c - profile.arc_height);
  return std::sin(profile.taper_rad);
}

double nearest_ball(const FlankProfile& profile, double height, double from_axis) {
  if (profile.arc_radius > 0.0) {
    const double k = profile.arc_offset;
    return profile.arc_height + (height - profile.arc_height) * k / (from_axis + k);
  }
  return height + from_axis * std::tan(profile.taper_rad);
}

double flank_distance(const FlankProfile& profile, double height, double from_axis) {
  const double c = std::clamp(nearest_ball(profile, height, from_axis), profile.low, profile.high);
  return std::hypot(height - c, from_axis) - ball_radius(profile, c);
}

}  // namespace swarf::flank
