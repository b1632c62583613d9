#include "toolpath/grid_step.h"

#include <algorithm>
#include <utility>

namespace swarf::toolpath {
namespace {

/// The advance is continued with the slope over this many cells: a longer base keeps many passes in a row
/// from amplifying the noise at the ends.
constexpr int kSlopeCells = 16;

bool solved(const GridPoints& points, int j) {
  return points.outcome[j] == PointOutcome::kSolved;
}

/// First place within 0..1 where the walk failed although a pass is needed there, or where its matching
/// points fall behind their neighbours.
NextPass check_points(const Area& area, const CubicSpline& previous, const GridPoints& points) {
  const Grid& grid = area.grid;
  int before = -1;
  for (int j = 0; j < grid.size(); ++j) {
    const double t = grid.t(j);
    const double w = previous.at(t).w;
    const bool needed = t >= 0.0 && t <= 1.0 && !area.beyond_end(w);
    if (needed && points.outcome[j] == PointOutcome::kFailed) return {NextPass::kNoPoint, t, {}};
    if (!solved(points, j)) continue;
    const double advance = (points.w[j] - w) * area.forward();
    // Passes may rest on a boundary beyond which the surface does not continue.
    const bool rests = !area.continues_across && advance == 0.0;
    const bool ordered = before < 0 || points.foot[j] >= points.foot[before];
    if (needed && ((advance <= 0.0 && !rests) || !ordered)) return {NextPass::kFolds, t, {}};
    before = j;
  }
  if (before < 0) return {NextPass::kNoPoint, grid.t(grid.intervals / 2), {}};
  return {};
}

/// Fills the unsolved points: linearly between solved ones, and with the slope of the last solved ones
/// outwards.
void fill(std::vector<double>& advance, const GridPoints& points) {
  const int n = static_cast<int>(advance.size());
  std::vector<int> known;
  for (int j = 0; j < n; ++j)
    if (solved(points, j)) known.push_back(j);
  const auto line = [&](int j, int a, int b) {
    return a == b ? advance[a] : advance[a] + (advance[b] - advance[a]) * (j - a) / (b - a);
  };
  const size_t reach = std::min<size_t>(kSlopeCells, known.size() - 1);
  for (int j = 0; j < known.front(); ++j) advance[j] = line(j, known.front(), known[reach]);
  for (int j = known.back() + 1; j < n; ++j)
    advance[j] = line(j, known.back(), known[known.size() - 1 - reach]);
  for (size_t i = 0; i + 1 < known.size(); ++i)
    for (int j = known[i] + 1; j < known[i + 1]; ++j) advance[j] = line(j, known[i], known[i + 1]);
}

}  // namespace

NextPass graph_of(const Area& area, const CubicSpline& previous, const GridPoints& points) {
  NextPass next = check_points(area, previous, points);
  if (next.outcome != NextPass::kOk) return next;
  const Grid& grid = area.grid;
  std::vector<double> advance(grid.size());
  for (int j = 0; j < grid.size(); ++j) advance[j] = points.w[j] - previous.at(grid.t(j)).w;
  fill(advance, points);
  std::vector<double> w(grid.size());
  for (int j = 0; j < grid.size(); ++j) w[j] = previous.at(grid.t(j)).w + advance[j];
  next.w = CubicSpline(grid.first, grid.step, std::move(w));
  return next;
}

}  // namespace swarf::toolpath
