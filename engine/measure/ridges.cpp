#include "measure/ridges.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/units.h"
#include "stock/rays/ray_height.h"
#include "stock/sweep/sweep_map.h"

namespace swarf::measure {
namespace {

constexpr size_t kEdgesPerTask = 4096;
constexpr double kHigh = PassHeight::kHigh;

struct Context {
  const stock::SurfaceDexels& dexels;
  std::span<const stock::Sweep> sweeps;
  const PassRule& rule;
  const SweepCutters& cutters;
  const SweepIndex& index;
  double highest_mm;  ///< heights beyond this are "not under the cutter"
};

/// The lowest height that any sweep leaves at a foot, if it lies below `height_mm`.
struct Lowest {
  double height_mm;
  uint32_t sweep;
};
Lowest lowest_of_all(const Context& context, const stock::Foot& foot, double height_mm) {
  Lowest lowest{height_mm, stock::kUncut};
  const Vec3 top = foot.point + height_mm * foot.normal, bottom = foot.point - stock::kSkin * foot.normal;
  std::vector<uint32_t> found;
  context.index.find_below({top, foot.normal}, {top.cwiseMin(bottom), top.cwiseMax(bottom)}, found);
  for (const uint32_t n : found) {
    const stock::Sweep& sweep = context.sweeps[n];
    const stock::CutterSolid& cutter = context.cutters[n];
    // The plane under the tip keeps above the place at both ends, on a column that leaves on the tool's side.
    const auto under = [&](const ToolPose& pose) {
      return pose.axis_W.dot(foot.normal) >= 0.0 && pose.axis_W.dot(top - pose.tip_W) < lowest_z(cutter);
    };
    if (under(sweep.start) && under(sweep.end)) continue;
    const double low =
        stock::ray_height(foot.point, foot.normal, stock::sweep_map(sweep), cutter, lowest.height_mm);
    if (low < lowest.height_mm && low >= -stock::kSkin) lowest = {low, n};
  }
  return lowest;
}

/// The heights that two passes leave at one foot.
class TwoPasses {
 public:
  TwoPasses(const Context& context, uint32_t a, uint32_t b)
      : a_(context.sweeps, context.rule, context.cutters, a),
        b_(context.sweeps, context.rule, context.cutters, b) {}

  /// Height of pass A minus that of pass B.
  double difference(const Vec3& point, const Vec3& normal) {
    height_a_ = a_(point, normal);
    height_b_ = b_(point, normal);
    return height_a_ - height_b_;
  }
  double lower_height() const { return std::min(height_a_, height_b_); }
  uint32_t block_a() const { return a_.owner(); }
  uint32_t block_b() const { return b_.owner(); }

 private:
  PassHeight a_, b_;
  double height_a_ = kHigh, height_b_ = kHigh;
};

/// Root of the difference between two rays: regula falsi with the stagnant end halved (Illinois), bisection
/// where the passes end under the rim and the difference jumps.
double crossing(TwoPasses& passes, const stock::RayField& field, uint32_t a, uint32_t b, double low,
                double high) {
  constexpr int kMostSteps = 60;
  constexpr double kEqualHeights = 1e-10;  // mm
  constexpr double kNarrow = 1e-12;        // share of the way between the rays
  const auto difference = [&](double t) {
    const stock::Foot foot = field.between(a, b, t);
    return passes.difference(foot.point, foot.normal);
  };
  double f_low = difference(low), f_high = difference(high);
  if (!(f_low < 0.0)) return low;
  if (!(f_high > 0.0)) return high;
  int stagnant = 0;
  double t = 0.5 * (low + high);
  for (int step = 0; step < kMostSteps && high - low > kNarrow; ++step) {
    const bool jump = std::max(-f_low, f_high) > 0.5 * kHigh;
    t = jump ? 0.5 * (low + high) : (low * f_high - high * f_low) / (f_high - f_low);
    const double f = difference(t);
    if (std::abs(f) < kEqualHeights) break;
    (f < 0.0 ? low : high) = t;
    (f < 0.0 ? f_low : f_high) = f;
    const int side = f < 0.0 ? -1 : 1;
    if (stagnant == side && !jump) (side < 0 ? f_high : f_low) *= 0.5;
    stagnant = side;
  }
  if (std::max(-f_low, f_high) <= 0.5 * kHigh) return t;
  // One pass ends here: what stands at its end is what the other one leaves beside it.
  const auto left_at = [&](double place) {
    difference(place);
    return passes.lower_height() < 0.5 * kHigh ? passes.lower_height() : -kHigh;
  };
  return left_at(low) > left_at(high) ? low : high;
}

/// Whether the ridge runs more across the edge than along it: the change of the difference along the edge
/// against that at right angles to it, both in the tangent plane. A plane's distance from the design shifts
/// both heights alike, so that it does not show in the difference.
bool crosses_squarely(TwoPasses& passes, const stock::Foot& foot, const Vec3& edge) {
  constexpr double kPart = 0.05;  // of the edge's length
  const Vec3 along = kPart * (edge - edge.dot(foot.normal) * foot.normal), aside = foot.normal.cross(along);
  const auto change = [&](const Vec3& step) {
    const double ahead = passes.difference(foot.point + step, foot.normal);
    return std::abs(ahead - passes.difference(foot.point - step, foot.normal));
  };
  constexpr double kTie = 0.99;  // at 45 degrees rounding must not drop the ridge on both edges
  return change(along) >= kTie * change(aside);
}

/// The way between two rays that one sweep owns at its start and another at its end.
struct Stretch {
  uint32_t first, second;  ///< rays
  double from, to;         ///< of the way between them
  uint32_t a, b;           ///< sweeps
};

/// Appends the ridges of a stretch. Where a third pass lies lower than the two at their crossing there is no
/// ridge of theirs: each of them has one with the third.
void add_ridges(const Context& context, const Stretch& way, int depth, std::vector<Ridge>& ridges) {
  constexpr int kMostPasses = 12;  // halvings of an edge: more passes than 2^12 between two rays are one wall
  constexpr double kLower = 1e-9;  // mm
  if (way.a == way.b || way.a == stock::kUncut || way.b == stock::kUncut) return;
  if (!context.rule.is_pass(way.a) || !context.rule.is_pass(way.b) || context.rule.same(way.a, way.b)) return;
  const stock::RayField& field = context.dexels.field();
  TwoPasses passes(context, way.a, way.b);
  const double t = crossing(passes, field, way.first, way.second, way.from, way.to);
  const stock::Foot foot = field.between(way.first, way.second, t);
  passes.difference(foot.point, foot.normal);
  const double height = passes.lower_height();
  const Lowest third = lowest_of_all(context, foot, std::min(height, context.highest_mm));
  if (third.sweep != stock::kUncut && third.height_mm < height - kLower && depth < kMostPasses) {
    add_ridges(context, {way.first, way.second, way.from, t, way.a, third.sweep}, depth + 1, ridges);
    add_ridges(context, {way.first, way.second, t, way.to, third.sweep, way.b}, depth + 1, ridges);
    return;
  }
  // Between two faces both passes may end short of the edge: nothing stands there that a pass has left.
  if (height > 0.5 * kHigh) return;
  if (!crosses_squarely(passes, foot, field.points[way.second] - field.points[way.first])) return;
  ridges.push_back({foot.u, foot.v, um_from_mm(height), passes.block_a(), passes.block_b(), foot.point,
                    foot.point + height * foot.normal, way.first});
}

}  // namespace

std::vector<Ridge> find_ridges(const stock::SurfaceDexels& dexels, std::span<const stock::Sweep> sweeps,
                               const PassRule& rule, const SweepCutters& cutters, const SweepIndex& index) {
  double highest = 0.0;
  for (const double height : dexels.heights_mm()) highest = std::max(highest, height);
  const Context context{dexels, sweeps, rule, cutters, index, 2.0 * highest + dexels.field().pitch_mm};
  const auto& edges = dexels.field().edges;
  std::vector<std::vector<Ridge>> parts((edges.size() + kEdgesPerTask - 1) / kEdgesPerTask);
  parallel_chunks(edges.size(), kEdgesPerTask, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n) {
      const auto [a, b] = edges[n];
      add_ridges(context, {a, b, 0.0, 1.0, dexels.blocks()[a], dexels.blocks()[b]}, 0,
                 parts[begin / kEdgesPerTask]);
    }
  });
  std::vector<Ridge> ridges;
  for (const auto& part : parts) ridges.insert(ridges.end(), part.begin(), part.end());
  return ridges;
}

}  // namespace swarf::measure
