// Positions of the calculator on triangle meshes, one thread: a wavy surface of 100 x 100 mm, along scan
// lines with what was touched last as a hint, and at random places without one; upright and tilted by 30
// degrees.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "base/rng.h"
#include "base/units.h"
#include "position/mesh_target.h"

namespace swarf::position {
namespace {

/// n x n squares of two triangles: 224 are 100 352 triangles of .45 mm.
TriMesh waves(int n) {
  TriMesh mesh;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const double x = 100.0 * i / n, y = 100.0 * j / n;
      const double z = 3.0 * std::sin(0.2 * x) * std::cos(0.15 * y) + 0.5 * std::sin(0.7 * x + 0.4 * y);
      mesh.positions.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
    }
  const auto at = [n](int i, int j) { return static_cast<uint32_t>(i * (n + 1) + j); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

cutter::Cutter tool(int64_t shape, std::string& name) {
  static const char* const names[] = {"flat D10", "ball D10", "bull nose D10 R2", "taper D4 R2 7 deg",
                                      "apt D12 R2 alpha 8 beta 15"};
  name = names[shape];
  cutter::Cutter c;
  c.flute_length_mm = 12.0;
  switch (shape) {
    case 1:
      c.shape = cutter::Shape::kBall;
      c.corner_radius_mm = 5.0;
      break;
    case 2:
      c.shape = cutter::Shape::kBullNose;
      c.corner_radius_mm = 2.0;
      break;
    case 3:
      c.shape = cutter::Shape::kTaper;
      c.diameter_mm = 4.0;
      c.corner_radius_mm = 2.0;
      c.taper_rad = rad_from_deg(7.0);
      break;
    case 4:
      c.shape = cutter::Shape::kApt;
      c.diameter_mm = 12.0;
      c.corner_radius_mm = 2.0;
      c.alpha_rad = rad_from_deg(8.0);
      c.beta_rad = rad_from_deg(15.0);
      break;
    default:
      break;
  }
  return c;
}

GuideLine line_at(double x, double y, bool tilted) {
  if (!tilted) return upright(x, y);
  return guide_line({x, y, 0.0}, {0.5, 0.0, std::sqrt(0.75)});
}

/// Lines .05 mm apart along y, .5 mm in x.
std::vector<GuideLine> scan(bool tilted) {
  std::vector<GuideLine> lines;
  for (double x = 10.0; x < 90.0; x += 5.0)
    for (double y = 10.0; y < 90.0; y += 0.05) lines.push_back(line_at(x, y, tilted));
  return lines;
}

std::vector<GuideLine> random_lines(bool tilted) {
  Rng rng(3);
  std::vector<GuideLine> lines(16384);
  for (GuideLine& line : lines) {
    const double x = rng.uniform(10.0, 90.0);
    line = line_at(x, rng.uniform(10.0, 90.0), tilted);
  }
  return lines;
}

const MeshTarget& target_of(int n) {
  static int made = 0;
  static std::unique_ptr<MeshTarget> target;
  if (made != n) target = std::make_unique<MeshTarget>(waves(n));
  made = n;
  return *target;
}

void rest_on_lines(benchmark::State& state, const MeshTarget& target, const std::vector<GuideLine>& lines,
                   bool hinted) {
  std::string name;
  const ToolProfile profile(tool(state.range(0), name));
  int near = -1;
  size_t i = 0;
  double sum = 0.0;
  for (auto _ : state) {
    Rest rest;
    if (!hinted) near = -1;
    target.raise(profile, lines[i], rest, near);
    sum += rest.height;
    if (++i == lines.size()) i = 0;
  }
  benchmark::DoNotOptimize(sum);
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations()));
  state.SetLabel(name);
}

void BM_ScanLine(benchmark::State& state) {
  rest_on_lines(state, target_of(224), scan(state.range(1) != 0), true);
}
void BM_Random(benchmark::State& state) {
  rest_on_lines(state, target_of(224), random_lines(state.range(1) != 0), false);
}
void BM_RandomOnMeshOf(benchmark::State& state) {
  const auto n = static_cast<int>(state.range(1));
  rest_on_lines(state, target_of(n), random_lines(false), false);
}

void BM_Build(benchmark::State& state) {
  const TriMesh mesh = waves(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(MeshTarget(mesh).tree().nodes().size());
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations() * mesh.triangles.size()));
}

BENCHMARK(BM_ScanLine)->ArgNames({"tool", "tilted"})->ArgsProduct({{0, 1, 2, 3, 4}, {0, 1}});
BENCHMARK(BM_Random)->ArgNames({"tool", "tilted"})->ArgsProduct({{0, 1, 2, 3, 4}, {0, 1}});
// 9 800, 100 352, 999 698 and 10 million triangles.
BENCHMARK(BM_RandomOnMeshOf)->ArgNames({"tool", "n"})->ArgsProduct({{1}, {70, 224, 707, 2236}});
BENCHMARK(BM_Build)->ArgName("n")->Arg(224)->Arg(707)->Arg(2236)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace swarf::position

int main(int argc, char** argv) {
  swarf::set_thread_count(1);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
