// Pictures of the dome at half its cut: a frame of the movie, what the movie pays beside drawing, and stills.
#include <benchmark/benchmark.h>

#include <array>
#include <memory>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "render/camera.h"
#include "render/movie/movie_writer.h"
#include "render/raster/raster_renderer.h"
#include "render/ray/still.h"
#include "reports/chips.h"
#include "reports/movie_camera.h"
#include "reports/movie_stock.h"
#include "reports/pictures.h"
#include "reports/storyboard.h"
#include "sim/simulation.h"

namespace swarf::reports {
namespace {

constexpr std::array<int, 2> kSize{1280, 720};
constexpr const char* kDome = SWARF_SOURCE_DIR "/scenes/lin_koren_dome/scene.toml";

/// The motion, without any cut: pictures make their own stock.
struct Dome {
  sim::Job job = sim::load_job(kDome, {});
  Progress progress;
  sim::MeasuredPath path = sim::move_tool(job, progress);
  stock::Stock raw = sim::starting_stock(job, *path.carried, 1.0);
  FinishedRun run{job, *path.cycles, raw, path.dexels, *path.carried};
  std::vector<PlannedFrame> frames = plan_frames(run, progress);
  ShotView view{run, "machine"};
};

const Dome& dome() {
  static const Dome made;
  return made;
}

/// The stock at half of the frames.
MovieStock& half_cut() {
  static MovieStock stock(dome().run, dome().job.scene.movie.colours);
  stock.advance(dome().frames[dome().frames.size() / 2].cycle);
  return stock;
}

/// The dome's finished stock, and chips that know from it how much is removed.
struct DomesChips {
  sim::Job job = sim::load_job(kDome, {"movie.chips=true"});
  sim::CutAlong along{job, *dome().path.carried, *dome().path.cycles, job.scene.movie.voxel_mm};
  FinishedRun run{job, *dome().path.cycles, along.stock(), dome().path.dexels, *dome().path.carried};

  DomesChips() {
    motion::CycleReader reader(run.cycles);
    along.advance_whole(reader.at(run.cycles.size() - 1));
  }
};

const FinishedRun& run_with_chips() {
  static const DomesChips made;
  return made.run;
}

render::DrawList frame_list(bool with_chips) {
  const MovieStock& stock = half_cut();
  const PlannedFrame& frame = dome().frames[dome().frames.size() / 2];
  std::vector<Chip> chips;
  if (with_chips) chips = Chips(run_with_chips(), dome().frames).at(frame);
  return dome().view.list(frame, sim::MovieView::kMachine, kSize, stock.state(), stock.revisions(), {},
                          chips);
}

/// range(0): samples a pixel; range(1): with chips.
void BM_Frame(benchmark::State& state) {
  const render::DrawList list = frame_list(state.range(1) != 0);
  render::RasterRenderer renderer(kSize[0], kSize[1], static_cast<int>(state.range(0)));
  renderer.draw(list);  // meshes are sent, shaders compiled
  render::Image image;
  for (auto _ : state) image = renderer.draw(list);
  state.counters["items"] = static_cast<double>(list.items.size());
}

/// Ten frames' chips: their stock and the ticks; per frame.
void BM_ChipsOfAFrame(benchmark::State& state) {
  constexpr size_t kFrames = 10;
  const std::vector<PlannedFrame>& frames = dome().frames;
  for (auto _ : state) {
    state.PauseTiming();
    Chips chips(run_with_chips(), frames);
    const size_t middle = frames.size() / 2;
    chips.at(frames[middle]);
    state.ResumeTiming();
    for (size_t f = 1; f <= kFrames; ++f) benchmark::DoNotOptimize(chips.at(frames[middle + f]));
  }
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations() * kFrames));
}

/// Ten frames' cut: what is cut, meshed again and thinned; per frame.
void BM_StockOfAFrame(benchmark::State& state) {
  constexpr size_t kFrames = 10;
  for (auto _ : state) {
    state.PauseTiming();
    const size_t middle = dome().frames.size() / 2;
    MovieStock stock(dome().run, dome().job.scene.movie.colours);
    stock.advance(dome().frames[middle].cycle);
    state.ResumeTiming();
    for (size_t f = 1; f <= kFrames; ++f) stock.advance(dome().frames[middle + f].cycle);
  }
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations() * kFrames));
}

void BM_Still(benchmark::State& state) {
  const PlannedFrame& frame = dome().frames[dome().frames.size() / 2];
  const TriMesh stock = stock_at(dome().run, frame.cycle);
  const MachineView view(dome().job);
  render::DrawList list;
  render::StillOptions options;
  options.samples_per_pixel = dome().job.scene.stills.samples;
  options.noise = 5.0;
  if (state.range(0) == 0) {
    list.items = view.items(frame.cycle.q, 0, &stock);
    list.camera = machine_camera(dome().run, "machine", kSize);
  } else {
    list.items.push_back({&stock, Pose::Identity(), {{0.56F, 0.57F, 0.59F}, 1.0F, 0.16F}});
    list.camera =
        render::look_at_box(dome().job.scene.stock.box_W, -camera_direction("iso"), 0.45, 16.0 / 9.0);
  }
  render::Image image;
  for (auto _ : state) image = render::render_still(list, options);
}

BENCHMARK(BM_Frame)
    ->ArgNames({"samples", "chips"})
    ->ArgsProduct({{1, 4}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(BM_StockOfAFrame)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Iterations(3);
BENCHMARK(BM_ChipsOfAFrame)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Iterations(3);
BENCHMARK(BM_Still)
    ->ArgName("part")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace swarf::reports

BENCHMARK_MAIN();
