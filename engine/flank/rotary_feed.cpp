#include "flank/rotary_feed.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "base/minima.h"

namespace swarf::flank {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
/// Second derivatives by central differences of the first ones, in u.
constexpr double kStep = 1e-5;

/// rad per mm of the tip's way.
double c_rate(const surface::Surface& surface, double u) {
  const surface::Derivatives d = surface.derivatives(u, 0.0);
  const Vec3 &R = d.Sv, &dR = d.Suv;
  return (R.x() * dR.y() - R.y() * dR.x()) / (R.head<2>().squaredNorm() * d.Su.norm());
}

double a_rate(const surface::Surface& surface, double u) {
  const surface::Derivatives d = surface.derivatives(u, 0.0);
  const Vec3 &R = d.Sv, &dR = d.Suv;
  const double across = R.head<2>().norm();
  const double widening = across > 0.0 ? R.head<2>().dot(dR.head<2>()) / across : dR.head<2>().norm();
  return (widening * R.z() - across * dR.z()) / (R.squaredNorm() * d.Su.norm());
}

using Rate = std::function<double(double u)>;

RotaryFeed feed_of(const surface::Surface& surface, double u, const RotaryLimit& limit, const Rate& rate) {
  const double low = std::max(0.0, u - kStep), high = std::min(1.0, u + kStep);
  const double bend =
      std::abs(rate(high) - rate(low)) / ((high - low) * surface.derivatives(u, 0.0).Su.norm());
  const double slope = std::abs(rate(u));
  return {slope > 0.0 ? limit.speed / slope : kNone,
          bend > 0.0 ? std::sqrt(limit.acceleration / bend) : kNone};
}

}  // namespace

RotaryFeed c_limited_feed(const surface::Surface& surface, double u, const RotaryLimit& limit) {
  return feed_of(surface, u, limit, [&](double x) { return c_rate(surface, x); });
}

RotaryFeed a_limited_feed(const surface::Surface& surface, double u, const RotaryLimit& limit) {
  return feed_of(surface, u, limit, [&](double x) { return a_rate(surface, x); });
}

FeedLow least_c_feed(const surface::Surface& surface, const RotaryLimit& limit) {
  constexpr int kPlaces = 512;
  const Minimum fastest =
      greatest_sampled([&](double u) { return std::abs(c_rate(surface, u)); }, 0.0, 1.0, kPlaces);
  return {fastest.value > 0.0 ? limit.speed / fastest.value : kNone, fastest.at};
}

}  // namespace swarf::flank
