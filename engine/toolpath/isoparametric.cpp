#include "toolpath/isoparametric.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace swarf::toolpath {
namespace {

/// Progress x across the area, 0 at the first boundary and 1 at the last.
CubicSpline pass_at(const Area& area, double x) {
  return CubicSpline::constant(area.start_w + area.forward() * x);
}

/// Longest step from x. Strips are measured inside the part only; beyond it the last inner strip is scaled.
double longest_step(const Area& area, double x, double guess) {
  constexpr int kRounds = 4;  // each gains two digits: the cusp grows with the square of the step
  double step = guess;
  for (int i = 0; i < kRounds; ++i) {
    const double inside = std::min(step, 1.0 - x);
    const Strip strip = measure_strip(area, pass_at(area, x), pass_at(area, x + inside), 0.0, 1.0);
    step = inside * std::min(std::sqrt(area.scallop_mm / strip.scallop_max_mm),
                             2.0 * area.clean_mm() / strip.chord_max_mm);
  }
  return step;
}

/// Where `steps` steps, each shortened by the factor, lead to (0: as many as it takes to reach 1).
std::vector<double> walk(const Area& area, double factor, size_t steps) {
  std::vector<double> x{0.0};
  double step = 0.5 * area.scallop_mm / area.end.radius();  // short of any sensible one; corrected at once
  while (steps == 0 ? x.back() < 1.0 : x.size() <= steps) {
    if (x.back() < 1.0) step = longest_step(strip_behind(area, x.size() - 1), x.back(), step);
    SWARF_CHECK(step > 0.0, "an iso-parametric step has no length");
    x.push_back(x.back() + factor * step);
  }
  return x;
}

}  // namespace

std::vector<double> isoparametric_passes(const Area& area) {
  constexpr double kDone = 1e-6;  // of the width; what is left is spread by the last scaling
  double factor = 1.0;
  std::vector<double> x = walk(area, factor, 0);
  const size_t steps = x.size() - 1;
  for (int i = 0; i < 8 && std::abs(x.back() - 1.0) > kDone; ++i) {
    factor /= x.back();
    x = walk(area, factor, steps);
  }
  std::vector<double> passes;
  passes.reserve(x.size());
  for (const double place : x) passes.push_back(area.start_w + area.forward() * place / x.back());
  passes.back() = area.end_w;
  return passes;
}

}  // namespace swarf::toolpath
