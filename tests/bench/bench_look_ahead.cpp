// Look-ahead over programs of 200 blocks, one thread: planning alone, and with the samples of every cycle.
#include <benchmark/benchmark.h>

#include <vector>

#include "motion/blocks/block_run.h"
#include "unit/motion/random_program.h"

namespace swarf::motion {
namespace {

constexpr int kPrograms = 20, kBlocks = 200;

/// The programs of the tests of look-ahead (tests/unit/motion/look_ahead_property_test.cpp).
std::vector<toolpath::ToolPath> programs(const kinematics::MachineModel& machine) {
  std::vector<toolpath::ToolPath> paths;
  for (uint64_t seed = 1000; seed < 1000 + kPrograms; ++seed) {
    Rng rng(seed);
    paths.push_back(random_program(machine, rng, kBlocks));
  }
  return paths;
}

void report(benchmark::State& state, double cycles) {
  const auto runs = static_cast<double>(state.iterations());
  state.counters["blocks_per_s"] =
      benchmark::Counter(runs * kPrograms * kBlocks, benchmark::Counter::kIsRate);
  if (cycles > 0.0) state.counters["cycles_per_s"] = benchmark::Counter(cycles, benchmark::Counter::kIsRate);
}

void BM_Plan(benchmark::State& state) {
  const kinematics::MachineModel machine = paper_machine();
  const kinematics::InverseKinematics inverse(machine);
  const std::vector<toolpath::ToolPath> paths = programs(machine);
  const MotionOptions options;
  for (auto _ : state) {
    for (const toolpath::ToolPath& path : paths) {
      const BlockMotions motions = block_motions(path, machine);
      for (size_t first = 0; first < motions.size();) {
        const size_t end = run_end(motions, first);
        RunPlace run;
        run.first = first;
        run.end = end;
        RunPlanner planner(motions, run, inverse, options);
        while (!planner.next().last) {
        }
        first = end;
      }
    }
  }
  report(state, 0.0);
}
BENCHMARK(BM_Plan)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

/// What a control makes: plans, and pose and axis values of every cycle.
void BM_PlanAndCycles(benchmark::State& state) {
  const kinematics::MachineModel machine = paper_machine();
  const std::vector<toolpath::ToolPath> paths = programs(machine);
  double cycles = 0.0;
  std::vector<Cycle> window;
  for (auto _ : state) {
    for (const toolpath::ToolPath& path : paths) {
      const Cycles source(path.elements, std::span(&machine, 1), cutter::Cutter{}, MotionOptions{});
      CycleStream stream(source.source());
      while (stream.next(window)) cycles += static_cast<double>(window.size());
      benchmark::DoNotOptimize(window);
    }
  }
  report(state, cycles);
}
BENCHMARK(BM_PlanAndCycles)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

/// The same, each cycle measured and judged against the path beside it on a second thread.
void BM_PlanAndSample(benchmark::State& state) {
  const kinematics::MachineModel machine = paper_machine();
  const std::vector<toolpath::ToolPath> paths = programs(machine);
  double cycles = 0.0;
  for (auto _ : state) {
    for (const toolpath::ToolPath& path : paths) {
      Progress silent;
      Cycles made(path.elements, std::span(&machine, 1), cutter::Cutter{}, MotionOptions{});
      cycles += static_cast<double>(interpolate(made, silent).statistics.ticks);
    }
  }
  report(state, cycles);
}
BENCHMARK(BM_PlanAndSample)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

}  // namespace
}  // namespace swarf::motion

BENCHMARK_MAIN();
