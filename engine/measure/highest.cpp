#include "measure/highest.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/parallel.h"
#include "measure/column_range.h"

namespace swarf::measure {
namespace {

constexpr int kSide = 6;
constexpr double kPeakReach = 2.0;  // of the pitch
/// Of the pitch, half a side: all places go down to the second, the most promising to the last.
constexpr double kFirstSquare = 1.0, kPromising = 0.2, kLastSquare = 5e-5;
constexpr size_t kPromisingPlaces = 6;
constexpr int kMostSquares = 64;
/// Of half a side: farther from the middle the best ray may not be the best of all.
constexpr double kInner = 0.75;

/// A ray of a square.
struct Candidate {
  Vec2 at;  ///< displacement of its foot in the tangent plane of the first ray, mm
  stock::Foot foot;
};

/// Material that ends at `high`, and where the gap below it ends.
struct LeftOver {
  double low, high;
  size_t ray;
  uint32_t block;
};

class PeakSearch {
 public:
  PeakSearch(const stock::RayField& field, uint32_t ray, const PeakInput& input)
      : field_(field), ray_(ray), in_(input) {
    int least = 0;
    field.normals[ray].cwiseAbs().minCoeff(&least);
    e1_ = field.normals[ray].cross(Vec3::Unit(least)).normalized();
    e2_ = field.normals[ray].cross(e1_);
  }

  /// Goes on with ever smaller squares, down to this half side in pitches.
  void narrow_to(double last) {
    if (left_ == kMostSquares) look_at({{Vec2::Zero(), {field_.points[ray_], field_.normals[ray_]}}});
    while (half_ > last * field_.pitch_mm && left_-- > 0) {
      const Vec2 middle = at_;
      const bool better = look_at(square(middle, half_));
      if (!better || (at_ - middle).cwiseAbs().maxCoeff() <= kInner * half_) half_ *= 0.5;
    }
  }
  const Peak& peak() const { return peak_; }

 private:
  std::vector<Candidate> square(const Vec2& middle, double half) const {
    std::vector<Candidate> rays;
    for (int i = 0; i < kSide; ++i) {
      for (int j = 0; j < kSide; ++j) {
        const Vec2 at = middle + half * (2.0 / (kSide - 1) * Vec2(i, j) - Vec2::Ones());
        if (at.norm() > kPeakReach * field_.pitch_mm) continue;
        const auto foot = field_.displaced(ray_, at.x() * e1_ + at.y() * e2_);
        if (foot) rays.push_back({at, *foot});
      }
    }
    return rays;
  }

  /// Takes over the highest of the rays, if one is higher than all before.
  bool look_at(const std::vector<Candidate>& rays) {
    std::vector<LeftOver> left_over = left_over_of(rays);
    std::sort(left_over.begin(), left_over.end(), [](const LeftOver& a, const LeftOver& b) {
      return a.high != b.high ? a.high > b.high : a.ray < b.ray;
    });
    bool better = false;
    for (const LeftOver& one : left_over) {
      if (!(one.high > peak_.height_mm)) break;
      const stock::Foot& foot = rays[one.ray].foot;
      const double own = own_height(foot, one.high);
      if (!(own > std::max(one.low, peak_.height_mm))) continue;
      peak_ = {own, foot.point, foot.point + own * foot.normal, one.block};
      at_ = rays[one.ray].at;
      better = true;
    }
    return better;
  }

  /// As much of a height as is the foot's: no more than the design is away where another face ends it.
  double own_height(const stock::Foot& foot, double height_mm) const {
    const double own = field_.own_depth(foot.point, -foot.normal, height_mm);
    if (field_.design == nullptr || own >= height_mm) return own;
    return std::min(own, field_.design->nearest(foot.point + own * foot.normal).distance_mm);
  }

  /// No raw material stands higher over a place; mm.
  double last_material(const Vec3& point, const Vec3& normal) const {
    const Box& box = in_.material.raw.box();
    const double leaves = leaves_box(box, point, normal);
    // From outside the column may still come into it.
    const double farthest = (point - 0.5 * (box.lower + box.upper)).norm() + 0.5 * box.size().norm();
    return leaves > -kNever ? std::max(0.0, leaves) : farthest;
  }

  /// What is left over each of the rays.
  std::vector<LeftOver> left_over_of(const std::vector<Candidate>& rays) const {
    std::vector<LeftOver> found;
    if (rays.empty()) return found;
    const stock::SurfaceDexels dexels = cut_rays(rays);
    for (size_t n = 0; n < rays.size(); ++n)
      found.push_back({-kNever, dexels.heights_mm()[n], n, dexels.blocks()[n]});
    dexels.each_above([&](uint32_t n, const stock::MaterialAbove& m) {
      if (m.high - m.low < stock::kSliver) return;
      found.push_back({m.low, m.high, n, m.high_block != stock::kUncut ? m.high_block : m.low_block});
    });
    return found;
  }

  /// Rays when all sweeps have cut them. Thousands of cutters stand over a column, and few come down to what
  /// is left of it: these cut first, and where that is all below their tops the others meet nothing.
  stock::SurfaceDexels cut_rays(const std::vector<Candidate>& rays) const {
    std::vector<Vec3> points, normals;
    std::vector<double> ranges;
    for (const Candidate& ray : rays) {
      points.push_back(ray.foot.point);
      normals.push_back(ray.foot.normal);
      ranges.push_back(in_.material.ranges(ray.foot.point, ray.foot.normal).mm);
    }
    const stock::RayFieldPtr field =
        stock::rays_at(std::move(points), std::move(normals), field_.design, field_.pitch_mm);
    const stock::SurfaceDexels uncut(field, in_.material.raw, ranges);
    stock::SurfaceDexels dexels = uncut;
    constexpr double kMore = 1.5, kLeast = 0.1;  // than the highest so far; of the pitch
    const double top = kMore * peak_.height_mm + kLeast * field_.pitch_mm;
    std::vector<uint32_t> near;
    in_.index.find_below(columns_of(*field, top), box_of(*field, [&](size_t) { return top; }), near);
    cut(dexels, near);
    if (all_below(dexels, top)) return dexels;
    dexels = uncut;
    near.clear();
    const auto last = [&](size_t n) {
      return std::min(ranges[n], last_material(field->points[n], field->normals[n]));
    };
    in_.index.find(box_of(*field, last), near);
    cut(dexels, near);
    return dexels;
  }

  static bool all_below(const stock::SurfaceDexels& dexels, double top) {
    constexpr double kRounding = 1e-6;  // mm
    bool above = false;
    dexels.each_above([&](uint32_t, const stock::MaterialAbove&) { above = true; });
    return !above && std::all_of(dexels.heights_mm().begin(), dexels.heights_mm().end(),
                                 [&](double height) { return height < top - kRounding; });
  }

  static Columns columns_of(const stock::RayField& field, double top) {
    const auto top_of = [&](size_t n) -> Vec3 { return field.points[n] + top * field.normals[n]; };
    Columns columns{top_of(0), field.normals[0]};
    for (size_t n = 1; n < field.size(); ++n) {
      columns.top_spread = std::max(columns.top_spread, (top_of(n) - columns.top).norm());
      columns.normal_spread = std::max(columns.normal_spread, (field.normals[n] - columns.normal).norm());
    }
    return columns;
  }

  /// Around the rays from their skin up to `top(n)`, mm.
  template <typename Top>
  static Box box_of(const stock::RayField& field, const Top& top) {
    Box box{Vec3::Constant(kNever), Vec3::Constant(-kNever)};
    for (size_t n = 0; n < field.size(); ++n) {
      const Vec3 &p = field.points[n], &normal = field.normals[n];
      for (const Vec3& end : {Vec3(p - stock::kSkin * normal), Vec3(p + top(n) * normal)}) {
        box.lower = box.lower.cwiseMin(end);
        box.upper = box.upper.cwiseMax(end);
      }
    }
    return box;
  }

  void cut(stock::SurfaceDexels& dexels, const std::vector<uint32_t>& near) const {
    std::vector<stock::Sweep> sweeps;
    for (size_t begin = 0, end = 0; begin < near.size(); begin = end) {
      const stock::CutterSolid& cutter = in_.cutters[near[begin]];
      sweeps.clear();
      for (; end < near.size() && &in_.cutters[near[end]] == &cutter; ++end)
        sweeps.push_back(in_.sweeps[near[end]]);
      dexels.cut(sweeps, cutter);
    }
  }

  const stock::RayField& field_;
  uint32_t ray_;
  const PeakInput& in_;
  Vec3 e1_, e2_;
  Peak peak_;
  Vec2 at_ = Vec2::Zero();
  double half_ = kFirstSquare * field_.pitch_mm;
  int left_ = kMostSquares;  ///< squares
};

}  // namespace

std::vector<Peak> find_peaks(const stock::RayField& field, std::span<const uint32_t> rays,
                             const PeakInput& input) {
  std::vector<PeakSearch> searches;
  for (const uint32_t ray : rays) searches.emplace_back(field, ray, input);
  std::vector<size_t> order(rays.size());
  std::iota(order.begin(), order.end(), size_t{0});
  const auto narrow = [&](size_t count, double last) {
    parallel_chunks(count, 1, [&](size_t begin, size_t) { searches[order[begin]].narrow_to(last); });
  };
  narrow(order.size(), kPromising);
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return searches[a].peak().height_mm > searches[b].peak().height_mm;
  });
  narrow(std::min(kPromisingPlaces, order.size()), kLastSquare);
  std::vector<Peak> peaks;
  for (const PeakSearch& search : searches) peaks.push_back(search.peak());
  return peaks;
}

std::vector<uint32_t> highest_rays(const stock::RayField& field, std::span<const double> tops_mm,
                                   size_t most) {
  std::vector<uint8_t> exceeded(tops_mm.size(), 0);
  for (const auto& [a, b] : field.edges) {
    if (tops_mm[a] == tops_mm[b])
      exceeded[std::max(a, b)] = 1;  // of a plain the first one
    else
      exceeded[tops_mm[a] < tops_mm[b] ? a : b] = 1;
  }
  std::vector<uint32_t> rays;
  for (uint32_t n = 0; n < tops_mm.size(); ++n)
    if (exceeded[n] == 0 && tops_mm[n] > 0.0) rays.push_back(n);
  const size_t kept = std::min(most, rays.size());
  std::partial_sort(
      rays.begin(), rays.begin() + static_cast<std::ptrdiff_t>(kept), rays.end(),
      [&](uint32_t a, uint32_t b) { return std::pair(-tops_mm[a], a) < std::pair(-tops_mm[b], b); });
  rays.resize(kept);
  return rays;
}

}  // namespace swarf::measure
