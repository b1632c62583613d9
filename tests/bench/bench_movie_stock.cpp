// What a frame of a movie pays for its stock: where finished surfaces show their deviation from a mesh, and
// by the size of the part where the same is cut in each frame.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "../support/scratch.h"
#include "base/progress.h"
#include "mesh/mesh_io.h"
#include "reports/movie_stock.h"
#include "reports/storyboard.h"
#include "sim/simulation.h"

namespace swarf::reports {
namespace {

constexpr int kBlocksAcross = 50, kRows = 100;
constexpr double kWidth = 50.0, kDepth = 30.0, kBottom = -8.0, kMargin = 6.0;  // mm

double wave(double x, double y) {
  return -1.0 + 0.5 * std::sin(x / 10.0) * std::cos(y / 15.0);
}

/// A block with the wave on top; about so many triangles.
TriMesh wave_block(int triangles) {
  const double width = kWidth + 2.0 * kMargin, depth = kDepth + 2.0 * kMargin;
  const int rows = static_cast<int>(std::sqrt(0.5 * triangles * depth / width)),
            columns = static_cast<int>(rows * width / depth);
  TriMesh mesh;
  const auto add = [&](double x, double y, double z) {
    mesh.positions.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
    return static_cast<uint32_t>(mesh.positions.size() - 1);
  };
  std::vector<std::vector<uint32_t>> top(rows + 1);
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c <= columns; ++c) {
      const double x = width * c / columns - kMargin, y = depth * r / rows - kMargin;
      top[r].push_back(add(x, y, wave(x, y)));
    }
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      mesh.triangles.push_back({top[r][c], top[r][c + 1], top[r + 1][c + 1]});
      mesh.triangles.push_back({top[r][c], top[r + 1][c + 1], top[r + 1][c]});
    }
  std::vector<uint32_t> rim;
  for (int c = 0; c < columns; ++c) rim.push_back(top[0][c]);
  for (int r = 0; r < rows; ++r) rim.push_back(top[r][columns]);
  for (int c = columns; c > 0; --c) rim.push_back(top[rows][c]);
  for (int r = rows; r > 0; --r) rim.push_back(top[r][0]);
  std::vector<uint32_t> low;
  for (const uint32_t i : rim) low.push_back(add(mesh.positions[i][0], mesh.positions[i][1], kBottom));
  const uint32_t middle = add(0.5 * kWidth, 0.5 * kDepth, kBottom);
  for (size_t i = 0; i < rim.size(); ++i) {
    const size_t next = (i + 1) % rim.size();
    mesh.triangles.push_back({rim[i], low[i], low[next]});
    mesh.triangles.push_back({rim[i], low[next], rim[next]});
    mesh.triangles.push_back({middle, low[next], low[i]});
  }
  return mesh;
}

std::string wave_program() {
  std::string text =
      "G21 G90 G17 G94\nG54\nT1 M6\nG43 H1\nS8000 M3\nG0 X0 Y0\nG0 Z10\nG1 Z-1 F500\nG1 F2000\n";
  for (int row = 0; row < kRows; ++row)
    for (int c = 0; c <= kBlocksAcross; ++c) {
      const double x = kWidth * (row % 2 == 0 ? c : kBlocksAcross - c) / kBlocksAcross,
                   y = kDepth * row / kRows;
      text += fmt::format("X{:.4f} Y{:.4f} Z{:.4f}\n", x, y, wave(x, y));
    }
  return text + "G0 Z20\nM30\n";
}

size_t patches_drawn(const StockState& state) {
  return static_cast<size_t>(std::count_if(state.begin(), state.end(), [](const auto& patch) {
    return patch != nullptr && !patch->triangles.empty();
  }));
}

constexpr const char* kScene = R"(machine = "mill_3axis"
nc = "wave.ngc"
dialect = "linuxcnc"
[cutter]
number = 1
shape = "ball"
diameter_mm = 10
flute_length_mm = 25
length_mm = 60
[setup]
work_origin_mm = "on_table"
[stock]
box_mm = [[-6, -6, -8], [56, 36, 1]]
voxel_mm = 0.5
[design]
mesh = "design.stl"
pitch_mm = 1
[movie]
seconds = 10
speed = "cutting"
colours = "deviation"
)";

/// The wave, cut.
struct WaveRun {
  explicit WaveRun(int triangles) {
    const std::filesystem::path folder = test::scratch_folder() / std::to_string(triangles);
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "wave.ngc") << wave_program();
    std::ofstream(folder / "scene.toml") << kScene;
    mesh::save_mesh((folder / "design.stl").string(), wave_block(triangles));
    job = sim::load_job((folder / "scene.toml").string(), {});
    result = sim::simulate(job, {}, progress);
  }

  sim::Job job;
  Progress progress;
  sim::Result result;
};

/// range(0): triangles of the design. Ten frames at the middle; per frame.
void BM_DeviationsOfAFrame(benchmark::State& state) {
  constexpr size_t kTimed = 10;
  const WaveRun wave(static_cast<int>(state.range(0)));
  const sim::Result& result = wave.result;
  FinishedRun run{wave.job, *result.main.cycles, *result.stock, result.main.dexels, *result.main.carried};
  run.rays = &result.main.rays;
  Progress progress;
  const std::vector<PlannedFrame> frames = plan_frames(run, progress);
  size_t vertices = 0, patches = 0, all = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const size_t middle = frames.size() / 2;
    MovieStock stock(run, state.range(1) == 0 ? sim::MovieColours::kMaterial : sim::MovieColours::kDeviation);
    stock.advance(frames[middle].cycle);
    vertices = stock.vertices_measured();
    patches = stock.patches_made();
    state.ResumeTiming();
    for (size_t f = 1; f <= kTimed; ++f) stock.advance(frames[middle + f].cycle);
    vertices = stock.vertices_measured() - vertices;
    patches = stock.patches_made() - patches;
    all = patches_drawn(stock.state());
  }
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations() * kTimed));
  state.counters["vertices"] = static_cast<double>(vertices) / kTimed;
  state.counters["patches_pct"] = 100.0 * static_cast<double>(patches) / static_cast<double>(kTimed * all);
}

BENCHMARK(BM_DeviationsOfAFrame)
    ->ArgNames({"triangles", "deviation"})
    ->ArgsProduct({{10000, 100000, 300000}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Iterations(3);

/// A plate that a flat end mill faces in rows over its whole length, a millimetre deep.
sim::Job plate(int side) {
  const std::filesystem::path folder = test::scratch_folder() / fmt::format("plate_{}", side);
  std::filesystem::create_directories(folder);
  std::string program = "G21 G90 G17 G94\nG54\nT1 M6\nG43 H1\nS8000 M3\nG0 X0 Y0\nG0 Z10\nG1 Z-1 F2000\n";
  for (int row = 0; 6 * row <= side; ++row)
    program += fmt::format("G1 Y{} F2000\nG1 X{}\n", 6 * row, row % 2 == 0 ? side : 0);
  std::ofstream(folder / "plate.ngc") << program << "G0 Z20\nM30\n";
  std::ofstream(folder / "scene.toml") << fmt::format(R"(machine = "mill_3axis"
nc = "plate.ngc"
dialect = "linuxcnc"
[cutter]
number = 1
diameter_mm = 10
flute_length_mm = 25
length_mm = 60
[setup]
work_origin_mm = "on_table"
[stock]
box_mm = [[0, 0, -20], [{0}, {0}, 0]]
voxel_mm = 1
[design]
kind = "none"
[movie]
voxel_mm = 0.8
)",
                                                      side);
  return sim::load_job((folder / "scene.toml").string(), {});
}

/// Frames from the middle of a motion on, `step` cycles apart: what of the stock is made again, and for how
/// long.
void remesh(benchmark::State& state, const sim::Job& job, size_t step) {
  constexpr size_t kTimed = 20;
  Progress progress;
  const sim::MeasuredPath path = sim::move_tool(job, progress);
  const stock::Stock finished = sim::starting_stock(job, *path.carried, job.scene.movie.voxel_mm);
  const FinishedRun run{job, *path.cycles, finished, {}, *path.carried};
  const size_t middle = path.cycles->size() / 2;
  motion::CycleReader reader(*path.cycles);
  // Counted beside what is timed.
  sim::CutAlong along(job, *path.carried, *path.cycles, job.scene.movie.voxel_mm);
  stock::StockMesher mesher(along.stock());
  along.advance(reader.at(middle));
  mesher.update();
  size_t leaves = 0;
  for (size_t f = 1; f <= kTimed; ++f) {
    along.advance(reader.at(middle + f * step));
    mesher.update();
    leaves += mesher.leaves_meshed();
  }
  size_t patches = 0, all = 0;
  for (auto _ : state) {
    state.PauseTiming();
    MovieStock stock(run, sim::MovieColours::kMaterial);
    stock.advance(reader.at(middle));
    patches = stock.patches_made();
    state.ResumeTiming();
    for (size_t f = 1; f <= kTimed; ++f) stock.advance(reader.at(middle + f * step));
    patches = stock.patches_made() - patches;
    all = patches_drawn(stock.state());
  }
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations() * kTimed));
  state.counters["leaves"] = static_cast<double>(leaves) / kTimed;
  state.counters["leaves_pct"] =
      100.0 * static_cast<double>(leaves) / static_cast<double>(kTimed * along.stock().leaves());
  state.counters["patches"] = static_cast<double>(patches) / kTimed;
  state.counters["patches_pct"] = 100.0 * static_cast<double>(patches) / static_cast<double>(kTimed * all);
}

/// range(0): side of the plate, mm. Each frame cuts 4 mm on.
void BM_RemeshByThePartsSize(benchmark::State& state) {
  constexpr size_t kCycles = 120;  // at 2000 mm/min and 1 ms
  remesh(state, plate(static_cast<int>(state.range(0))), kCycles);
}
BENCHMARK(BM_RemeshByThePartsSize)
    ->ArgName("side")
    ->Arg(50)
    ->Arg(100)
    ->Arg(200)
    ->Arg(400)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Iterations(3);

/// The dome in 300 frames.
void BM_RemeshOfTheDome(benchmark::State& state) {
  const sim::Job job = sim::load_job(SWARF_SOURCE_DIR "/scenes/lin_koren_dome/scene.toml", {});
  constexpr size_t kFrames = 300;
  Progress progress;
  remesh(state, job, sim::move_tool(job, progress).cycles->size() / kFrames);
}
BENCHMARK(BM_RemeshOfTheDome)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Iterations(3);

}  // namespace
}  // namespace swarf::reports

BENCHMARK_MAIN();
