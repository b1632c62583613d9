// Cutting, dexels and meshing on DOME (theory 1.6), D10 flat end, axis on the normal, five axes.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "base/parallel.h"
#include "measure/measure.h"
#include "stock/rays/surface_dexels.h"
#include "stock/stock.h"
#include "stock/sweep/sweep_map.h"
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

/// Each block of 1 mm (tip straight, axis turning evenly) as so many sweeps that none strays by more than 1
/// um.
std::vector<stock::Sweep> subdivided(const std::vector<stock::Sweep>& blocks, double lever_mm) {
  constexpr double kTolerance = 1e-3;
  std::vector<stock::Sweep> sweeps;
  for (const stock::Sweep& block : blocks) {
    const auto count =
        static_cast<int>(std::ceil(std::sqrt(stock::motion_bound(block, lever_mm) / kTolerance)));
    const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(block.start.axis_W, block.end.axis_W);
    const auto pose = [&](int i) -> ToolPose {
      if (i == 0 || i == count) return i == 0 ? block.start : block.end;
      const double t = static_cast<double>(i) / count;
      return {(1.0 - t) * block.start.tip_W + t * block.end.tip_W,
              Eigen::Quaterniond::Identity().slerp(t, turn) * block.start.axis_W};
    };
    for (int i = 0; i < count; ++i) sweeps.push_back({pose(i), pose(i + 1), block.block});
  }
  return sweeps;
}

/// Blocks of 1 mm; range(0): voxel in um, range(1): threads. The block is already roughed to about 1 mm above
/// DOME.
void cut_stock(benchmark::State& state) {
  set_thread_count(static_cast<int>(state.range(1)));
  const double voxel = 1e-3 * static_cast<double>(state.range(0));
  const Path finish = dome_path(1.0);
  const std::vector<stock::Sweep> sweeps = subdivided(finish.sweeps, kCutter.height);
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
    stock->cut(sweeps, kCutter);
    seconds += stock->statistics().seconds - before.seconds;
    voxels += stock->statistics().voxel_updates - before.voxel_updates;
    blocks += finish.sweeps.size();
    state.PauseTiming();
    stock.reset();
    state.ResumeTiming();
  }
  state.counters["blocks_per_s"] = static_cast<double>(blocks) / seconds;
  state.counters["sweeps_per_block"] =
      static_cast<double>(sweeps.size()) / static_cast<double>(finish.sweeps.size());
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

/// Poses 1 mm apart on a zigzag over a block of 100 x 100 mm: rows 2 mm apart, the axis upright.
std::vector<ToolPose> zigzag_poses(const std::function<double(double, double)>& height) {
  std::vector<ToolPose> poses;
  for (int row = 0; row <= 50; ++row) {
    for (int i = 0; i <= 100; ++i) {
      const double x = row % 2 == 0 ? i : 100 - i, y = 2.0 * row;
      poses.push_back({{x, y, height(x, y)}, Vec3::UnitZ()});
    }
  }
  return poses;
}

void run_three_axes(benchmark::State& state, const std::vector<ToolPose>& poses,
                    const stock::CutterSolid& cutter) {
  set_thread_count(static_cast<int>(state.range(1)));
  constexpr double kTolerance = 1e-3;
  const std::vector<uint8_t> breaks(poses.size(), 0);
  std::vector<stock::Sweep> blocks;
  for (size_t i = 0; i + 1 < poses.size(); ++i)
    blocks.push_back({poses[i], poses[i + 1], static_cast<uint32_t>(i)});
  const Box box{{0, 0, 0}, {100, 100, 20}};
  double seconds = 0.0;
  size_t sweeps = 0;
  for (auto _ : state) {
    state.PauseTiming();
    stock::Stock stock(box, 0.1);
    state.ResumeTiming();
    const auto begun = std::chrono::steady_clock::now();
    if (state.range(0) != 0) {
      const stock::MergedSweeps merged = stock::merge_sweeps(poses, breaks, cutter.height, kTolerance);
      stock.cut(merged.sweeps, cutter);
      sweeps = merged.sweeps.size();
    } else {
      stock.cut(blocks, cutter);
      sweeps = blocks.size();
    }
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  }
  state.counters["blocks_per_s"] =
      static_cast<double>(blocks.size()) * static_cast<double>(state.iterations()) / seconds;
  state.counters["sweeps"] = static_cast<double>(sweeps);
  set_thread_count(0);
}

/// 3-axis finishing at 0.1 mm: range(0): collinear blocks merged first (1 um), range(1): threads.
void cut_plane_3axis(benchmark::State& state) {
  run_three_axes(state, zigzag_poses([](double, double) { return 19.0; }), {5.0, 25.0});
}
void cut_wave_3axis(benchmark::State& state) {
  const auto wave = [](double x, double y) { return 18.5 + 0.5 * std::sin(x / 10.0) * std::cos(y / 15.0); };
  run_three_axes(state, zigzag_poses(wave), {5.0, 25.0});
}
#define THREE_AXES(name)                \
  BENCHMARK(name)                       \
      ->ArgNames({"merged", "threads"}) \
      ->Args({0, 1})                    \
      ->Args({0, 2})                    \
      ->Args({1, 1})                    \
      ->Args({1, 2})                    \
      ->Unit(benchmark::kMillisecond)   \
      ->UseRealTime()
THREE_AXES(cut_plane_3axis);
THREE_AXES(cut_wave_3axis);

/// The three-axis program of wave.py: blocks of 1 mm, rows 0.5 mm apart; range(0): voxel in um, range(1):
/// threads.
void cut_wave_rows(benchmark::State& state) {
  set_thread_count(static_cast<int>(state.range(1)));
  constexpr int kRows = 101, kAcross = 100;
  std::vector<stock::Sweep> blocks;
  const auto pose = [](int n) -> ToolPose {
    const int row = n / (kAcross + 1), i = n % (kAcross + 1);
    const double x = row % 2 == 0 ? i : kAcross - i, y = 51.0 * row / kRows;
    return {{x, y, -1.0 + 0.5 * std::sin(x / 10.0) * std::cos(y / 15.0)}, Vec3::UnitZ()};
  };
  for (int n = 0; n + 1 < kRows * (kAcross + 1); ++n)
    blocks.push_back({pose(n), pose(n + 1), static_cast<uint32_t>(n)});
  uint64_t visits = 0, voxels = 0;
  for (auto _ : state) {
    state.PauseTiming();
    stock::Stock stock({{-6, -6, -11}, {106, 56, 1}}, 1e-3 * static_cast<double>(state.range(0)));
    state.ResumeTiming();
    stock.cut(blocks, {5.0, 25.0});
    visits = stock.statistics().leaf_visits;
    voxels = stock.statistics().voxel_updates;
    state.PauseTiming();
    { const stock::Stock done = std::move(stock); }
    state.ResumeTiming();
  }
  const auto count = static_cast<double>(blocks.size());
  state.counters["blocks_per_s"] = benchmark::Counter(count, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["leaf_visits_per_block"] = static_cast<double>(visits) / count;
  state.counters["voxels_per_block"] = static_cast<double>(voxels) / count;
  set_thread_count(0);
}
BENCHMARK(cut_wave_rows)
    ->ArgNames({"voxel_um", "threads"})
    ->Args({100, 1})
    ->Args({100, 2})
    ->Args({200, 1})
    ->Args({200, 2})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// Cost of a block, late against early: 100 equal slots of 1000 blocks each, D10, 0.2 mm voxels. Median time
/// of the first and of the last five slots.
void cost_per_block(benchmark::State& state) {
  set_thread_count(static_cast<int>(state.range(0)));
  constexpr int kSlots = 100, kBlocks = 1000, kCompared = 5;
  std::vector<double> seconds(kSlots);
  for (auto _ : state) {
    stock::Stock stock({{0, 0, 0}, {110, 12.0 * kSlots, 8}}, 0.2);
    for (int slot = 0; slot < kSlots; ++slot) {
      std::vector<stock::Sweep> sweeps;
      const auto pose = [&](int i) {
        return ToolPose{{5 + 0.1 * i, 6 + 12.0 * slot, 5 + 1e-3 * (i % 2)}, Vec3::UnitZ()};
      };
      for (int i = 0; i < kBlocks; ++i) sweeps.push_back({pose(i), pose(i + 1), static_cast<uint32_t>(i)});
      const double before = stock.statistics().seconds;
      stock.cut(sweeps, {5.0, 25.0});
      seconds[static_cast<size_t>(slot)] = stock.statistics().seconds - before;
    }
  }
  const auto median = [&](auto first) {
    std::vector<double> part(first, first + kCompared);
    std::nth_element(part.begin(), part.begin() + kCompared / 2, part.end());
    return part[kCompared / 2] / kBlocks;
  };
  state.counters["first_us"] = 1e6 * median(seconds.begin());
  state.counters["last_us"] = 1e6 * median(seconds.end() - kCompared);
  state.counters["ratio"] = median(seconds.end() - kCompared) / median(seconds.begin());
  set_thread_count(0);
}
BENCHMARK(cost_per_block)
    ->ArgNames({"threads"})
    ->Arg(1)
    ->Arg(2)
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// Control cycles of 1 ms at 50 mm/s, rays every 0.2 mm; range(0): threads.
void cut_dexels(benchmark::State& state) {
  set_thread_count(static_cast<int>(state.range(0)));
  const Path path = dome_path(0.05);
  uint64_t rays = 0;
  for (auto _ : state) {
    state.PauseTiming();
    auto dexels = std::make_unique<stock::SurfaceDexels>(dome(), 0.2, kBox);
    state.ResumeTiming();
    dexels->cut(path.sweeps, kCutter);
    rays += dexels->ray_updates();
    state.PauseTiming();
    dexels.reset();
    state.ResumeTiming();
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
