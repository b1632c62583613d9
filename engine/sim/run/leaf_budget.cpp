#include "sim/run/leaf_budget.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "base/diagnostics.h"
#include "sim/run/picture_memory.h"

namespace swarf::sim {
namespace {

constexpr double kBytesOfMb = 1024.0 * 1024.0;
constexpr uint32_t kUnused = std::numeric_limits<uint32_t>::max();

/// Seen from above, the places that the sweep may change, but for how far a turning one bows out of its ends:
/// what is wrong here costs time alone.
Box reach_of(const stock::Sweep& sweep, const stock::CutterSolid& solid) {
  Box box{sweep.start.tip_W, sweep.start.tip_W};
  for (const ToolPose& pose : {sweep.start, sweep.end})
    for (const double height : {0.0, solid.height}) {
      const Vec3 place = pose.tip_W + height * pose.axis_W;
      box.lower = box.lower.cwiseMin(place);
      box.upper = box.upper.cwiseMax(place);
    }
  box.lower.array() -= solid.radius;
  box.upper.array() += solid.radius;
  return box;
}

/// Index of a tile along one axis, within the stock.
int tile_at(double place, double lower, double side, int count) {
  return static_cast<int>(std::clamp(std::floor((place - lower) / side), 0.0, count - 1.0));
}

/// "; the movie's own stock ..." where that is most of what is needed: it does not go to the disk.
std::string movie_text(const Scene& scene, const MemoryPrediction& memory, double needed_mb) {
  constexpr double kMost = 0.5;
  const double movie_mb = movie_stock_mb(scene, memory.leaves);
  return memory.fixed_mb > movie_mb && movie_mb > kMost * needed_mb
             ? fmt::format(
                   "; {:.0f} MB of it are the movie's own stock: a movie.voxel_mm above {:g} takes less",
                   movie_mb, scene.movie.voxel_mm)
             : "";
}

}  // namespace

LeafBudget::LeafBudget(const Job& job, const CutParts& parts, const MemoryPrediction& memory,
                       std::string folder)
    : tiles_(stock::Stock::tiles_of(job.scene.stock.box_W, job.scene.stock.voxel_mm)) {
  spill_.folder = std::move(folder);
  find_uses(parts);
  const double of_step =
      memory.leaves * static_cast<double>(tiles_at_once()) / static_cast<double>(tiles_.size());
  const double room = (memory.limit_mb - memory.rest_mb) / memory.leaf_mb;
  if (room < of_step) {
    const double needed = std::ceil(memory.rest_mb + of_step * memory.leaf_mb);
    throw InputError(
        "out-of-memory", {job.scene.file},
        fmt::format("with --spill {:.0f} MB are expected to be needed, {:.0f} MB may be used", needed,
                    memory.limit_mb),
        fmt::format("--max-memory {:.0f} is enough{}", needed, movie_text(job.scene, memory, needed)));
  }
  // Those of the tiles that the next step cuts come to the ones that stay.
  spill_.leaves_most = static_cast<size_t>(room - of_step);
  require_disk(memory.leaves);
}

void LeafBudget::find_uses(const CutParts& parts) {
  steps_.resize(tiles_.size());
  for (size_t begin = 0; begin < parts.sweeps.size(); begin += kSweepsPerStep) {
    const auto step = static_cast<uint32_t>(begin / kSweepsPerStep);
    const size_t end = std::min(begin + kSweepsPerStep, parts.sweeps.size());
    parts.sweeps.for_each_tool(begin, end, [&](size_t tool, std::span<const stock::Sweep> sweeps) {
      for (const stock::Sweep& sweep : sweeps) {
        const Box box = reach_of(sweep, parts.solids[tool]);
        const auto x = [&](double at) {
          return tile_at(at, tiles_.lower_mm.x(), tiles_.side_mm, tiles_.count_x);
        };
        const auto y = [&](double at) {
          return tile_at(at, tiles_.lower_mm.y(), tiles_.side_mm, tiles_.count_y);
        };
        for (int i = x(box.lower.x()); i <= x(box.upper.x()); ++i)
          for (int j = y(box.lower.y()); j <= y(box.upper.y()); ++j) {
            std::vector<uint32_t>& steps = steps_[tiles_.index(i, j)];
            if (steps.empty() || steps.back() != step) steps.push_back(step);
          }
      }
    });
  }
}

size_t LeafBudget::tiles_at_once() const {
  std::vector<size_t> tiles;
  for (const std::vector<uint32_t>& steps : steps_)
    for (const uint32_t step : steps) {
      if (step >= tiles.size()) tiles.resize(step + 1, 0);
      ++tiles[step];
    }
  return tiles.empty() ? 0 : *std::max_element(tiles.begin(), tiles.end());
}

void LeafBudget::require_disk(double leaves) const {
  const double on_disk =
      std::max(0.0, leaves - 0.5 * static_cast<double>(spill_.leaves_most)) * stock::Stock::kLeafBytes;
  std::error_code unknown;
  const std::filesystem::space_info space = std::filesystem::space(spill_.folder, unknown);
  if (unknown || static_cast<double>(space.available) >= on_disk) return;
  throw InputError(
      "spill-disk-full", {spill_.folder},
      fmt::format("leaves of the stock are expected to take {:.0f} MB of the disk, {:.0f} MB are free",
                  on_disk / kBytesOfMb, static_cast<double>(space.available) / kBytesOfMb),
      "make room there, or name another folder with -o; or raise --max-memory");
}

void LeafBudget::make_room(stock::Stock& stock, size_t sweeps) const {
  std::vector<uint32_t> next_use(steps_.size(), kUnused);
  const auto now = static_cast<uint32_t>(sweeps / kSweepsPerStep);
  for (size_t tile = 0; tile < steps_.size(); ++tile) {
    const auto next = std::lower_bound(steps_[tile].begin(), steps_[tile].end(), now);
    if (next != steps_[tile].end()) next_use[tile] = *next;
  }
  stock.make_room(next_use);
}

}  // namespace swarf::sim
