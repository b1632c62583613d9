#include "proof/missing_bound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "collision/convex_distance.h"

namespace swarf::proof {
namespace {

using Corners = std::array<Vec3, 3>;

Vec3 middle_of(const Corners& c) {
  return (c[0] + c[1] + c[2]) / 3.0;
}

double reach_of(const Corners& c, const Vec3& middle) {
  return std::max({(c[0] - middle).norm(), (c[1] - middle).norm(), (c[2] - middle).norm()});
}

collision::ConvexView view_of(const Corners& c) {
  collision::ConvexView view;
  for (size_t k = 0; k < 3; ++k) view.corners[k] = view.home[k] = c[k];
  return view;
}

/// Whether all corners of one lie beyond a plane of the other.
bool lies_beyond(const Corners& one, const Vec3& normal, double plane) {
  return std::all_of(one.begin(), one.end(), [&](const Vec3& p) { return normal.dot(p) > plane; });
}

struct DeepPlace {
  double depth_mm = 0.0;
  Vec3 place = Vec3::Zero();
  double bound_mm = 0.0;  ///< nothing of the facet is deeper
};

class MissingSearch {
 public:
  explicit MissingSearch(const MissingQuestion& in) : in_(in) {}

  MissingBound run() const {
    std::vector<uint32_t> all(in_.raw.triangles.size());
    for (uint32_t n = 0; n < all.size(); ++n) all[n] = n;
    constexpr double kFirstShare = 0.1;
    const double low = kFirstShare * in_.limit_mm, high = in_.limit_mm;
    std::vector<uint32_t> blocked = blocked_at(low, all);
    MissingBound result;
    result.bound_mm = low;
    if (blocked.empty()) return result;
    result.place = middle_of(corners_of(blocked.front()));
    const std::vector<uint32_t> beyond = blocked_at(high, blocked);
    if (!beyond.empty()) {
      if (beyond.size() < blocked.size()) result.bound_mm = high;  // of those that are clear there
      look_for_deepest(beyond, result);
      return result;
    }
    result.bound_mm = narrowed(low, high, std::move(blocked), result.place);
    return result;
  }

 private:
  /// All of `blocked` are clear at `high`, not at `low`: the least depth between at which all are.
  double narrowed(double low, double high, std::vector<uint32_t> blocked, Vec3& place) const {
    constexpr double kShare = 0.01;
    while (high - low > kShare * high && !in_.progress.stop_requested()) {
      const double middle = 0.5 * (low + high);
      std::vector<uint32_t> still = blocked_at(middle, blocked);
      if (still.empty()) {
        high = middle;
        continue;
      }
      low = middle;
      blocked = std::move(still);
      place = middle_of(corners_of(blocked.front()));
    }
    return high;
  }

  Corners corners_of(uint32_t facet) const {
    Corners c;
    for (size_t k = 0; k < 3; ++k) {
      const auto& p = in_.raw.positions[in_.raw.triangles[facet][k]];
      c[k] = Vec3(p[0], p[1], p[2]);
    }
    return c;
  }

  /// Those of the facets that are not clear of the design when they move by no more than g.
  std::vector<uint32_t> blocked_at(double g_mm, const std::vector<uint32_t>& facets) const {
    constexpr size_t kFacetsPerTask = 64;
    std::vector<uint8_t> is_blocked(facets.size(), 1);
    parallel_chunks(facets.size(), kFacetsPerTask, [&](size_t begin, size_t end) {
      if (in_.progress.stop_requested()) return;
      std::vector<uint32_t> near;
      for (size_t i = begin; i < end; ++i) is_blocked[i] = is_clear(facets[i], g_mm, near) ? 0 : 1;
    });
    std::vector<uint32_t> blocked;
    for (size_t i = 0; i < facets.size(); ++i)
      if (is_blocked[i] != 0) blocked.push_back(facets[i]);
    return blocked;
  }

  bool is_clear(uint32_t facet, double g_mm, std::vector<uint32_t>& near) const {
    const Corners c = corners_of(facet);
    const Vec3 across = (c[1] - c[0]).cross(c[2] - c[0]), middle = middle_of(c);
    const double area = across.norm(), reach = reach_of(c, middle);
    if (!(area > 0.0)) return true;  // its neighbours hold its points
    // Out, and towards its middle: both together are g.
    for (const double out : {0.999, 0.7}) {
      const double in = std::sqrt(1.0 - out * out), share = 1.0 - std::min(1.0, in * g_mm / reach);
      const Vec3 step = out * g_mm / area * across;
      Corners moved;
      for (size_t k = 0; k < 3; ++k) moved[k] = middle + share * (c[k] - middle) + step;
      if (is_apart(moved, across / area, near)) return true;
    }
    return false;
  }

  /// Whether a triangle lies outside the design without touching it.
  bool is_apart(const Corners& moved, const Vec3& normal, std::vector<uint32_t>& near) const {
    if (in_.design.distance().at(middle_of(moved)).distance_mm < 0.0) return false;
    const Box box{moved[0].cwiseMin(moved[1]).cwiseMin(moved[2]),
                  moved[0].cwiseMax(moved[1]).cwiseMax(moved[2])};
    near.clear();
    in_.design.find(box, near);
    return std::all_of(near.begin(), near.end(), [&](uint32_t n) {
      const mesh::SignedDistance& design = in_.design.distance();
      const Corners other{design.corner(n, 0), design.corner(n, 1), design.corner(n, 2)};
      const Vec3& out = design.face_normal(n);
      return lies_beyond(moved, out, out.dot(other[0])) ||
             lies_beyond(other, -normal, -normal.dot(moved[0])) ||
             collision::convex_distance(view_of(moved), view_of(other), 0.0).lower > 0.0;
    });
  }

  /// Facets are divided where they may be deepest.
  DeepPlace deepest_of(uint32_t facet) const {
    struct Part {
      double most;
      Corners corners;
      bool operator<(const Part& other) const { return most < other.most; }
    };
    constexpr int kMostParts = 4000;
    constexpr double kShare = 1e-3, kLeast = 1e-5;
    DeepPlace best;
    std::priority_queue<Part> open;
    const auto add = [&](const Corners& c) {
      const Vec3 middle = middle_of(c);
      const double depth = -in_.design.distance().at(middle).distance_mm;
      if (depth > best.depth_mm) best = {depth, middle};
      open.push({depth + reach_of(c, middle), c});  // depths differ by no more than places lie apart
    };
    add(corners_of(facet));
    for (int i = 0; i < kMostParts; ++i) {
      const Part part = open.top();
      if (part.most <= best.depth_mm * (1.0 + kShare) + kLeast) break;
      open.pop();
      const Corners& c = part.corners;
      const Vec3 a = 0.5 * (c[0] + c[1]), b = 0.5 * (c[1] + c[2]), d = 0.5 * (c[2] + c[0]);
      for (const Corners& piece :
           {Corners{c[0], a, d}, Corners{a, c[1], b}, Corners{d, b, c[2]}, Corners{a, b, d}})
        add(piece);
    }
    best.bound_mm = open.top().most;
    return best;
  }

  /// Bounds of facets that are clear at a greater depth are lowered to it.
  void lower_bounds(const std::vector<uint32_t>& facets, std::vector<DeepPlace>& deep) const {
    constexpr double kStep = 1.2;
    parallel_chunks(facets.size(), 1, [&](size_t i, size_t) {
      std::vector<uint32_t> found;
      for (double g = kStep * in_.limit_mm; g < deep[i].bound_mm; g *= kStep)
        if (is_clear(facets[i], g, found)) deep[i].bound_mm = g;
    });
  }

  void look_for_deepest(const std::vector<uint32_t>& facets, MissingBound& result) const {
    std::vector<DeepPlace> deep(facets.size());
    parallel_chunks(facets.size(), 1, [&](size_t begin, size_t) {
      if (!in_.progress.stop_requested()) deep[begin] = deepest_of(facets[begin]);
    });
    lower_bounds(facets, deep);
    for (const DeepPlace& one : deep) {
      result.bound_mm = std::max(result.bound_mm, one.bound_mm);
      if (!(one.depth_mm > result.found_mm)) continue;
      result.found_mm = one.depth_mm;
      result.place = one.place;
      result.foot = in_.design.distance().at(one.place).foot;
    }
  }

  const MissingQuestion& in_;
};

}  // namespace

MissingBound bound_missing(const MissingQuestion& question) {
  return MissingSearch(question).run();
}

}  // namespace swarf::proof
