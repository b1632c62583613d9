#include "toolpath/grid_step.h"

#include <algorithm>

namespace swarf::toolpath {
namespace {

/// The advance is continued with the slope over this many cells: a longer base keeps many passes in a row
/// from amplifying the noise at the ends.
constexpr int kSlopeCells = 16;

/// Solved points around the middle of the grid: [first, last], or first > last when there are none.
struct Run {
  int first, last;
};
Run solved_run(const GridPoints& points) {
  const int n = static_cast<int>(points.w.size());
  Run run{n / 2, n / 2 - 1};
  while (run.last + 1 < n && points.outcome[run.last + 1] == PointOutcome::kSolved) ++run.last;
  while (run.first - 1 >= 0 && points.outcome[run.first - 1] == PointOutcome::kSolved) --run.first;
  return run;
}

}  // namespace

NextPass graph_of(const Area& area, const CubicSpline& previous, const GridPoints& points) {
  const Grid& grid = area.grid;
  const int n = grid.size();
  const Run run = solved_run(points);
  NextPass next;
  for (int j = 0; j < n; ++j) {
    const bool within = grid.t(j) >= 0.0 && grid.t(j) <= 1.0;
    const bool solved = run.first <= j && j <= run.last;
    if (within && !solved && points.outcome[j] != PointOutcome::kFootOutside)
      return {NextPass::kNoPoint, grid.t(j), {}};
    if (run.first < j && j <= run.last && points.foot[j] < points.foot[j - 1])
      return {NextPass::kFolds, grid.t(j), {}};
  }
  if (run.last - run.first < kSlopeCells) return {NextPass::kNoPoint, grid.t(n / 2), {}};

  std::vector<double> advance(n);
  for (int j = run.first; j <= run.last; ++j) {
    advance[j] = points.w[j] - previous.at(grid.t(j)).w;
    if (advance[j] * area.forward() <= 0.0) return {NextPass::kFolds, grid.t(j), {}};
  }
  const double low_slope = (advance[run.first + kSlopeCells] - advance[run.first]) / kSlopeCells;
  const double high_slope = (advance[run.last] - advance[run.last - kSlopeCells]) / kSlopeCells;
  for (int j = 0; j < run.first; ++j) advance[j] = advance[run.first] + low_slope * (j - run.first);
  for (int j = run.last + 1; j < n; ++j) advance[j] = advance[run.last] + high_slope * (j - run.last);

  std::vector<double> w(n);
  for (int j = 0; j < n; ++j) w[j] = previous.at(grid.t(j)).w + advance[j];
  next.w = CubicSpline(grid.first, grid.step, std::move(w));
  return next;
}

}  // namespace swarf::toolpath
