#include "mesh/field_line.h"

#include <algorithm>
#include <cmath>

namespace swarf::mesh {
namespace {

/// Evenly, about so far apart, mm, and no more than so many.
constexpr double kEven = 2.0;
constexpr int kEvenLeast = 3, kEvenMost = 6;
constexpr double kShort = 1.0;  // mm: one place, in the middle
/// From a crease: the first place, mm, and each next one so many times as far.
constexpr double kFirst = 4e-3, kTimes = 4.0;

using KnownPlace = std::pair<double, float>;

/// Where two lines meet, each through two places; outside of everything when they are parallel.
double meeting(const KnownPlace& a, const KnownPlace& b, const KnownPlace& c, const KnownPlace& d) {
  const double left = (double{b.second} - double{a.second}) / (b.first - a.first);
  const double right = (double{d.second} - double{c.second}) / (d.first - c.first);
  if (std::abs(left - right) < 1e-12) return -1.0;
  return (double{c.second} - right * c.first - double{a.second} + left * a.first) / (left - right);
}

/// With the kinks: where the pieces before and after a gap between places meet. Beside an end, where no piece
/// is known, the field may be even.
std::vector<KnownPlace> with_kinks(const std::vector<KnownPlace>& line) {
  std::vector<KnownPlace> out{line.front()};
  for (size_t i = 1; i < line.size(); ++i) {
    const KnownPlace &b = line[i - 1], &c = line[i];
    const KnownPlace a = i >= 2 ? line[i - 2] : KnownPlace{b.first - 1.0, b.second};
    const KnownPlace d = i + 1 < line.size() ? line[i + 1] : KnownPlace{c.first + 1.0, c.second};
    const double t = meeting(a, b, c, d);
    const double slope = (double{b.second} - double{a.second}) / (b.first - a.first);
    if (t > b.first && t < c.first)
      out.emplace_back(t, static_cast<float>(double{b.second} + slope * (t - b.first)));
    out.push_back(c);
  }
  return out;
}

/// With the places where the line reaches +-`level`.
std::vector<KnownPlace> with_crossings(const std::vector<KnownPlace>& line, double level) {
  std::vector<KnownPlace> out;
  for (const KnownPlace& next : line) {
    if (!out.empty()) {
      const KnownPlace last = out.back();
      const double rise = double{next.second} - double{last.second};
      const double first = rise > 0.0 ? -level : level;
      for (const double at : {first, -first}) {
        const double share = (at - double{last.second}) / rise;
        if (share > 0.0 && share < 1.0)
          out.emplace_back(last.first + share * (next.first - last.first), static_cast<float>(at));
      }
    }
    out.push_back(next);
  }
  return out;
}

}  // namespace

std::vector<double> places_on_side(double length_mm, bool crease_at_0, bool crease_at_1) {
  const int even = static_cast<int>(std::lround(length_mm / kEven));
  const int count = length_mm < kShort ? 1 : std::clamp(even, kEvenLeast, kEvenMost);
  std::vector<double> places;
  for (int i = 1; i <= count; ++i) places.push_back(static_cast<double>(i) / (count + 1));
  const double first = places.front();
  // A short side from crease to crease mostly runs along one.
  const bool along = crease_at_0 && crease_at_1 && length_mm < kEven;
  for (double t = kFirst / length_mm; !along && t < 0.8 * first; t *= kTimes) {
    if (crease_at_0) places.push_back(t);
    if (crease_at_1) places.push_back(1.0 - t);
  }
  std::sort(places.begin(), places.end());
  return places;
}

FieldLine::Knots FieldLine::knots(float first, float last, double saturates, double apart, double enough,
                                  const std::function<double(float, float, double, float)>& error) const {
  std::vector<KnownPlace> line{{0.0, first}};
  for (const KnownPlace& one : places_)
    if (!std::isnan(one.second)) line.push_back(one);
  line.emplace_back(1.0, last);
  line = with_crossings(with_kinks(line), saturates);
  Knots found;
  std::vector<std::pair<size_t, size_t>> open{{0, line.size() - 1}};
  while (!open.empty()) {
    const auto [low, high] = open.back();
    open.pop_back();
    double worst = 0.0;
    size_t at = low;
    for (size_t i = low + 1; i < high; ++i) {
      const double t = (line[i].first - line[low].first) / (line[high].first - line[low].first);
      const double here = error(line[low].second, line[high].second, t, line[i].second);
      if (here > worst) {
        worst = here;
        at = i;
      }
    }
    found.worst = std::max(found.worst, worst);
    if (worst <= enough) continue;
    const double knot = line[at].first;
    if (knot >= apart && knot <= 1.0 - apart) found.at.push_back(knot);
    open.emplace_back(low, at);
    open.emplace_back(at, high);
  }
  std::sort(found.at.begin(), found.at.end());
  size_t kept = 0;
  for (const double knot : found.at)
    if (kept == 0 || knot - found.at[kept - 1] >= apart) found.at[kept++] = knot;
  found.at.resize(kept);
  return found;
}

}  // namespace swarf::mesh
