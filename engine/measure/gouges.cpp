#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/units.h"
#include "measure/regions.h"

namespace swarf::measure {
namespace {

constexpr size_t kPiecesPerTask = 256;
constexpr size_t kRefined = 64;
/// Of the pitch: where the compass search starts and ends. The last step is 2e-4 mm at a pitch of 0.2 mm, and
/// a maximum of radius 1 mm then is missed by 2e-8 mm.
constexpr double kFirstStep = 0.5, kLastStep = 1e-3;
/// The search stays this near to its ray; of the pitch.
constexpr double kReach = 1.5;
/// Of a depth: the design is no farther away than its own place.
constexpr double kWithin = 1.001;

struct GougeContext {
  const stock::SurfaceDexels& dexels;
  std::span<const stock::Sweep> sweeps;
  const PassRule& rule;
  const SweepCutters& cutters;
};

/// Depths around one ray; x is the foot's displacement in the ray's tangent plane.
class Surroundings {
 public:
  Surroundings(const GougeContext& context, uint32_t ray)
      : field_(context.dexels.field()),
        ray_(ray),
        height_(context.sweeps, context.rule, context.cutters, context.dexels.blocks()[ray]) {
    int least = 0;
    field_.normals[ray].cwiseAbs().minCoeff(&least);
    e1_ = field_.normals[ray].cross(Vec3::Unit(least)).normalized();
    e2_ = field_.normals[ray].cross(e1_);
  }

  /// mm, positive below the design; -kHigh beyond the design's end.
  double depth(const Vec2& x) {
    const auto foot = field_.displaced(ray_, x.x() * e1_ + x.y() * e2_);
    if (!foot) return -PassHeight::kHigh;
    place_ = foot->point;
    normal_ = foot->normal;
    return -height_(foot->point, foot->normal);
  }
  const Vec3& place() const { return place_; }  ///< of the last depth
  const Vec3& normal() const { return normal_; }
  /// As much of the last depth as its foot answers for, told as the distance to the design; 0 where nothing
  /// is removed at that depth: along a column of one hole the sweep of another hole is met far below.
  double own(double depth) {
    const double own = field_.own_depth(place_, normal_, depth);
    const Vec3 bottom = place_ - own * normal_;
    if (own < depth && !height_.removes(bottom)) return 0.0;
    return field_.design == nullptr
               ? own
               : std::min(own, field_.design->nearest(bottom, kWithin * own).distance_mm);
  }
  uint32_t owner() const { return height_.owner(); }

 private:
  const stock::RayField& field_;
  uint32_t ray_;
  PassHeight height_;
  Vec3 e1_, e2_, place_ = Vec3::Zero(), normal_ = Vec3::UnitZ();
};

/// Depth that a parabola through the ray and its surroundings promises, mm.
double forecast(const GougeContext& context, uint32_t ray) {
  const double step = 0.25 * context.dexels.field().pitch_mm;
  Surroundings around(context, ray);
  const double middle = -context.dexels.heights_mm()[ray];
  double promised = middle;
  for (const Vec2& direction : {Vec2(step, 0), Vec2(0, step)}) {
    const double ahead = around.depth(direction), behind = around.depth(-direction);
    if (std::min(ahead, behind) < -0.5 * PassHeight::kHigh) {
      promised +=
          std::max(0.0, std::max(ahead, behind) - middle);  // at an end of the design or of the cutter
      continue;
    }
    const double slope = std::abs(ahead - behind) / (2.0 * step);
    const double bend = (2.0 * middle - ahead - behind) / (step * step);  // > 0: the depth has a maximum
    const double straight = slope * 2.0 * step;                           // half a pitch away
    promised += bend * 2.0 * step > slope ? 0.5 * slope * slope / bend : straight;
  }
  return promised;
}

Region refined(const GougeContext& context, uint32_t ray) {
  const stock::RayField& field = context.dexels.field();
  Surroundings around(context, ray);
  Region best;
  best.ray = ray;
  best.block = context.dexels.blocks()[ray];
  best.place = field.points[ray];
  double depth = -context.dexels.heights_mm()[ray];
  best.end = best.place - depth * field.normals[ray];
  Vec2 at = Vec2::Zero();
  for (double step = kFirstStep * field.pitch_mm; step > kLastStep * field.pitch_mm;) {
    Vec2 next = at;
    for (const Vec2& direction : {Vec2(1, 0), Vec2(-1, 0), Vec2(0, 1), Vec2(0, -1)}) {
      const Vec2 candidate = at + step * direction;
      if (candidate.norm() > kReach * field.pitch_mm) continue;
      const double found = around.depth(candidate);
      if (found <= depth) continue;
      const double own = around.own(found);
      if (own <= depth) continue;
      depth = own;
      next = candidate;
      best.place = around.place();
      best.end = best.place - depth * around.normal();
      best.block = around.owner();
    }
    if (next == at) step *= 0.5;
    at = next;
  }
  best.worst_um = um_from_mm(depth);
  return best;
}

/// The lowest ray that each piece of the path owns.
std::vector<uint32_t> lowest_of_pieces(const GougeContext& context) {
  constexpr uint32_t kNone = 0xffffffffU;
  const auto& heights = context.dexels.heights_mm();
  const double pitch = context.dexels.field().pitch_mm;
  std::vector<uint32_t> lowest;
  for (uint32_t n = 0; n < heights.size(); ++n) {
    const uint32_t owner = context.dexels.blocks()[n];
    if (owner == stock::kUncut) continue;
    const auto piece = static_cast<size_t>(context.rule.travel_mm(owner) / pitch);
    if (piece >= lowest.size()) lowest.resize(piece + 1, kNone);
    if (lowest[piece] == kNone || heights[n] < heights[lowest[piece]]) lowest[piece] = n;
  }
  lowest.erase(std::remove(lowest.begin(), lowest.end(), kNone), lowest.end());
  return lowest;
}

/// The rays around which the deepest gouges are to be expected.
std::vector<uint32_t> promising_rays(const GougeContext& context) {
  const std::vector<uint32_t> lowest = lowest_of_pieces(context);
  std::vector<std::pair<double, uint32_t>> forecasts(lowest.size());
  parallel_chunks(lowest.size(), kPiecesPerTask, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) forecasts[i] = {-forecast(context, lowest[i]), lowest[i]};
  });
  const size_t kept = std::min(kRefined, forecasts.size());
  std::partial_sort(forecasts.begin(), forecasts.begin() + static_cast<std::ptrdiff_t>(kept),
                    forecasts.end());
  std::vector<uint32_t> rays;
  for (size_t i = 0; i < kept; ++i) rays.push_back(forecasts[i].second);
  return rays;
}

}  // namespace

std::vector<Region> find_gouges(const stock::SurfaceDexels& dexels, std::span<const stock::Sweep> sweeps,
                                const PassRule& rule, const SweepCutters& cutters, double limit_mm,
                                Region* deepest) {
  const GougeContext context{dexels, sweeps, rule, cutters};
  std::vector<double> depths;
  for (const double height : dexels.heights_mm()) depths.push_back(-height);
  std::vector<uint32_t> region_of;
  std::vector<Region> regions = find_regions(dexels.field(), depths, dexels.blocks(), limit_mm, &region_of);
  const auto low = std::max_element(depths.begin(), depths.end());
  if (low != depths.end() && *low > 0.0) {
    const auto ray = static_cast<uint32_t>(low - depths.begin());
    const Vec3& place = dexels.points()[ray];
    *deepest = {um_from_mm(*low),     0.0, 0.0, place,
                dexels.blocks()[ray], 0,   ray, place - *low * dexels.normals()[ray]};
  }
  std::vector<uint32_t> rays = promising_rays(context);
  for (size_t i = 0; i < std::min(kRefined, regions.size()); ++i) {
    if (regions[i].block != stock::kUncut) rays.push_back(regions[i].ray);
  }
  std::vector<Region> refinements(rays.size());
  parallel_chunks(rays.size(), 1,
                  [&](size_t begin, size_t) { refinements[begin] = refined(context, rays[begin]); });
  for (const Region& found : refinements) {
    if (found.worst_um > deepest->worst_um) *deepest = found;
    if (found.worst_um <= um_from_mm(limit_mm)) continue;
    join_region(found, region_of[found.ray], dexels.field().pitch_mm, regions);
  }
  std::sort(regions.begin(), regions.end(), larger);
  return regions;
}

}  // namespace swarf::measure
