// Cutting, dexels and meshing on DOME (theory 1.6), D10 flat end, axis on the normal, five axes.
#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "base/parallel.h"
#include "measure/measure.h"
#include "stock/stock.h"
#include "stock/surface_dexels.h"
#include "surface/polynomial.h"

namespace swarf {
namespace {

const stock::CutterSolid kCutter{5.0, 45.0};
const Box kBox{{-50, -40, -20}, {50, 40, 37}};
constexpr int kPasses = 31;

surface::SurfacePtr dome() {
  const Vec3 zero = Vec3::Zero();
  return std::make_shared<surface::PolynomialSurface>(
      2, 2,
      std::vector<Vec3>{
          {-50, -40, 0}, {0, 80, 60}, {0, 0, -60}, {100, 0, 80}, zero, zero, {0, 0, -80}, zero, zero},
      1);
}

struct Path {
  std::vector<stock::Sweep> sweeps;
  std::vector<int> passes;
};

/// Zigzag passes along u whose sweeps are about `step_mm` long, 1 mm beyond the edges.
Path dome_path(double step_mm) {
  const surface::SurfacePtr surface = dome();
  Path path;
  const int count = static_cast<int>(112.0 / step_mm);
  for (int pass = 0; pass < kPasses; ++pass) {
    const double v = -0.0125 + 1.025 * pass / (kPasses - 1);
    const auto at = [&](int i) {
      const double t = -0.01 + 1.02 * (pass % 2 == 0 ? i : count - i) / count;
      const surface::Derivatives d = surface->derivatives(t, v);
      return ToolPose{d.S, surface::outward_normal(*surface, d)};
    };
    for (int i = 0; i < count; ++i) {
      path.sweeps.push_back({at(i), at(i + 1), static_cast<uint32_t>(path.sweeps.size())});
      path.passes.push_back(pass);
    }
  }
  return path;
}

/// Blocks of 1 mm; range(0): voxel in um, range(1): threads. The block is already roughed to about 1 mm above
/// DOME.
void cut_stock(benchmark::State& state) {
  set_thread_count(static_cast<int>(state.range(1)));
  const double voxel = 1e-3 * static_cast<double>(state.range(0));
  const Path finish = dome_path(1.0);
  Path rough = finish;
  for (stock::Sweep& sweep : rough.sweeps) {
    sweep.start.tip_W += sweep.start.axis_W;
    sweep.end.tip_W += sweep.end.axis_W;
  }
  double seconds = 0.0;
  uint64_t voxels = 0, blocks = 0;
  for (auto _ : state) {
    state.PauseTiming();
    auto stock = std::make_unique<stock::Stock>(kBox, voxel);
    stock->cut(rough.sweeps, kCutter);
    const stock::CutStatistics before = stock->statistics();
    state.ResumeTiming();
    stock->cut(finish.sweeps, kCutter);
    seconds += stock->statistics().seconds - before.seconds;
    voxels += stock->statistics().voxel_updates - before.voxel_updates;
    blocks += finish.sweeps.size();
    state.PauseTiming();
    stock.reset();
    state.ResumeTiming();
  }
  state.counters["blocks_per_s"] = static_cast<double>(blocks) / seconds;
  state.counters["voxels_per_s"] = static_cast<double>(voxels) / seconds;
  // A voxel update reads and writes one float; the reference machine's triad moves 47-76 GB/s on two threads.
  state.counters["bytes_per_s"] = 8.0 * static_cast<double>(voxels) / seconds;
  set_thread_count(0);
}
BENCHMARK(cut_stock)
    ->ArgNames({"voxel_um", "threads"})
    ->Args({100, 1})
    ->Args({100, 2})
    ->Args({200, 1})
    ->Args({200, 2})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// Control cycles of 1 ms at 50 mm/s, rays every 0.2 mm; range(0): threads.
void cut_dexels(benchmark::State& state) {
  set_thread_count(static_cast<int>(state.range(0)));
  const Path path = dome_path(0.05);
  uint64_t rays = 0;
  for (auto _ : state) {
    stock::SurfaceDexels dexels(dome(), 0.2, kBox);
    dexels.cut(path.sweeps, kCutter);
    rays += dexels.ray_updates();
  }
  state.counters["rays_per_s"] = benchmark::Counter(static_cast<double>(rays), benchmark::Counter::kIsRate);
  state.counters["sweeps_per_s"] = benchmark::Counter(static_cast<double>(path.sweeps.size()),
                                                      benchmark::Counter::kIsIterationInvariantRate);
  set_thread_count(0);
}
BENCHMARK(cut_dexels)->ArgNames({"threads"})->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

void measure_ridges(benchmark::State& state) {
  set_thread_count(static_cast<int>(state.range(0)));
  const Path path = dome_path(0.05);
  stock::SurfaceDexels dexels(dome(), 0.2, kBox);
  dexels.cut(path.sweeps, kCutter);
  size_t ridges = 0;
  for (auto _ : state) {
    ridges = measure::measure_surface(dexels, path.sweeps, path.passes, kCutter, {}, nullptr).ridges;
  }
  state.counters["ridges"] = static_cast<double>(ridges);
  set_thread_count(0);
}
BENCHMARK(measure_ridges)
    ->ArgNames({"threads"})
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// range(0): voxel in um, range(1): threads.
void mesh_stock(benchmark::State& state) {
  set_thread_count(static_cast<int>(state.range(1)));
  stock::Stock stock(kBox, 1e-3 * static_cast<double>(state.range(0)));
  stock.cut(dome_path(1.0).sweeps, kCutter);
  size_t triangles = 0;
  for (auto _ : state) triangles = stock.mesh().triangles.size();
  state.counters["triangles"] = static_cast<double>(triangles);
  state.counters["triangles_per_s"] =
      benchmark::Counter(static_cast<double>(triangles), benchmark::Counter::kIsIterationInvariantRate);
  set_thread_count(0);
}
BENCHMARK(mesh_stock)
    ->ArgNames({"voxel_um", "threads"})
    ->Args({500, 1})
    ->Args({500, 2})
    ->Args({200, 1})
    ->Args({200, 2})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void make_box(benchmark::State& state) {
  set_thread_count(static_cast<int>(state.range(1)));
  for (auto _ : state) {
    const stock::Stock stock(kBox, 1e-3 * static_cast<double>(state.range(0)));
    benchmark::DoNotOptimize(stock.memory_bytes());
  }
  set_thread_count(0);
}
BENCHMARK(make_box)
    ->ArgNames({"voxel_um", "threads"})
    ->Args({200, 1})
    ->Args({200, 2})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace swarf

BENCHMARK_MAIN();
