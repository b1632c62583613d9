#include "reports/movie_stock.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <initializer_list>

#include "base/hash.h"
#include "base/parallel.h"
#include "mesh/mesh_ops.h"
#include "render/figures/colour.h"
#include "reports/part_view.h"
#include "sim/run/measured_mesh.h"

namespace swarf::reports {
namespace {

/// Of the movie's voxel: far below a pixel, while flat sides become a few triangles.
constexpr double kThinVoxels = 0.05;
/// A vertex nearer than this to the finished surface, in voxels of the movie, lies on it.
constexpr double kFinishedVoxels = 0.15;
constexpr int8_t kNoTool = -1;
/// Along the stock's longest side: more of them are drawn slower than they are made.
constexpr int kPatchesAlong = 16;

/// Of all patches of all movies, so that renderers can trust it.
std::atomic<uint64_t> last_revision{0};

/// Of the surfaces that each tool has cut, linear; they repeat.
constexpr std::array<render::Rgb, 6> kToolColours{{{0.16F, 0.36F, 0.62F},
                                                   {0.70F, 0.33F, 0.06F},
                                                   {0.15F, 0.45F, 0.20F},
                                                   {0.48F, 0.16F, 0.42F},
                                                   {0.62F, 0.53F, 0.08F},
                                                   {0.07F, 0.47F, 0.50F}}};

std::array<uint8_t, 4> colour_of(int8_t tool) {
  if (tool == kNoTool) return render::srgb8_from_linear(kStockMaterial.colour);
  return render::srgb8_from_linear(kToolColours[static_cast<size_t>(tool) % kToolColours.size()]);
}

uint64_t key_of(std::initializer_list<std::array<float, 3>> vectors) {
  Hash hash;
  for (const auto& v : vectors)
    for (const float c : v) hash.add(c);
  return hash.value();
}

/// What was kept under a key, of a list in the order of its keys; null: nothing.
template <typename Value>
const Value* kept_under(const std::vector<std::pair<uint64_t, Value>>& kept, uint64_t key) {
  const auto found = std::lower_bound(kept.begin(), kept.end(), key,
                                      [](const auto& one, uint64_t k) { return one.first < k; });
  return found != kept.end() && found->first == key ? &found->second : nullptr;
}

template <typename Value>
void sort_by_key(std::vector<std::pair<uint64_t, Value>>& kept) {
  std::sort(kept.begin(), kept.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
}

/// Of patches, leaf positions.
int patch_side(const stock::Stock& stock) {
  return (stock::StockMesher::leaves_along(stock) + kPatchesAlong - 1) / kPatchesAlong;
}

bool one_colour(const TriMesh& mesh) {
  return std::all_of(mesh.colours.begin(), mesh.colours.end(),
                     [&](const auto& c) { return c == mesh.colours.front(); });
}

}  // namespace

void add_stock(const StockState& state, const std::vector<uint64_t>& revisions, const Pose& X_world,
               std::vector<render::DrawItem>& items) {
  for (size_t i = 0; i < state.size(); ++i) {
    if (!state[i] || state[i]->triangles.empty()) continue;
    render::DrawItem item{state[i].get(), X_world, kStockMaterial};
    item.revision = revisions[i];
    item.outside_only = true;
    items.push_back(item);
  }
}

MovieStock::MovieStock(const FinishedRun& run, sim::MovieColours colours)
    : run_(run),
      along_(run.job, run.carried, run.cycles, run.job.scene.movie.voxel_mm),
      mesher_(along_.stock(), patch_side(along_.stock())),
      colours_(colours),
      patches_(mesher_.patches()),
      revisions_(mesher_.patches(), 0),
      tools_(mesher_.patches()),
      deviations_(mesher_.patches()),
      cutting_(kNoTool) {}

void MovieStock::advance(const motion::Cycle& cycle) {
  along_.advance(cycle, [&](size_t tool) {
    const auto next = static_cast<int8_t>(tool);
    // What the tool before has cut is to have its colour.
    if (colours_ == sim::MovieColours::kTool && next != cutting_) mesh_changes();
    cutting_ = next;
  });
  mesh_changes();
}

void MovieStock::mesh_changes() {
  const std::vector<size_t> changed = mesher_.update();
  std::vector<std::shared_ptr<TriMesh>> made(changed.size());
  parallel_chunks(changed.size(), 1, [&](size_t i, size_t) {
    made[i] = std::make_shared<TriMesh>(mesher_.patch(changed[i]));
    if (colours_ == sim::MovieColours::kTool) colour_by_tool(changed[i], *made[i]);
    mesh::split_creases(*made[i], kCreaseRad);
  });
  if (colours_ == sim::MovieColours::kDeviation) colour_by_deviation(changed, made);
  parallel_chunks(changed.size(), 1, [&](size_t i, size_t) {
    if (one_colour(*made[i])) mesh::thin_for_display(*made[i], kThinVoxels * run_.job.scene.movie.voxel_mm);
  });
  for (size_t i = 0; i < changed.size(); ++i) {
    patches_[changed[i]] = std::move(made[i]);
    revisions_[changed[i]] = ++last_revision;
  }
  made_ += changed.size();
}

/// A vertex that stands where one stood keeps its tool; the others are of the tool at work.
void MovieStock::colour_by_tool(size_t number, TriMesh& mesh) {
  std::vector<std::pair<uint64_t, int8_t>>& before = tools_[number];
  const bool first = before.empty() && revisions_[number] == 0;
  std::vector<std::pair<uint64_t, int8_t>> now;
  for (const auto& position : mesh.positions) {
    const uint64_t key = key_of({position});
    const int8_t* const stood = kept_under(before, key);
    now.emplace_back(key, first ? kNoTool : stood != nullptr ? *stood : cutting_);
    mesh.colours.push_back(colour_of(now.back().second));
  }
  sort_by_key(now);
  before = std::move(now);
}

/// What lies on the finished surface by now shows its deviation; what is still to be cut is bare. A vertex
/// that stood there before is not measured again.
void MovieStock::colour_by_deviation(const std::vector<size_t>& changed,
                                     const std::vector<std::shared_ptr<TriMesh>>& made) {
  const double voxel = run_.job.scene.movie.voxel_mm;
  struct Place {
    size_t mesh, vertex, kept;  ///< kept: index into the patch's list
  };
  TriMesh fresh;
  std::vector<Place> places;
  std::vector<std::vector<std::pair<uint64_t, float>>> now(made.size());
  std::vector<std::vector<size_t>> vertices(made.size());  // of those lists
  for (size_t m = 0; m < made.size(); ++m) {
    TriMesh& mesh = *made[m];
    mesh.colours.assign(mesh.positions.size(), colour_of(kNoTool));
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
      const auto& p = mesh.positions[i];
      if (!(std::abs(run_.stock.distance_mm({p[0], p[1], p[2]})) < kFinishedVoxels * voxel)) continue;
      const uint64_t key = key_of({p, mesh.normals[i]});
      const float* const known = kept_under(deviations_[changed[m]], key);
      if (known == nullptr) {
        places.push_back({m, i, now[m].size()});
        fresh.positions.push_back(p);
        fresh.normals.push_back(mesh.normals[i]);
      }
      now[m].emplace_back(key, known == nullptr ? 0.0F : *known);
      vertices[m].push_back(i);
    }
  }
  if (measure_ == nullptr) {
    measure_ = std::make_unique<sim::MeshMeasure>(
        sim::MeasuredPart{run_.job, run_.cycles, run_.dexels, run_.carried, run_.rays, voxel, false});
    scale_ = deviation_scale(run_.job, run_.dexels);
  }
  measure_->measure(fresh);
  vertices_measured_ += places.size();
  for (size_t n = 0; n < places.size(); ++n)
    now[places[n].mesh][places[n].kept].second = fresh.deviation_um[n];
  for (size_t m = 0; m < made.size(); ++m) {
    for (size_t k = 0; k < now[m].size(); ++k) {
      const float um = now[m][k].second;
      if (std::isfinite(um))
        made[m]->colours[vertices[m][k]] = render::srgb8_from_linear(render::deviation_colour(um, scale_));
    }
    sort_by_key(now[m]);
    deviations_[changed[m]] = std::move(now[m]);
  }
}

}  // namespace swarf::reports
