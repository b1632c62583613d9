// highest_left(): what the sets that hold no material leave over a cell (height_bounds.h).
#include <algorithm>
#include <cmath>

#include "measure/height_bounds.h"

namespace swarf::measure {
namespace {

/// No greater, and the squares of the sides of a triangle: then their sum over pairs is concave.
CornerHeights as_squares(CornerHeights sags) {
  const size_t most = static_cast<size_t>(std::max_element(sags.begin(), sags.end()) - sags.begin());
  const double others = std::sqrt(sags[(most + 1) % 3]) + std::sqrt(sags[(most + 2) % 3]);
  sags[most] = std::min(sags[most], others * others);
  return sags;
}

bool is_nowhere_higher(const CornerHeights& a, const CornerHeights& b) {
  return a[0] <= b[0] && a[1] <= b[1] && a[2] <= b[2];
}

/// Those that cover every corner, without those that count nowhere beside another.
std::vector<const CornerHeights*> lowest_of(const std::vector<CornerHeights>& sets) {
  std::vector<const CornerHeights*> lowest;
  lowest.reserve(sets.size());
  for (const CornerHeights& set : sets) {
    if (!(set[0] < kNever && set[1] < kNever && set[2] < kNever)) continue;
    const auto counts_nowhere = [&](const CornerHeights* other) { return is_nowhere_higher(*other, set); };
    if (std::any_of(lowest.begin(), lowest.end(), counts_nowhere)) continue;
    std::erase_if(lowest, [&](const CornerHeights* other) { return is_nowhere_higher(set, *other); });
    lowest.push_back(&set);
  }
  return lowest;
}

}  // namespace

HighestLeft highest_left(const std::vector<CornerHeights>& sets, CornerHeights sags) {
  const std::vector<const CornerHeights*> whole = lowest_of(sets);
  if (whole.empty()) return {};
  HighestLeft highest{-kNever};
  sags = as_squares(sags);
  // The maximum of a function that is linear, or convex, in pieces stands at a corner of the pieces: a corner
  // of the cell, a place on an edge where two sets cross, or one inside where three do.
  const auto look_at = [&](const Vec3& l) {
    if (l.minCoeff() < -1e-12) return;
    double low = kNever;
    for (const CornerHeights* set : whole)
      low = std::min(low, l.x() * (*set)[0] + l.y() * (*set)[1] + l.z() * (*set)[2]);
    low -= 2.0 * (l.x() * l.y() * sags[0] + l.y() * l.z() * sags[1] + l.z() * l.x() * sags[2]);
    if (low > highest.height) highest = {low, l};
  };
  for (int k = 0; k < 3; ++k) look_at(Vec3::Unit(k));
  for (size_t a = 0; a < whole.size(); ++a) {
    for (size_t b = 0; b < a; ++b) {
      const Vec3 d((*whole[a])[0] - (*whole[b])[0], (*whole[a])[1] - (*whole[b])[1],
                   (*whole[a])[2] - (*whole[b])[2]);
      for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3;
        if (d[k] * d[i] >= 0.0) continue;
        Vec3 l = Vec3::Zero();
        l[i] = d[k] / (d[k] - d[i]);
        l[k] = 1.0 - l[i];
        look_at(l);
      }
      for (size_t c = 0; c < b; ++c) {
        const Vec3 e((*whole[a])[0] - (*whole[c])[0], (*whole[a])[1] - (*whole[c])[1],
                     (*whole[a])[2] - (*whole[c])[2]);
        const Vec3 l = d.cross(e);
        const double sum = l.sum();
        if (sum != 0.0) look_at(l / sum);
      }
    }
  }
  return highest;
}

}  // namespace swarf::measure
