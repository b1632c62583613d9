// One control cycle: step() and inverse on DOME at 50 mm/s and 1 ms, one thread.
//
// median_ns and p999_ns come from ticks timed one by one; the clock adds about 20 ns to each. The times of
// the runs themselves are those of whole passes, look-ahead included.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "motion/passes/surface_interpolator.h"
#include "tests/unit/motion/dome.h"

namespace swarf::motion {
namespace {

struct Setup {
  explicit Setup(double v, Mode mode) : pass(iso_pass(dome(), v, 50.0)) { options.mode = mode; }

  kinematics::MachineModel machine = paper_machine();
  kinematics::InverseKinematics inverse{machine};
  cutter::Cutter cutter;
  MotionOptions options;
  toolpath::SurfacePass pass;
};

double percentile(std::vector<double>& values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Runs the pass once and appends the cost of each tick, ns.
void run_pass(const Setup& with, SurfaceInterpolator& interpolator, std::vector<double>& costs) {
  using Clock = std::chrono::steady_clock;
  interpolator.begin(with.pass, kinematics::AxisValues::Zero());
  kinematics::AxisValues q = kinematics::AxisValues::Zero();
  StepOutput out;
  while (!out.finished) {
    const auto start = Clock::now();
    interpolator.step({}, out);
    q = with.inverse.solve_nearest(out.pose, q).q;
    costs.push_back(std::chrono::duration<double, std::nano>(Clock::now() - start).count());
  }
  benchmark::DoNotOptimize(q);
}

void run(benchmark::State& state, double v, Mode mode) {
  const Setup with(v, mode);
  SurfaceInterpolator interpolator(with.machine, with.inverse, with.cutter, with.options);
  std::vector<double> costs;
  costs.reserve(1u << 22);
  for (auto _ : state) {
    if (costs.size() + (1u << 16) > costs.capacity()) costs.clear();
    run_pass(with, interpolator, costs);
  }
  state.counters["ticks"] = static_cast<double>(interpolator.profile().step_mm.size());
  state.counters["median_ns"] = percentile(costs, 0.5);
  state.counters["p999_ns"] = percentile(costs, 0.999);
}

/// begin() alone: limits, plan and march of a whole pass.
void look_ahead(benchmark::State& state, double v) {
  const Setup with(v, Mode::kSurface);
  SurfaceInterpolator interpolator(with.machine, with.inverse, with.cutter, with.options);
  for (auto _ : state) interpolator.begin(with.pass, kinematics::AxisValues::Zero());
  state.counters["ticks"] = static_cast<double>(interpolator.profile().step_mm.size());
}

BENCHMARK_CAPTURE(run, surface_v_0_30, 0.30, Mode::kSurface)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, surface_near_apex, 0.49, Mode::kSurface)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, taylor1_v_0_30, 0.30, Mode::kTaylor1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(look_ahead, v_0_30, 0.30)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(look_ahead, near_apex, 0.49)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace swarf::motion

BENCHMARK_MAIN();
