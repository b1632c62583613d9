#include "measure/ridges.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/parallel.h"
#include "base/units.h"

namespace swarf::measure {
namespace {

constexpr size_t kRowsPerTask = 4;
/// Stands for "not under the cutter", so that differences of heights stay ordered; mm.
constexpr double kHigh = 1e6;

struct Context {
  const stock::SurfaceDexels& dexels;
  std::span<const stock::Sweep> sweeps;
  std::span<const int> pass_of_sweep;
  stock::CutterSolid cutter;
};

struct Uv {
  double u, v;
};

/// The heights that two passes leave at (u,v); each remembers the sweep that was lowest last time.
class TwoPasses {
 public:
  TwoPasses(const Context& context, uint32_t a, uint32_t b) : context_(context), a_(a), b_(b) {}

  /// Height of pass A minus that of pass B.
  double difference(const Uv& at) {
    const surface::Derivatives d = context_.dexels.surface().derivatives(at.u, at.v);
    const Vec3 normal = surface::outward_normal(context_.dexels.surface(), d);
    height_a_ = pass_height(d.S, normal, a_);
    height_b_ = pass_height(d.S, normal, b_);
    return height_a_ - height_b_;
  }
  double lower_height() const { return std::min(height_a_, height_b_); }
  uint32_t block_a() const { return a_; }
  uint32_t block_b() const { return b_; }

 private:
  double height(const Vec3& point, const Vec3& normal, uint32_t sweep) const {
    return std::min(kHigh, stock::ray_height(point, normal, context_.sweeps[sweep], context_.cutter));
  }

  /// Walks from sweep to sweep of one pass while the height falls: along a pass it has one minimum near the
  /// sweep that owns the neighbouring ray.
  double pass_height(const Vec3& point, const Vec3& normal, uint32_t& sweep) const {
    const int pass = context_.pass_of_sweep[sweep];
    double lowest = height(point, normal, sweep);
    for (const int step : {1, -1}) {
      const uint32_t first = sweep;
      for (;;) {
        const int64_t next = static_cast<int64_t>(sweep) + step;
        if (next < 0 || next >= static_cast<int64_t>(context_.sweeps.size())) break;
        if (context_.pass_of_sweep[static_cast<size_t>(next)] != pass) break;
        const double candidate = height(point, normal, static_cast<uint32_t>(next));
        if (candidate >= lowest) break;
        lowest = candidate;
        sweep = static_cast<uint32_t>(next);
      }
      if (sweep != first) break;
    }
    return lowest;
  }

  const Context& context_;
  uint32_t a_, b_;
  double height_a_ = kHigh, height_b_ = kHigh;
};

Uv between(const Uv& from, const Uv& to, double t) {
  return {from.u + t * (to.u - from.u), from.v + t * (to.v - from.v)};
}

/// Root of the difference between two rays: regula falsi with the stagnant end halved (Illinois), bisection
/// where the passes end under the rim and the difference jumps.
double crossing(TwoPasses& passes, const Uv& from, const Uv& to) {
  constexpr int kMostSteps = 60;
  constexpr double kEqualHeights = 1e-10;  // mm
  constexpr double kNarrow = 1e-12;        // share of the way between the rays
  double low = 0.0, high = 1.0;
  double f_low = passes.difference(from), f_high = passes.difference(to);
  if (!(f_low < 0.0)) return 0.0;
  if (!(f_high > 0.0)) return 1.0;
  int stagnant = 0;
  double t = 0.5;
  for (int step = 0; step < kMostSteps && high - low > kNarrow; ++step) {
    const bool jump = std::max(-f_low, f_high) > 0.5 * kHigh;
    t = jump ? 0.5 * (low + high) : (low * f_high - high * f_low) / (f_high - f_low);
    const double f = passes.difference(between(from, to, t));
    if (std::abs(f) < kEqualHeights) break;
    (f < 0.0 ? low : high) = t;
    (f < 0.0 ? f_low : f_high) = f;
    const int side = f < 0.0 ? -1 : 1;
    if (stagnant == side && !jump) (side < 0 ? f_high : f_low) *= 0.5;
    stagnant = side;
  }
  return t;
}

/// Change of the difference per mm along both parameters, by central differences over a small part of a cell.
Vec2 slopes(TwoPasses& passes, const Context& context, const Uv& at) {
  constexpr double kPart = 0.05;
  const double du = kPart / (context.dexels.nu() - 1), dv = kPart / (context.dexels.nv() - 1);
  const surface::Derivatives d = context.dexels.surface().derivatives(at.u, at.v);
  const double along_u = passes.difference({at.u + du, at.v}) - passes.difference({at.u - du, at.v});
  const double along_v = passes.difference({at.u, at.v + dv}) - passes.difference({at.u, at.v - dv});
  return {std::abs(along_u) / (2.0 * du * d.Su.norm()), std::abs(along_v) / (2.0 * dv * d.Sv.norm())};
}

/// The ridge between two neighbouring rays, when there is one and this grid direction crosses it more
/// squarely.
std::optional<Ridge> ridge_between(const Context& context, int iu, int iv, bool along_u) {
  const auto& dexels = context.dexels;
  const size_t row = static_cast<size_t>(dexels.nu());
  const size_t first = static_cast<size_t>(iv) * row + static_cast<size_t>(iu);
  const size_t second = first + (along_u ? 1 : row);
  const uint32_t a = dexels.blocks()[first], b = dexels.blocks()[second];
  if (a == stock::kUncut || b == stock::kUncut) return std::nullopt;
  const int pass_a = context.pass_of_sweep[a], pass_b = context.pass_of_sweep[b];
  if (pass_a == pass_b || pass_a < 0 || pass_b < 0) return std::nullopt;
  const Uv from{dexels.u(iu), dexels.v(iv)};
  const Uv to{dexels.u(iu + (along_u ? 1 : 0)), dexels.v(iv + (along_u ? 0 : 1))};
  TwoPasses passes(context, a, b);
  const Uv at = between(from, to, crossing(passes, from, to));
  passes.difference(at);
  Ridge ridge{at.u, at.v, um_from_mm(passes.lower_height()), passes.block_a(), passes.block_b()};
  const Vec2 slope = slopes(passes, context, at);
  const bool squarer = along_u ? slope.x() > slope.y() : slope.y() >= slope.x();
  return squarer ? std::optional(ridge) : std::nullopt;
}

}  // namespace

std::vector<Ridge> find_ridges(const stock::SurfaceDexels& dexels, std::span<const stock::Sweep> sweeps,
                               std::span<const int> pass_of_sweep, const stock::CutterSolid& cutter) {
  const Context context{dexels, sweeps, pass_of_sweep, cutter};
  std::vector<std::vector<Ridge>> rows(static_cast<size_t>(dexels.nv()));
  parallel_chunks(rows.size(), kRowsPerTask, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) {
      const int iv = static_cast<int>(row);
      for (int iu = 0; iu < dexels.nu(); ++iu) {
        for (const bool along_u : {true, false}) {
          const bool inside = along_u ? iu + 1 < dexels.nu() : iv + 1 < dexels.nv();
          if (!inside) continue;
          if (const auto ridge = ridge_between(context, iu, iv, along_u)) rows[row].push_back(*ridge);
        }
      }
    }
  });
  std::vector<Ridge> ridges;
  for (const auto& row : rows) ridges.insert(ridges.end(), row.begin(), row.end());
  return ridges;
}

}  // namespace swarf::measure
