#include "measure/ridges.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/parallel.h"
#include "base/units.h"

namespace swarf::measure {
namespace {

constexpr size_t kEdgesPerTask = 4096;
constexpr double kHigh = PassHeight::kHigh;

struct Context {
  const stock::SurfaceDexels& dexels;
  std::span<const stock::Sweep> sweeps;
  const PassRule& rule;
  const SweepCutters& cutters;
};

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
double crossing(TwoPasses& passes, const stock::RayField& field, uint32_t a, uint32_t b) {
  constexpr int kMostSteps = 60;
  constexpr double kEqualHeights = 1e-10;  // mm
  constexpr double kNarrow = 1e-12;        // share of the way between the rays
  const auto difference = [&](double t) {
    const stock::Foot foot = field.between(a, b, t);
    return passes.difference(foot.point, foot.normal);
  };
  double low = 0.0, high = 1.0;
  double f_low = difference(low), f_high = difference(high);
  if (!(f_low < 0.0)) return 0.0;
  if (!(f_high > 0.0)) return 1.0;
  int stagnant = 0;
  double t = 0.5;
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
  return t;
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

std::optional<Ridge> ridge_on_edge(const Context& context, uint32_t first, uint32_t second) {
  const uint32_t a = context.dexels.blocks()[first], b = context.dexels.blocks()[second];
  if (a == b || a == stock::kUncut || b == stock::kUncut) return std::nullopt;
  if (!context.rule.is_pass(a) || !context.rule.is_pass(b) || context.rule.same(a, b)) return std::nullopt;
  const stock::RayField& field = context.dexels.field();
  TwoPasses passes(context, a, b);
  const stock::Foot foot = field.between(first, second, crossing(passes, field, first, second));
  passes.difference(foot.point, foot.normal);
  // Between two faces both passes may end short of the edge: nothing stands there that a pass has left.
  if (passes.lower_height() > 0.5 * kHigh) return std::nullopt;
  const Ridge ridge{foot.u,           foot.v,           um_from_mm(passes.lower_height()),
                    passes.block_a(), passes.block_b(), foot.point};
  const bool squarely = crosses_squarely(passes, foot, field.points[second] - field.points[first]);
  return squarely ? std::optional(ridge) : std::nullopt;
}

}  // namespace

std::vector<Ridge> find_ridges(const stock::SurfaceDexels& dexels, std::span<const stock::Sweep> sweeps,
                               const PassRule& rule, const SweepCutters& cutters) {
  const Context context{dexels, sweeps, rule, cutters};
  const auto& edges = dexels.field().edges;
  std::vector<std::vector<Ridge>> parts((edges.size() + kEdgesPerTask - 1) / kEdgesPerTask);
  parallel_chunks(edges.size(), kEdgesPerTask, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n) {
      const auto ridge = ridge_on_edge(context, edges[n][0], edges[n][1]);
      if (ridge) parts[begin / kEdgesPerTask].push_back(*ridge);
    }
  });
  std::vector<Ridge> ridges;
  for (const auto& part : parts) ridges.insert(ridges.end(), part.begin(), part.end());
  return ridges;
}

}  // namespace swarf::measure
