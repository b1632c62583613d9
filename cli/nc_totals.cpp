#include "cli/nc_totals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/units.h"
#include "cli/terminal.h"

namespace swarf::cli {
namespace {

/// Ends closer than this are one point, mm: the arc is a whole circle.
constexpr double kSamePoint = 1e-9;

/// Counter-clockwise about n from a to b, in [0, 2 pi).
double angle_about(const Vec3& n, const Vec3& a, const Vec3& b) {
  const double angle = std::atan2(a.cross(b).dot(n), a.dot(b));
  return angle < 0.0 ? angle + kTurn : angle;
}

}  // namespace

void NcTotals::add_arc(const program::NcMove& move) {
  const Vec3& n = move.arc->normal_W;
  const auto flat = [&](const Vec3& v) { return Vec3(v - v.dot(n) * n); };
  const Vec3 a = flat(move.from.tip_W - move.arc->centre_W), b = flat(move.to.tip_W - move.arc->centre_W);
  const double swept = (a - b).norm() <= kSamePoint ? kTurn : angle_about(n, a, b);
  const double rise = (move.to.tip_W - move.from.tip_W).dot(n);
  (move.rapid ? rapid_mm : feed_mm) += std::hypot(a.norm() * swept, rise);
  // Where the arc is farthest along X, Y and Z, when it passes there.
  const double radius = a.norm();
  for (int k = 0; k < 6; ++k) {
    const Vec3 way = flat((k < 3 ? 1.0 : -1.0) * Vec3::Unit(k % 3));
    if (way.norm() < 1e-12) continue;
    const Vec3 spoke = radius * way.normalized();
    const double angle = angle_about(n, a, spoke);
    if (angle < swept) cut_W.extend(Vec3(move.from.tip_W - a + spoke + angle / swept * rise * n));
  }
}

void NcTotals::add_rapid(const program::NcMove& move) {
  double longest = 0.0;
  for (size_t i = 0; i < machine_.axes.size(); ++i) {
    const kinematics::Axis& axis = machine_.axes[i];
    const auto index = static_cast<long>(i);
    const double speed = axis.rapid_max > 0.0 ? axis.rapid_max : axis.speed_max;
    const double way = std::abs(move.q_to[index] - move.q_from[index]);
    if (way == 0.0) continue;
    if (speed > 0.0)
      longest = std::max(longest, way / speed);
    else
      rapids_timed = false;
  }
  rapid_s += longest;
}

void NcTotals::check_travel(const program::NcMove& move) {
  for (size_t i = 0; i < machine_.axes.size() && out_of_travel.empty(); ++i) {
    const kinematics::Axis& axis = machine_.axes[i];
    const double q = move.q_to[static_cast<long>(i)];
    if (q >= axis.min - 1e-9 && q <= axis.max + 1e-9) continue;
    const bool linear = axis.kind == kinematics::AxisKind::kLinear;
    const auto shown = [&](double x) { return linear ? x : deg_from_rad(x); };
    out_of_travel_line = move.line;
    out_of_travel =
        fmt::format("{} goes to {:.3f} {} in line {} first; its travel is {:.3f} to {:.3f}", axis.name,
                    shown(q), linear ? "mm" : "deg", move.line, shown(axis.min), shown(axis.max));
  }
}

bool NcTotals::move(const program::NcMove& move) {
  if (feeds + rapids == 0) low = high = move.q_from;
  (move.rapid ? rapids : feeds) += 1;
  feed_s += move.duration_s;
  dwell_s += move.dwell_s;
  low = low.cwiseMin(move.q_to);
  high = high.cwiseMax(move.q_to);
  if (move.arc) {
    ++arcs;
    add_arc(move);
  } else {
    (move.rapid ? rapid_mm : feed_mm) += (move.to.tip_W - move.from.tip_W).norm();
  }
  if (move.rapid) {
    add_rapid(move);
  } else {
    cut_W.extend(move.from.tip_W).extend(move.to.tip_W);
  }
  check_travel(move);
  return !interrupted();
}

}  // namespace swarf::cli
