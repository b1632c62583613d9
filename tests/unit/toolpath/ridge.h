// What a tool path truly leaves between its passes, found by brute force from poses alone: the oracle for the
// planners. Nothing here knows how passes were planned.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "dome.h"

namespace swarf::toolpath::test {

inline double low_t(const SurfacePass& pass) {
  return std::min(pass.t_start, pass.t_end);
}
inline double high_t(const SurfacePass& pass) {
  return std::max(pass.t_start, pass.t_end);
}

/// A point of the design with its outward normal.
struct DesignPoint {
  Vec3 Q, N;
};
inline DesignPoint design_point(const SurfacePass& pass, double t, double w) {
  const double u = pass.curve.along_u ? t : w;
  const double v = pass.curve.along_u ? w : t;
  const surface::Derivatives d = pass.surface->derivatives(u, v);
  return {d.S, surface::outward_normal(*pass.surface, d)};
}

/// How far below the rounded end a point stands, mm: below 0 inside it. For points below the corner's centre.
inline double outside_end(const ToolPose& pose, const ContactEnd& end, const Vec3& point) {
  const Vec3 from_tip = point - pose.tip_W;
  const double z = from_tip.dot(pose.axis_W);
  const double aside = (from_tip - z * pose.axis_W).norm();
  return std::hypot(std::max(0.0, aside - end.flat_mm), end.corner_mm - z) - end.corner_mm;
}

/// Where the ray from Q along N enters a rounded end within .3 mm; infinity where it passes it.
inline double height_below_round(const ToolPose& pose, const ContactEnd& end, const DesignPoint& point) {
  const auto outside = [&](double x) { return outside_end(pose, end, point.Q + x * point.N); };
  double low = -0.01;
  double high = 0.3;
  if (outside(high) > 0.0) return std::numeric_limits<double>::infinity();
  for (int i = 0; i < 40; ++i) (outside(0.5 * (low + high)) > 0.0 ? low : high) = 0.5 * (low + high);
  return high;
}

/// Where the ray from Q along N meets the end of the tool in contact at s; infinity where it passes it.
inline double height_at(const SurfacePass& pass, const ContactEnd& end, const DesignPoint& point, double s) {
  const CurvePoint c = curve_at(*pass.surface, pass.curve, s);
  const double direction = pass.t_end > pass.t_start ? 1.0 : -1.0;
  const Vec3 normal = surface::outward_normal(*pass.surface, c.surface);
  const ToolPose pose =
      pose_in_contact(c.C, normal, direction * c.dC.normalized(), pass.lead_rad, pass.tilt_rad, end);
  if (end.corner_mm > 0.0) return height_below_round(pose, end, point);
  const double rise = point.N.dot(pose.axis_W);
  const double height = (pose.tip_W - point.Q).dot(pose.axis_W) / rise;
  const bool hit = rise > 0.0 && (point.Q + height * point.N - pose.tip_W).norm() <= end.flat_mm;
  return hit ? height : std::numeric_limits<double>::infinity();
}

/// Least height that a pass leaves over a point: a scan over the contacts within reach, sharpened by golden
/// section in smooth places and by bisection where the rim just touches the ray.
inline double height_left(const SurfacePass& pass, const ContactEnd& end, const DesignPoint& point,
                          double t) {
  const double reach = 2.0 * end.radius() / curve_at(*pass.surface, pass.curve, t).dC.norm();
  const double from = std::max(low_t(pass), t - reach);
  const double to = std::min(high_t(pass), t + reach);
  const int n = 80;
  const auto at = [&](double s) { return height_at(pass, end, point, s); };
  const auto place = [&](int i) { return from + (to - from) * i / n; };
  int best = 0;
  double least = at(from);
  double value = least;
  for (int i = 1; i <= n; ++i) {
    const double next = at(place(i));
    if (std::isinf(value) != std::isinf(next)) {
      double in = std::isinf(value) ? place(i) : place(i - 1);
      double out = std::isinf(value) ? place(i - 1) : place(i);
      for (int k = 0; k < 30; ++k) (std::isinf(at(0.5 * (in + out))) ? out : in) = 0.5 * (in + out);
      least = std::min(least, at(in));
    }
    if (next < least) {
      least = next;
      best = i;
    }
    value = next;
  }
  double low = place(std::max(0, best - 1));
  double high = place(std::min(n, best + 1));
  const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
  for (int i = 0; i < 22; ++i) {
    const double left = high - ratio * (high - low);
    const double right = low + ratio * (high - low);
    const double f_left = at(left);
    const double f_right = at(right);
    least = std::min({least, f_left, f_right});
    (f_left < f_right ? high : low) = f_left < f_right ? right : left;
  }
  return least;
}

struct Ridge {
  double u = 0.0, v = 0.0, height_mm = 0.0;
  int pass = 0;       ///< the later of the two passes
  bool edge = false;  ///< not between two passes, but on the last boundary, left by one
};

/// Ridges on the line t over the part: where neighbouring passes leave the same height, found by bisection,
/// and what the last pass leaves on the last boundary.
inline void ridges_on_line(const std::vector<SurfacePass>& passes, const ContactEnd& end, double t,
                           std::vector<Ridge>& ridges) {
  std::vector<const SurfacePass*> here;
  for (const SurfacePass& pass : passes)
    if (low_t(pass) <= t && t <= high_t(pass)) here.push_back(&pass);
  const bool along_u = passes.front().curve.along_u;
  const double start = here.front()->curve.w.at(t).w;
  const double forward = start < 0.5 ? 1.0 : -1.0;
  const double border = start < 0.5 ? 1.0 : 0.0;
  const auto add = [&](double w, double height, int pass, bool edge) {
    ridges.push_back({along_u ? t : w, along_u ? w : t, height, pass, edge});
  };
  for (size_t k = 0; k + 1 < here.size(); ++k) {
    const double w0 = here[k]->curve.w.at(t).w;
    const double w1 = here[k + 1]->curve.w.at(t).w;
    const auto left = [&](const SurfacePass& pass, double x) {
      return height_left(pass, end, design_point(pass, t, w0 + x * (w1 - w0)), t);
    };
    double low = 0.0;
    double high = 1.0;
    for (int i = 0; i < 24; ++i) {
      const double x = 0.5 * (low + high);
      (left(*here[k], x) < left(*here[k + 1], x) ? low : high) = x;
    }
    const double w = w0 + 0.5 * (low + high) * (w1 - w0);
    if ((w - border) * forward > 0.0) continue;
    // The lower pass of the two sides of the crossing, so that a jump at the rim does not count as covered.
    add(w,
        std::max(std::min(left(*here[k], low), left(*here[k + 1], low)),
                 std::min(left(*here[k], high), left(*here[k + 1], high))),
        here[k + 1]->pass, false);
  }
  const SurfacePass& last = *here.back();
  if ((last.curve.w.at(t).w - border) * forward < 0.0)
    add(border, height_left(last, end, design_point(last, t, border), t), last.pass, true);
}

inline std::vector<Ridge> ridges(const std::vector<SurfacePass>& passes, const ContactEnd& end, int lines) {
  std::vector<Ridge> found;
  for (int i = 0; i <= lines; ++i) ridges_on_line(passes, end, static_cast<double>(i) / lines, found);
  return found;
}

struct RidgeSummary {
  Ridge highest;        ///< edges included
  double p05_mm = 0.0;  ///< 5th percentile of the ridges between passes
};
inline RidgeSummary summary(const std::vector<Ridge>& ridges) {
  RidgeSummary result;
  std::vector<double> heights;
  for (const Ridge& ridge : ridges) {
    if (!(ridge.height_mm <= result.highest.height_mm)) result.highest = ridge;
    if (!ridge.edge) heights.push_back(ridge.height_mm);
  }
  std::sort(heights.begin(), heights.end());
  if (!heights.empty()) result.p05_mm = heights[heights.size() / 20];
  return result;
}

}  // namespace swarf::toolpath::test
