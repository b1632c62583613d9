#include "flank/chebyshev_fit.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/check.h"

namespace swarf::flank {
namespace {

using System = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostUnknowns + 1, kMostUnknowns + 1>;
using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostUnknowns + 1, 1>;

struct Levelled {
  Shift x{};
  double level = -1.0;  ///< below 0: the places do not determine one
};

/// Equal errors of alternating sign at these places.
Levelled level_at(std::span<const double> errors, std::span<const Shift> slopes,
                  const std::vector<size_t>& places) {
  const auto n = static_cast<Eigen::Index>(places.size());
  System A(n, n);
  Column b(n);
  for (Eigen::Index r = 0; r < n; ++r) {
    const size_t j = places[static_cast<size_t>(r)];
    for (Eigen::Index i = 0; i + 1 < n; ++i) A(r, i) = slopes[j][static_cast<size_t>(i)];
    A(r, n - 1) = r % 2 == 0 ? -1.0 : 1.0;
    b(r) = -errors[j];
  }
  const Eigen::FullPivLU<System> lu(A);
  if (!lu.isInvertible()) return {};
  const Column x = lu.solve(b);
  Levelled found;
  for (Eigen::Index i = 0; i + 1 < n; ++i) found.x[static_cast<size_t>(i)] = x(i);
  found.level = std::abs(x(n - 1));
  return found;
}

size_t worst(std::span<const double> errors, std::span<const Shift> slopes, const Shift& x, double* value) {
  size_t at = 0;
  *value = -1.0;
  for (size_t j = 0; j < errors.size(); ++j) {
    double e = errors[j];
    for (size_t i = 0; i < x.size(); ++i) e += slopes[j][i] * x[i];
    if (std::abs(e) > *value) *value = std::abs(e), at = j;
  }
  return at;
}

}  // namespace

Shift least_maximum(std::span<const double> errors, std::span<const Shift> slopes, int unknowns) {
  const auto count = static_cast<size_t>(unknowns);
  SWARF_CHECK(unknowns >= 1 && unknowns <= kMostUnknowns && errors.size() > count,
              "more places than unknowns");
  std::vector<size_t> places;
  for (size_t i = 0; i <= count; ++i) places.push_back(i * (errors.size() - 1) / count);
  Levelled found = level_at(errors, slopes, places);
  constexpr double kLevelled = 1e-12;
  for (size_t step = 0; step < 4 * errors.size(); ++step) {
    double value = 0.0;
    const size_t in = worst(errors, slopes, found.x, &value);
    if (value <= found.level + kLevelled) break;
    std::vector<size_t> best;
    Levelled raised = found;
    for (size_t out = 0; out <= count; ++out) {
      std::vector<size_t> trial = places;
      trial[out] = in;
      std::sort(trial.begin(), trial.end());
      if (std::adjacent_find(trial.begin(), trial.end()) != trial.end()) continue;
      const Levelled level = level_at(errors, slopes, trial);
      if (level.level > raised.level) raised = level, best = trial;
    }
    if (best.empty()) break;
    places = best;
    found = raised;
  }
  return found.x;
}

}  // namespace swarf::flank
