// What a cell of the proof asks of the sweeps beside it: bounds by their lowest planes, many at once and one
// after the other, and what one of them covers. Time per sweep.
#include <benchmark/benchmark.h>

#include <numeric>
#include <vector>

#include "base/rng.h"
#include "measure/bottom_planes.h"
#include "measure/height_bounds.h"
#include "unit/measure/dome_cut.h"

namespace swarf::measure {
namespace {

constexpr size_t kSweeps = 80;  // of a cell of the dome

/// 0.1 mm of the dome, and sweeps of a flat end that stands on it, leaning a little.
struct Case {
  DesignCell cell;
  std::vector<stock::Sweep> sweeps;
  std::vector<NearSweep> near;
  BottomPlanes planes;
  ColumnDepths depths{{stock::kSkin, stock::kSkin, stock::kSkin}, {}};

  Case() {
    const surface::SurfacePtr design = dome();
    const Vec2 uv(0.3, 0.4);
    constexpr double kPart = 1e-3;
    const auto corner = [&](double u, double v) {
      const Vec2 at = uv + kPart * Vec2(u, v);
      const surface::Derivatives d = design->derivatives(at.x(), at.y());
      return CellCorner{d.S, surface::outward_normal(*design, d, at), at};
    };
    PatchBounds bounds{design, design->bend_bounds(uv, uv + Vec2(kPart, kPart)), 3.0, 3.0};
    cell = make_cell({corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0)}, bounds);
    Rng rng(3);
    for (uint32_t n = 0; n < kSweeps; ++n) {
      const Vec3 aside = 4.0 * rng.direction().cross(cell.mean_normal()) + 0.05 * cell.mean_normal();
      const auto pose = [&](double by) {
        return ToolPose{cell.centroid() + aside + by * Vec3::UnitX(),
                        (cell.mean_normal() + 1e-3 * (1.0 + by) * rng.direction()).normalized()};
      };
      sweeps.push_back({pose(0.0), pose(0.05), n});
      near.push_back({stock::sweep_map(sweeps.back()), &kCutter, n, true});
    }
    std::vector<uint32_t> numbers(kSweeps);
    std::iota(numbers.begin(), numbers.end(), 0u);
    planes.add(numbers, sweeps, SweepCutters(kCutter));
  }
};

void count(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(kSweeps));
}

void bounds_at_once(benchmark::State& state) {
  const Case one;
  std::vector<double> heights;
  for (auto _ : state) {
    cell_heights(one.cell, one.depths, one.planes.from(0), kSweeps, heights);
    benchmark::DoNotOptimize(heights.data());
  }
  count(state);
}
BENCHMARK(bounds_at_once);

void bounds_one_by_one(benchmark::State& state) {
  const Case one;
  for (auto _ : state)
    for (const NearSweep& near : one.near)
      benchmark::DoNotOptimize(least_height(one.cell, near, one.depths, -5e-5));
  count(state);
}
BENCHMARK(bounds_one_by_one);

void covered(benchmark::State& state) {
  const Case one;
  for (auto _ : state)
    for (const NearSweep& near : one.near)
      benchmark::DoNotOptimize(
          covered_from(one.cell, near, kCutter.pieces.front(), {-0.1, -0.1, -0.1}, {1.0, 1.0, 1.0}));
  count(state);
}
BENCHMARK(covered);

}  // namespace
}  // namespace swarf::measure

BENCHMARK_MAIN();
