#include <algorithm>
#include <chrono>
#include <deque>
#include <future>
#include <map>
#include <optional>

#include "base/parallel.h"
#include "render/movie/movie_writer.h"
#include "render/raster/raster_renderer.h"
#include "reports/chips.h"
#include "reports/movie_camera.h"
#include "reports/movie_overlay.h"
#include "reports/movie_stock.h"
#include "reports/pictures.h"
#include "reports/storyboard.h"

namespace swarf::reports {
namespace {

/// Drawn at once, each by a renderer of its own: the software renderer's vertex work keeps one processor.
constexpr int kLanesMost = 2;
/// Points of the trail between two frames.
constexpr size_t kTrailSteps = 16;

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Where the tip has been in the last seconds of the program, work frame.
class Trail {
 public:
  explicit Trail(const FinishedRun& run) : reader_(run.cycles) {}

  std::vector<Vec3> up_to(const PlannedFrame& frame, double seconds) {
    if (seconds <= 0.0) return {};
    const size_t now = frame.cycle.number;
    if (frame.shot != shot_ || (last_ && now < *last_)) tips_.clear();
    const size_t from = tips_.empty() || !last_ ? now : *last_ + 1;
    const size_t step = std::max<size_t>(1, (now + 1 - std::min(from, now)) / kTrailSteps);
    for (size_t k = from; k < now; k += step) add(reader_.at(k).sample);
    add(frame.cycle.sample);
    while (tips_.front().first < frame.cycle.sample.t_s - seconds) tips_.pop_front();
    shot_ = frame.shot;
    last_ = now;
    std::vector<Vec3> points;
    for (const auto& [t, tip] : tips_) points.push_back(tip);
    return points;
  }

 private:
  void add(const motion::ToolSample& sample) { tips_.emplace_back(sample.t_s, sample.pose.tip_W); }

  motion::CycleReader reader_;
  std::deque<std::pair<double, Vec3>> tips_;  ///< time and place
  size_t shot_ = 0;
  std::optional<size_t> last_;
};

/// The stock at each frame; a shot that goes back in time begins with a new one.
class StockAlong {
 public:
  explicit StockAlong(const FinishedRun& run) : run_(run) {}
  const MovieStock& at(const motion::Cycle& cycle) {
    if (!stock_ || cycle.number < last_)
      stock_ = std::make_unique<MovieStock>(run_, run_.job.scene.movie.colours);
    stock_->advance(cycle);
    last_ = cycle.number;
    return *stock_;
  }

 private:
  const FinishedRun& run_;
  std::unique_ptr<MovieStock> stock_;
  uint64_t last_ = 0;
};

/// Everything that a frame is drawn from, so that others can be prepared meanwhile.
struct FrameTask {
  size_t number = 0;
  StockState stock;
  std::vector<uint64_t> revisions;
  std::vector<Vec3> trail;
  std::vector<Chip> chips;
};

/// Draws frames one after the other.
class Lane {
 public:
  Lane(const FinishedRun& run, const ShotView& view, const std::vector<PlannedFrame>& frames,
       const MovieOverlay& overlay)
      : run_(run), view_(view), frames_(frames), overlay_(overlay) {}

  render::Image draw(const FrameTask& task) {
    const sim::MovieSettings& movie = run_.job.scene.movie;
    const sim::MovieView kind = movie.shots[frames_[task.number].shot].view;
    render::Image image = kind == sim::MovieView::kSplit ? split(task) : picture(task, kind, movie.size);
    if (movie.overlay) overlay_.draw(task.number, image);
    return image;
  }

 private:
  render::Image picture(const FrameTask& task, sim::MovieView kind, const std::array<int, 2>& size) {
    const auto [renderer, made] = renderers_.try_emplace(size);
    if (made)
      renderer->second =
          std::make_unique<render::RasterRenderer>(size[0], size[1], run_.job.scene.movie.samples);
    return renderer->second->draw(
        view_.list(frames_[task.number], kind, size, task.stock, task.revisions, task.trail, task.chips));
  }

  /// Machine on the left, part on the right.
  render::Image split(const FrameTask& task) {
    const std::array<int, 2> size = run_.job.scene.movie.size, half{size[0] / 2, size[1]};
    const render::Image left = picture(task, sim::MovieView::kMachine, half),
                        right = picture(task, sim::MovieView::kPart, {size[0] - half[0], size[1]});
    render::Image both{size[0], size[1], {}};
    both.rgba.reserve(size_t{4} * size[0] * size[1]);
    for (int y = 0; y < size[1]; ++y) {
      for (const render::Image* side : {&left, &right}) {
        const auto row = side->rgba.begin() + static_cast<std::ptrdiff_t>(4) * side->width * y;
        both.rgba.insert(both.rgba.end(), row, row + static_cast<std::ptrdiff_t>(4) * side->width);
      }
    }
    return both;
  }

  const FinishedRun& run_;
  const ShotView& view_;
  const std::vector<PlannedFrame>& frames_;
  const MovieOverlay& overlay_;
  std::map<std::array<int, 2>, std::unique_ptr<render::RasterRenderer>> renderers_;
};

}  // namespace

RenderStatistics make_movie(const FinishedRun& run, const std::string& path, const std::string& camera_name,
                            Progress& progress) {
  const sim::MovieSettings& settings = run.job.scene.movie;
  const std::vector<PlannedFrame> frames = plan_frames(run, progress);
  const MovieOverlay overlay(run, frames);
  const ShotView view(run, camera_name);
  render::MovieWriter movie(path, settings.size[0], settings.size[1], settings.fps, overlay.tools());
  std::vector<std::unique_ptr<Lane>> lanes;
  for (int i = 0; i < std::clamp(thread_count(), 1, kLanesMost); ++i)
    lanes.push_back(std::make_unique<Lane>(run, view, frames, overlay));
  StockAlong stock(run);
  Trail trail(run);
  Chips chips(run, frames);
  std::deque<std::future<render::Image>> drawing;
  std::vector<double> times;
  auto start = std::chrono::steady_clock::now();
  const auto drawn = [&] {
    render::Image image = drawing.front().get();
    drawing.pop_front();
    return image;
  };
  const auto add = [&](const render::Image& image) {
    movie.add(image);
    const auto now = std::chrono::steady_clock::now();
    times.push_back(1e3 * std::chrono::duration<double>(now - start).count());
    start = now;
    progress.advance(static_cast<double>(times.size()));
  };
  progress.begin("movie", static_cast<double>(frames.size()), "frames");
  for (size_t f = 0; f < frames.size() && !progress.stop_requested(); ++f) {
    const MovieStock& now = stock.at(frames[f].cycle);
    FrameTask task{f, now.state(), now.revisions(),
                   trail.up_to(frames[f], settings.shots[frames[f].shot].trail_s), chips.at(frames[f])};
    // The lane goes on before its last picture is encoded.
    std::optional<render::Image> last;
    if (drawing.size() == lanes.size()) last = drawn();
    drawing.push_back(std::async(std::launch::async, [lane = lanes[f % lanes.size()].get(),
                                                      task = std::move(task)] { return lane->draw(task); }));
    if (last) add(*last);
  }
  while (!drawing.empty()) add(drawn());
  progress.end();
  if (times.empty()) return {};
  movie.finish();
  return {static_cast<int>(times.size()), median(times), times.size() == frames.size()};
}

}  // namespace swarf::reports
