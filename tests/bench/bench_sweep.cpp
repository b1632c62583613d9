// The kernels of the sweep alone: distance per voxel and ray per dexel, by cutter and motion.
//
// Instructions per voxel, where the kernel allows counters:
//   perf stat -e instructions,cycles build/release/tests/bench_sweep --benchmark_filter=NAME
// divided by the items that the benchmark prints.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <vector>

#include "base/rng.h"
#include "stock/level_set/convex_leaf.h"
#include "stock/level_set/leaf_kernel.h"
#include "stock/rays/ray_height.h"
#include "stock/sweep/sweep_distance.h"
#include "unit/stock/cutter_shapes.h"

namespace swarf::stock {
namespace {

constexpr double kVoxel = 0.1, kBand = 0.3;
constexpr int kCases = 256;

enum Shape { kFlat, kBall, kBullNose, kTaper };

CutterSolid cutter_of(int64_t shape) {
  switch (shape) {
    case kBall:
      return ball_nose(5.0, 25.0);
    case kBullNose:
      return bull_nose(5.0, 1.0, 25.0);
    case kTaper:
      return taper(2.0, 10.0, 25.0);
    default:
      return {5.0, 25.0};
  }
}

/// Blocks of 1 mm, level, with an axis that turns by 0.3 deg per block where `turning`.
Sweep block_of(Rng& rng, bool turning) {
  const double angle = rng.uniform(0.0, 2.0 * kPi);
  Sweep sweep{{Vec3::Zero(), Vec3::UnitZ()}, {{std::cos(angle), std::sin(angle), 0}, Vec3::UnitZ()}, 0};
  if (turning) sweep.end.axis_W = (Vec3::UnitZ() + 0.005 * rng.direction()).normalized();
  return sweep;
}

struct LeafCase {
  SweepMap map;
  LeafPlace place;
};

/// Leaves within the lowest 2 mm of the cutter whose band the sweep's surface passes.
std::vector<LeafCase> leaves_of(const CutterSolid& cutter, bool turning) {
  Rng rng(5);
  std::vector<LeafCase> cases;
  while (cases.size() < kCases) {
    const SweepMap map = sweep_map(block_of(rng, turning));
    const Vec3 first(rng.uniform(-6, 6), rng.uniform(-6, 6), rng.uniform(-0.5, 2.0));
    const LeafPlace place{first, kVoxel, kBand};
    float values[kLeafVoxels];
    std::fill(std::begin(values), std::end(values), static_cast<float>(-kBand));
    cut_leaf_by_piece(values, place, map, cutter.pieces.front(), kAllSlices);
    const auto [least, most] = std::minmax_element(std::begin(values), std::end(values));
    if (*least < 0.0F && *most > 0.0F) cases.push_back({map, place});
  }
  return cases;
}

void count(benchmark::State& state, double items, const char* unit) {
  using benchmark::Counter;
  state.counters[unit] = Counter(items, Counter::kIsRate);
  state.counters["each"] = Counter(items, Counter::kIsRate | Counter::kInvert);
}

/// range(0): shape, range(1): the axis turns.
void convex_leaf(benchmark::State& state) {
  const CutterSolid cutter = cutter_of(state.range(0));
  const std::vector<LeafCase> cases = leaves_of(cutter, state.range(1) != 0);
  double voxels = 0.0, evaluations = 0.0;
  for (auto _ : state) {
    for (const LeafCase& c : cases) {
      float values[kLeafVoxels];
      std::fill(std::begin(values), std::end(values), static_cast<float>(-kBand));
      evaluations += cut_leaf_by_piece(values, c.place, c.map, cutter.pieces.front(), kAllSlices);
      benchmark::DoNotOptimize(values[0]);
      voxels += kLeafVoxels;
    }
  }
  count(state, voxels, "voxels_per_s");
  state.counters["evaluations_per_voxel"] = evaluations / voxels;
}
BENCHMARK(convex_leaf)
    ->ArgNames({"shape", "turning"})
    ->ArgsProduct({{kFlat, kBall, kBullNose, kTaper}, {0, 1}});

LeafMotion motion_of(const LeafCase& c, const CutterSolid& cutter) {
  LeafMotion m{};
  for (int k = 0; k < 3; ++k) {
    m.start[k] = static_cast<float>(c.map.start(c.place.first_W)[k]);
    m.end[k] = static_cast<float>(c.map.end(c.place.first_W)[k]);
    for (int a = 0; a < 3; ++a) {
      m.start_step[a][k] = static_cast<float>(kVoxel * c.map.R0t(k, a));
      m.end_step[a][k] = static_cast<float>(kVoxel * c.map.R1t(k, a));
    }
  }
  m.radius = static_cast<float>(cutter.radius);
  m.height = static_cast<float>(cutter.height);
  m.background = static_cast<float>(kBand);
  m.capped = false;
  return m;
}

/// The closed form of the flat end mill on the same leaves; range(0): the axis turns.
void cylinder_leaf(benchmark::State& state) {
  const CutterSolid cutter = cutter_of(kFlat);
  std::vector<LeafMotion> motions;
  for (const LeafCase& c : leaves_of(cutter, state.range(0) != 0)) motions.push_back(motion_of(c, cutter));
  const LeafKernel kernel = leaf_kernel_variants().front().kernel;
  double voxels = 0.0;
  for (auto _ : state) {
    for (const LeafMotion& motion : motions) {
      float values[kLeafVoxels];
      std::fill(std::begin(values), std::end(values), static_cast<float>(-kBand));
      kernel(values, motion, kAllPatches);
      voxels += kLeafVoxels;
      benchmark::DoNotOptimize(values[0]);
    }
  }
  count(state, voxels, "voxels_per_s");
}
BENCHMARK(cylinder_leaf)->ArgNames({"turning"})->Arg(0)->Arg(1);

/// Rays along z that the block passes; range(0): shape, range(1): the axis turns.
void ray_per_dexel(benchmark::State& state) {
  const CutterSolid cutter = cutter_of(state.range(0));
  Rng rng(6);
  std::vector<SweepMap> maps;
  std::vector<Vec3> feet;
  for (int n = 0; n < kCases; ++n) {
    maps.push_back(sweep_map(block_of(rng, state.range(1) != 0)));
    feet.push_back({rng.uniform(-6, 6), rng.uniform(-6, 6), rng.uniform(-0.5, 0.5)});
  }
  const Vec3 normal = Vec3(0.05, 0.02, 1.0).normalized();
  double rays = 0.0;
  for (auto _ : state) {
    for (int n = 0; n < kCases; ++n) {
      benchmark::DoNotOptimize(ray_height(feet[n], normal, maps[n], cutter));
    }
    rays += kCases;
  }
  count(state, rays, "rays_per_s");
}
BENCHMARK(ray_per_dexel)
    ->ArgNames({"shape", "turning"})
    ->ArgsProduct({{kFlat, kBall, kBullNose, kTaper}, {0, 1}});

}  // namespace
}  // namespace swarf::stock

BENCHMARK_MAIN();
