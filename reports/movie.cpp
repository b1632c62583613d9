#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <future>

#include "base/units.h"
#include "mesh/mesh_ops.h"
#include "render/lettering.h"
#include "render/movie/movie_writer.h"
#include "render/raster/raster_renderer.h"
#include "reports/part_view.h"
#include "reports/pictures.h"
#include "stock/mesher/stock_mesher.h"

namespace swarf::reports {
namespace {

/// The stock as the program cuts it, at the movie's own voxel size.
class MovieStock {
 public:
  explicit MovieStock(const FinishedRun& run)
      : stock_(sim::starting_stock(run.job, run.carried, run.job.scene.movie.voxel_mm)),
        all_(sim::stock_sweeps(run.job, run.cycles)),
        solids_(sim::tool_solids(run.job.scene)) {}

  /// Cuts everything up to and including this cycle and meshes what is left. Runs beside the drawing of the
  /// frame before: the software renderer's vertex work leaves the second processor idle.
  TriMesh at_cycle(const motion::Cycle& cycle) {
    size_t end = done_;
    while (end < all_.sweeps.size() && sim::is_done(all_.sources[all_.sweeps[end].block], cycle)) ++end;
    sim::for_each_tool(
        std::span(all_.sweeps).subspan(done_, end - done_),
        [&](uint32_t block) { return all_.sources[block].tool; },
        [&](size_t tool, std::span<const stock::Sweep> part) { stock_.cut(part, solids_[tool]); });
    done_ = end;
    TriMesh mesh = mesher_.mesh();
    mesh::split_creases(mesh, kCreaseRad);
    return mesh;
  }

 private:
  stock::Stock stock_;
  stock::StockMesher mesher_{stock_};
  sim::JobSweeps all_;
  std::vector<stock::CutterSolid> solids_;  ///< by tool
  size_t done_ = 0;
};

std::vector<std::string> caption(const FinishedRun& run, const motion::Cycle& cycle) {
  const motion::ToolSample& sample = cycle.sample;
  std::string axes;
  for (size_t a = 0; a < run.job.machine.model.axes.size(); ++a) {
    const kinematics::Axis& axis = run.job.machine.model.axes[a];
    const double q = cycle.q[static_cast<Eigen::Index>(a)];
    const bool rotary = axis.kind == kinematics::AxisKind::kRotary;
    axes += fmt::format("{}{} {:8.2f}{}", axes.empty() ? "" : "   ", axis.name, rotary ? deg_from_rad(q) : q,
                        rotary ? "°" : "");
  }
  const std::vector<cutter::Cutter>& tools = run.job.scene.tools;
  const std::string tool =
      tools.size() > 1 ? fmt::format("   {}", cutter::call_name(tools[static_cast<size_t>(sample.tool)]))
                       : "";
  return {
      fmt::format("t {:6.2f} s   F {:5.0f} mm/min{}", sample.t_s, mm_min_from_mm_s(sample.feed_mm_s), tool),
      axes};
}

/// One cycle for each frame; the last frame alone shows the end.
std::vector<motion::Cycle> shown_cycles(const FinishedRun& run, int frames) {
  if (frames == 1) return {motion::CycleReader(run.cycles).at(run.last_shown())};
  std::vector<motion::Cycle> cycles = run.shown_cycles(static_cast<size_t>(frames));
  cycles.resize(static_cast<size_t>(frames), cycles.back());
  return cycles;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

RenderStatistics make_movie(const FinishedRun& run, const std::string& path, const std::string& camera_name,
                            Progress& progress) {
  const sim::MovieSettings& settings = run.job.scene.movie;
  const MachineView view(run.job);
  MovieStock stock(run);
  render::RasterRenderer renderer(settings.size[0], settings.size[1], settings.samples);
  render::MovieWriter movie(path, settings.size[0], settings.size[1], settings.fps);
  const int frames = std::max(1, static_cast<int>(settings.seconds * settings.fps));
  const std::vector<motion::Cycle> shown = shown_cycles(run, frames);
  render::DrawList list;
  list.camera = machine_camera(run, camera_name, settings.size);
  std::vector<double> times;
  const auto mesh_for = [&](int frame) {
    return std::async(std::launch::async,
                      [&stock, &cycle = shown[static_cast<size_t>(frame)]] { return stock.at_cycle(cycle); });
  };
  progress.begin("movie", frames, "frames");
  std::future<TriMesh> next = mesh_for(0);
  for (int frame = 0; frame < frames && !progress.stop_requested(); ++frame) {
    const auto start = std::chrono::steady_clock::now();
    const motion::Cycle& cycle = shown[static_cast<size_t>(frame)];
    const TriMesh mesh = next.get();
    if (frame + 1 < frames) next = mesh_for(frame + 1);
    list.items = view.items(cycle.q, static_cast<size_t>(cycle.sample.tool), &mesh);
    render::Image image = renderer.draw(list);
    render::draw_caption(image, caption(run, cycle));
    movie.add(image);
    times.push_back(1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    progress.advance(frame + 1);
  }
  progress.end();
  if (times.empty()) return {};
  movie.finish();
  return {static_cast<int>(times.size()), median(times)};
}

}  // namespace swarf::reports
