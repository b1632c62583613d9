#include "reports/storyboard.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "sim/run/shot_places.h"

namespace swarf::reports {
namespace {

using sim::MovieShot;
using sim::MovieSpeed;

/// How often the scan of a long program tells its progress, cycles.
constexpr size_t kScanStep = 100000;

std::vector<Stretch> stretches_of(const FinishedRun& run, const sim::CycleWindow& window,
                                  Progress& progress) {
  std::vector<Stretch> list;
  motion::CycleReader reader(run.cycles);
  progress.begin("storyboard", static_cast<double>(window.size()), "cycles");
  for (size_t k = window.first; k < window.end && !progress.stop_requested(); ++k) {
    const motion::ToolSample& sample = reader.at(k).sample;
    const bool cutting = sample.kind == motion::SampleKind::kCutting;
    if (list.empty() || list.back().element != sample.element || list.back().tool != sample.tool ||
        list.back().cutting != cutting)
      list.push_back({k, k, sample.element, sample.tool, cutting});
    list.back().end = k + 1;
    if (k % kScanStep == 0) progress.advance(static_cast<double>(k - window.first));
  }
  progress.end();
  return list;
}

/// Share of the frames that each stretch gets, not normalised.
std::vector<double> weights(const std::vector<Stretch>& stretches, MovieSpeed speed) {
  std::map<int, double> cut;  // cycles by tool
  double all = 0.0;
  for (const Stretch& s : stretches) {
    if (!s.cutting) continue;
    cut[s.tool] += static_cast<double>(s.end - s.first);
    all += static_cast<double>(s.end - s.first);
  }
  std::vector<double> result;
  for (const Stretch& s : stretches) {
    const auto size = static_cast<double>(s.end - s.first);
    if (speed == MovieSpeed::kTime) result.push_back(size);
    if (speed == MovieSpeed::kBlock) result.push_back(1.0);
    if (speed != MovieSpeed::kCutting) continue;
    // A part of the frames is dealt out evenly to the tools, the rest by how long each cuts.
    const double even = sim::kToolShare / static_cast<double>(std::max<size_t>(cut.size(), 1));
    result.push_back(s.cutting ? size * (even / cut[s.tool] + (1.0 - sim::kToolShare) / all) : 0.0);
  }
  return result;
}

std::vector<motion::Cycle> cycles_at(const FinishedRun& run, const std::vector<size_t>& numbers) {
  std::vector<motion::Cycle> list;
  motion::CycleReader reader(run.cycles);
  for (const size_t k : numbers) list.push_back(reader.at(k));
  return list;
}

std::vector<motion::Cycle> cycles_of_shot(const FinishedRun& run, const MovieShot& shot, size_t count,
                                          Progress& progress) {
  const bool placed = sim::has_places(shot);
  const sim::CycleWindow window =
      placed ? sim::shot_window(shot, run.cycles) : sim::CycleWindow{run.first_shown(), run.last_shown() + 1};
  if (count == 1) return cycles_at(run, {window.end - 1});  // one frame alone shows the end
  if (shot.speed == MovieSpeed::kTime && !placed) {
    std::vector<motion::Cycle> cycles = run.shown_cycles(count);
    cycles.resize(count, cycles.back());
    return cycles;
  }
  const std::vector<Stretch> stretches = shot.speed == MovieSpeed::kTime
                                             ? std::vector<Stretch>{{window.first, window.end}}
                                             : stretches_of(run, window, progress);
  const std::vector<size_t> numbers = spread_frames(stretches, shot.speed, count);
  if (!numbers.empty()) return cycles_at(run, numbers);
  throw sim::shot_cuts_nothing(shot);
}

}  // namespace

std::vector<size_t> spread_frames(const std::vector<Stretch>& stretches, MovieSpeed speed, size_t count) {
  const std::vector<double> weight = weights(stretches, speed);
  double all = 0.0;
  for (const double w : weight) all += w;
  if (!(all > 0.0)) return {};
  std::vector<size_t> frames;
  size_t i = 0;
  double before = 0.0;
  for (size_t f = 0; f < count; ++f) {
    const double at = all * (static_cast<double>(f) + 1.0) / static_cast<double>(count);
    while (i + 1 < weight.size() && (before + weight[i] < at || weight[i] == 0.0)) before += weight[i++];
    const double share = weight[i] > 0.0 ? std::clamp((at - before) / weight[i], 0.0, 1.0) : 1.0;
    const auto size = static_cast<double>(stretches[i].end - stretches[i].first);
    const auto step = static_cast<size_t>(std::max(std::ceil(share * size) - 1.0, 0.0));
    frames.push_back(std::max(stretches[i].first + step, frames.empty() ? size_t{0} : frames.back()));
  }
  return frames;
}

std::vector<PlannedFrame> plan_frames(const FinishedRun& run, Progress& progress) {
  const sim::MovieSettings& settings = run.job.scene.movie;
  std::vector<PlannedFrame> frames;
  for (size_t shot = 0; shot < settings.shots.size(); ++shot) {
    const double seconds = settings.shots[shot].seconds;
    const auto count = static_cast<size_t>(std::max(1.0, std::floor(seconds * settings.fps + 1e-9)));
    const std::vector<motion::Cycle> cycles = cycles_of_shot(run, settings.shots[shot], count, progress);
    for (size_t f = 0; f < count; ++f) {
      const double share = count == 1 ? 1.0 : static_cast<double>(f) / static_cast<double>(count - 1);
      frames.push_back({cycles[f], shot, share});
    }
  }
  return frames;
}

}  // namespace swarf::reports
