// Positions on surface patches along a scan line, one thread: DOME, and a wavy surface of 50 x 50 mm from
// 4 x 4 bicubic patches, with what was touched last as a hint; upright and tilted.
//
// median_ns and p999_ns come from positions timed one by one; the clock adds about 20 ns to each.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>

#include "tests/unit/position/patch_scene.h"

namespace swarf::position {
namespace {

struct ScanOf {
  std::vector<Patch> (*patches)();
  ToolProfile profile;
  double lean = 0.0;
};

std::vector<Patch> dome_alone() {
  return {dome_patch()};
}

double share_of_sorted(std::vector<double>& values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

void scan(benchmark::State& state, const ScanOf& of) {
  using Clock = std::chrono::steady_clock;
  const PatchTarget target(of.patches());
  constexpr int kPositions = 4000;
  std::vector<double> costs;
  PatchHint near;
  double leaves = 0.0, steps = 0.0, cells = 0.0;
  int at = 0;
  for (auto _ : state) {
    const double along = static_cast<double>(at++ % kPositions) / kPositions;
    const GuideLine line = guide_line({-22.0 + 44.0 * along, 3.0, 0.0}, {of.lean, 0.5 * of.lean, 1.0});
    Rest best;
    PatchWork work;
    const auto start = Clock::now();
    target.raise(of.profile, line, best, near, work);
    costs.push_back(std::chrono::duration<double, std::nano>(Clock::now() - start).count());
    benchmark::DoNotOptimize(best);
    cells += work.cells;
    leaves += work.leaves;
    steps += work.steps;
  }
  const double count = static_cast<double>(state.iterations());
  state.counters["median_ns"] = share_of_sorted(costs, 0.5);
  state.counters["p999_ns"] = share_of_sorted(costs, 0.999);
  state.counters["cells"] = cells / count;
  state.counters["leaves"] = leaves / count;
  state.counters["steps"] = steps / count;
}

BENCHMARK_CAPTURE(scan, dome_ball, ScanOf{dome_alone, ball_end(5.0)});
BENCHMARK_CAPTURE(scan, dome_bull_nose, ScanOf{dome_alone, nose_end(3.0, 2.0)});
BENCHMARK_CAPTURE(scan, dome_flat, ScanOf{dome_alone, flat_end(5.0)});
BENCHMARK_CAPTURE(scan, wave_ball, ScanOf{wavy_patches, ball_end(5.0)});
BENCHMARK_CAPTURE(scan, wave_bull_nose, ScanOf{wavy_patches, nose_end(3.0, 2.0)});
BENCHMARK_CAPTURE(scan, wave_flat, ScanOf{wavy_patches, flat_end(5.0)});
BENCHMARK_CAPTURE(scan, wave_ball_tilted, ScanOf{wavy_patches, ball_end(5.0), 0.3});

}  // namespace
}  // namespace swarf::position

BENCHMARK_MAIN();
