#include "flank/placement.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/check.h"
#include "base/minima.h"
#include "base/parallel.h"
#include "flank/chebyshev_fit.h"

namespace swarf::flank {
namespace {

struct Axis {
  Vec3 low, high;  ///< A0, A1
};

using surface::outward_normal;

/// A1's height above the tip.
double upper_height(const FlankTask& task, const Axis& axis) {
  return task.tip_below_mm + (axis.high - axis.low).norm();
}

/// Eq. 2; the radius at the upper curve depends on the length between both, which it changes little.
Axis published_axis(const FlankTask& task, double u, Vec3* N0 = nullptr, Vec3* N1 = nullptr) {
  const surface::Surface& S = *task.surface;
  const surface::Derivatives at0 = S.derivatives(u, 0.0), at1 = S.derivatives(u, 1.0);
  const Vec3 n0 = outward_normal(S, at0), n1 = outward_normal(S, at1);
  Axis axis{at0.S + ball_radius(task.profile, task.tip_below_mm) * n0, at1.S};
  axis.high += axis.low - at0.S;
  for (int i = 0; i < 40; ++i) {
    const Vec3 before = axis.high;
    axis.high = at1.S + ball_radius(task.profile, upper_height(task, axis)) * n1;
    if ((axis.high - before).norm() < 1e-14 * (1.0 + axis.high.norm())) break;
  }
  if (N0 != nullptr) *N0 = n0;
  if (N1 != nullptr) *N1 = n1;
  return axis;
}

/// Share of the way from A0 to A1 where the flank begins: the tip may end above guide curve 0.
double first_share(const FlankTask& task, const Axis& axis) {
  const double length = (axis.high - axis.low).norm();
  return std::clamp((task.profile.low - task.tip_below_mm) / length, 0.0, 1.0);
}

struct Sample {
  double share = 0.0;  ///< from A0 to A1
  double error = 0.0;
  Foot foot;
};
using Samples = std::array<Sample, kErrorPlaces>;

Sample sample_at(const FlankTask& task, const Axis& axis, double u, double share) {
  Sample sample;
  sample.share = share;
  const double c = task.tip_below_mm + share * (axis.high - axis.low).norm();
  sample.foot = foot_of(*task.surface, axis.low + share * (axis.high - axis.low), u, share);
  sample.error = sample.foot.distance_mm - ball_radius(task.profile, c);
  return sample;
}

/// At the places of Chebyshev's extremes: both ends are among them.
Samples samples_of(const FlankTask& task, const Axis& axis, double u) {
  Samples samples;
  const double first = first_share(task, axis);
  for (int i = 0; i < kErrorPlaces; ++i) {
    const double s = 0.5 - 0.5 * std::cos(M_PI * i / (kErrorPlaces - 1));
    samples[static_cast<size_t>(i)] = sample_at(task, axis, u, first + s * (1.0 - first));
  }
  return samples;
}

/// What the two lifts along the normals and the turn change: de / dx at a sample.
Shift slopes_at(const FlankTask& task, const Sample& sample, const std::array<Vec3, 3>& moves,
                const Axis& axis) {
  const Vec3 a = (axis.high - axis.low).normalized();
  const double c = task.tip_below_mm + sample.share * (axis.high - axis.low).norm();
  const double radius_slope = ball_slope(task.profile, c);
  const double s = sample.share;
  const auto moved = [&](const Vec3& low, const Vec3& high) {
    const double longer = s * (high - low).dot(a);
    return sample.foot.normal.dot((1.0 - s) * low + s * high) - radius_slope * longer;
  };
  return {moved(moves[0], Vec3::Zero()), moved(Vec3::Zero(), moves[1]), moved(-moves[2], moves[2])};
}

/// From the published axis to the best one by linear steps; the errors bend little over such shifts.
Axis best_axis(const FlankTask& task, double u, int unknowns) {
  Vec3 N0, N1;
  Axis axis = published_axis(task, u, &N0, &N1);
  const Vec3 ruling = (axis.high - axis.low).normalized();
  const std::array<Vec3, 3> moves{N0, N1, ruling.cross(N0 + N1).normalized()};
  // Without twist the turn moves nothing and is left out.
  constexpr double kTwisted = 1e-5;
  if (N0.cross(N1).norm() < kTwisted) unknowns = std::min(unknowns, 2);
  for (int step = 0; step < 12; ++step) {
    const Samples samples = samples_of(task, axis, u);
    std::array<double, kErrorPlaces> errors{};
    std::array<Shift, kErrorPlaces> slopes{};
    for (size_t j = 0; j < samples.size(); ++j) {
      errors[j] = samples[j].error;
      slopes[j] = slopes_at(task, samples[j], moves, axis);
    }
    Shift x = least_maximum(errors, slopes, unknowns);
    if (unknowns < 3) x[2] = 0.0;
    axis.low += x[0] * moves[0] - x[2] * moves[2];
    axis.high += x[1] * moves[1] + x[2] * moves[2];
    if (std::abs(x[0]) + std::abs(x[1]) + std::abs(x[2]) < 1e-11) break;
  }
  return axis;
}

Axis axis_of(const FlankTask& task, double u) {
  Axis axis = task.placement == Placement::kPublished
                  ? published_axis(task, u)
                  : best_axis(task, u, task.placement == Placement::kBalanced ? 2 : 3);
  const surface::Surface& S = *task.surface;
  if (task.lift_low_mm != 0.0) axis.low += task.lift_low_mm * outward_normal(S, S.derivatives(u, 0.0));
  if (task.lift_high_mm != 0.0) axis.high += task.lift_high_mm * outward_normal(S, S.derivatives(u, 1.0));
  return axis;
}

/// The extreme of the parabola through three samples, where it lies between them.
double refined(const FlankTask& task, const Axis& axis, double u, const Samples& samples, size_t i,
               double* share) {
  *share = samples[i].share;
  if (i == 0 || i + 1 == samples.size()) return samples[i].error;
  const Sample &a = samples[i - 1], &b = samples[i], &c = samples[i + 1];
  const double h0 = b.share - a.share, h1 = c.share - b.share;
  if (h0 <= 0.0 || h1 <= 0.0) return b.error;
  const double d0 = (b.error - a.error) / h0, d1 = (c.error - b.error) / h1;
  if (d0 * d1 >= 0.0) return b.error;
  const double slope = (d0 * h1 + d1 * h0) / (h0 + h1), bend = 2.0 * (d1 - d0) / (h0 + h1);
  *share = std::clamp(b.share - slope / bend, a.share, c.share);
  return sample_at(task, axis, u, *share).error;
}

}  // namespace

const char* placement_name(Placement placement) {
  switch (placement) {
    case Placement::kPublished:
      return "published";
    case Placement::kBalanced:
      return "balanced";
    case Placement::kMinimax:
      return "minimax";
  }
  return "unknown";
}

std::vector<std::string> placement_names() {
  return {"published", "balanced", "minimax"};
}

Foot foot_of(const surface::Surface& surface, const Vec3& x, double u, double v) {
  surface::Derivatives d = surface.derivatives(u, v);
  for (int i = 0; i < 20; ++i) {
    const Vec3 r = d.S - x;
    const double a = d.Su.dot(d.Su) + r.dot(d.Suu), b = d.Su.dot(d.Sv) + r.dot(d.Suv),
                 c = d.Sv.dot(d.Sv) + r.dot(d.Svv);
    const double g = d.Su.dot(r), h = d.Sv.dot(r), det = a * c - b * b;
    // Where the square of the distance does not bend upwards: the step of Gauss and Newton.
    const bool bowl = a > 0.0 && det > 0.0;
    const double E = d.Su.dot(d.Su), F = d.Su.dot(d.Sv), G = d.Sv.dot(d.Sv), square = E * G - F * F;
    const double du = bowl ? -(c * g - b * h) / det : -(G * g - F * h) / square;
    const double dv = bowl ? -(a * h - b * g) / det : -(E * h - F * g) / square;
    u += du;
    v += dv;
    d = surface.derivatives(u, v);
    if (std::abs(du) + std::abs(dv) < 1e-13) break;
  }
  Foot foot;
  foot.u = u;
  foot.v = v;
  foot.normal = outward_normal(surface, d);
  foot.distance_mm = (x - d.S).dot(foot.normal);
  return foot;
}

ToolPose pose_at(const FlankTask& task, double u) {
  const Axis axis = axis_of(task, u);
  const Vec3 a = (axis.high - axis.low).normalized();
  return {axis.low - task.tip_below_mm * a, a};
}

AxisError axis_error(const FlankTask& task, const ToolPose& pose, double u) {
  const double length = (published_axis(task, u).high - published_axis(task, u).low).norm();
  const Vec3 low = pose.tip_W + task.tip_below_mm * pose.axis_W;
  const Axis axis{low, low + length * pose.axis_W};
  const Samples samples = samples_of(task, axis, u);
  AxisError found;
  size_t least = 0, greatest = 0;
  for (size_t i = 1; i < samples.size(); ++i) {
    if (samples[i].error < samples[least].error) least = i;
    if (samples[i].error > samples[greatest].error) greatest = i;
  }
  found.least_mm = refined(task, axis, u, samples, least, &found.least_v);
  found.greatest_mm = refined(task, axis, u, samples, greatest, &found.greatest_v);
  return found;
}

double twist_bound(const FlankTask& task, double u) {
  Vec3 N0, N1;
  const Axis axis = published_axis(task, u, &N0, &N1);
  const double r0 = ball_radius(task.profile, task.tip_below_mm);
  const double r1 = ball_radius(task.profile, upper_height(task, axis));
  // (r0 + r1 - |r0 N0 + r1 N1|) / 2 without cancellation.
  const double turned = 2.0 * r0 * r1 * (1.0 - N0.dot(N1));
  return 0.5 * turned / (r0 + r1 + (r0 * N0 + r1 * N1).norm());
}

WorstError worst_error(const FlankTask& task) {
  constexpr size_t kRulings = 257;
  const auto error_at = [&](double u) { return axis_error(task, pose_at(task, u), u); };
  std::vector<AxisError> errors(kRulings);
  parallel_chunks(kRulings, 8, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const double u = static_cast<double>(i) / (kRulings - 1);
      errors[i] = error_at(u);
    }
  });
  WorstError worst;
  const auto take = [&](const AxisError& e, double u) {
    if (e.most_mm() <= std::abs(worst.mm)) return;
    const bool deep = -e.least_mm >= e.greatest_mm;
    worst = {deep ? e.least_mm : e.greatest_mm, u, deep ? e.least_v : e.greatest_v};
  };
  size_t most = 0;
  for (size_t i = 0; i < kRulings; ++i) {
    take(errors[i], static_cast<double>(i) / (kRulings - 1));
    if (errors[i].most_mm() > errors[most].most_mm()) most = i;
  }
  // The crest between the neighbours of the worst.
  const double step = 1.0 / (kRulings - 1), u = static_cast<double>(most) * step;
  const Minimum crest = least_between([&](double x) { return -error_at(x).most_mm(); },
                                      std::max(0.0, u - step), std::min(1.0, u + step));
  take(error_at(crest.at), crest.at);
  return worst;
}

}  // namespace swarf::flank
