// Cycles of the surface driven interpolator, position and speed control, one thread: whole passes of scenes
// whose part is surface patches, trimmed NURBS faces and a mesh of 100 352 triangles of .45 mm.
//
// Cycles are timed one by one in the thread's own processor time, in which waiting for the processor does not
// count; the clock adds about .2 us to each. Look-ahead is not in it.
#include <benchmark/benchmark.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "mesh/mesh_io.h"
#include "motion/passes/driven_interpolator.h"
#include "sim/job/driven_part.h"
#include "sim/job/scene.h"

namespace swarf::motion {
namespace {

double thread_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

double percentile(std::vector<double>& values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Appends what each cycle of each pass of the job takes, us.
void run_passes(const sim::Job& job, const toolpath::ToolPath& path, std::vector<double>& costs) {
  const kinematics::InverseKinematics inverse(job.machine.model);
  for (size_t i = 0; i < path.elements.size(); ++i) {
    const toolpath::DrivenPass* pass = path.elements.driven(i);
    if (pass == nullptr) continue;
    DrivenInterpolator driven(*pass, job.machine.model, inverse, job.scene.motion,
                              kinematics::AxisValues::Zero());
    for (bool finished = false; !finished;) {
      const double start = thread_us();
      finished = driven.step({}).finished;
      costs.push_back(thread_us() - start);
    }
  }
}

void run(benchmark::State& state, const std::string& scene, const std::vector<std::string>& overrides) {
  const sim::Job job = sim::load_job(scene, overrides);
  Diagnostics diagnostics;
  const toolpath::ToolPath path = sim::driven_path(job, 0.0, diagnostics);
  diagnostics.throw_if_errors();
  std::vector<double> costs;
  for (auto _ : state) {
    costs.clear();
    run_passes(job, path, costs);
  }
  state.counters["cycles"] = static_cast<double>(costs.size());
  state.counters["median_us"] = percentile(costs, 0.5);
  state.counters["p999_us"] = percentile(costs, 0.999);
  state.counters["greatest_us"] = *std::max_element(costs.begin(), costs.end());
}

/// n x n squares of two triangles over 100 x 100 mm, closed by walls and a bottom at z = -10.
TriMesh block_of_waves(int n) {
  TriMesh mesh;
  const auto at = [n](int i, int j, bool top) {
    return static_cast<uint32_t>(2 * (i * (n + 1) + j) + (top ? 1 : 0));
  };
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const double x = 100.0 * i / n, y = 100.0 * j / n;
      const double z = 3.0 * std::sin(0.2 * x) * std::cos(0.15 * y) + 0.5 * std::sin(0.7 * x + 0.4 * y);
      for (const double height : {-10.0, z})
        mesh.positions.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(height)});
    }
  const auto square = [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      square(at(i, j, true), at(i + 1, j, true), at(i + 1, j + 1, true), at(i, j + 1, true));
      square(at(i, j, false), at(i, j + 1, false), at(i + 1, j + 1, false), at(i + 1, j, false));
    }
    square(at(i, 0, false), at(i + 1, 0, false), at(i + 1, 0, true), at(i, 0, true));
    square(at(i + 1, n, false), at(i, n, false), at(i, n, true), at(i + 1, n, true));
    square(at(0, i + 1, false), at(0, i, false), at(0, i, true), at(0, i + 1, true));
    square(at(n, i, false), at(n, i + 1, false), at(n, i + 1, true), at(n, i, true));
  }
  return mesh;
}

void run_mesh(benchmark::State& state, const std::string& cutter) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "swarf_bench_driven";
  std::filesystem::create_directories(folder);
  mesh::save_mesh((folder / "waves.ply").string(), block_of_waves(224));
  std::ofstream(folder / "scene.toml")
      << "machine = \"mill_3axis\"\n[cutter]\nnumber = 1\n"
      << cutter
      << "flute_length_mm = 30\nshank_diameter_mm = 10\nlength_mm = 60\n[setup]\nwork_origin_mm = "
         "\"on_table\"\n"
         "[stock]\nbox_mm = [[0, 0, -10], [100, 100, 6]]\nvoxel_mm = 0.5\n[driven]\nmesh = \"waves.ply\"\n"
         "mode = \"scan\"\nangle_deg = 20\ninterval_mm = 25\nfeed_mm_min = 3000\nchord_tolerance_um = 0.1\n";
  run(state, (folder / "scene.toml").string(), {});
  std::filesystem::remove_all(folder);
}

const std::string kBall = "shape = \"ball\"\ndiameter_mm = 10\n";
const std::string kBullNose = "shape = \"bull_nose\"\ndiameter_mm = 10\ncorner_radius_mm = 2\n";
const std::string kScenes = SWARF_SOURCE_DIR "/scenes/";

BENCHMARK_CAPTURE(run, patches_ball, kScenes + "kato_step/scene.toml", {})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, patch_bull_nose_leaning, kScenes + "kato_five_axis/scene.toml", {})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, trimmed_faces_bull_nose, kScenes + "kato_mould/scene.toml", {})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run_mesh, mesh_100k_ball, kBall)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run_mesh, mesh_100k_bull_nose, kBullNose)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace swarf::motion

int main(int argc, char** argv) {
  swarf::set_thread_count(1);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
