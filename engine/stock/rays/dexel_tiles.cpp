#include "stock/rays/dexel_tiles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "stock/rays/dexel_kernel.h"
#include "stock/rays/ray_cut.h"
#include "stock/rays/surface_dexels.h"

namespace swarf::stock {
namespace {

constexpr size_t kRunsPerStretch = 32, kSweepsPerRun = 32, kSweepsPerGroup = 8;
constexpr size_t kMapsPerTask = 1024;

/// A tile's rays and their material by component; places beyond the tile's last ray repeat it and are not
/// stored.
struct Workspace {
  TileRays rays;
  TileHeights found;
  TileMaterial standing;
  alignas(64) double tops[kTileRays];  ///< greatest s with material, where some lies above gaps
  size_t index[kTileRays];
};

double top_of_ray(double height, const std::vector<MaterialAbove>& above, uint32_t n) {
  if (above.empty()) return height;
  const auto intervals = above_ray(above, n);
  return intervals.empty() ? height : intervals.back().high;
}

const DexelKernelVariant& fastest_kernel() {
  static const DexelKernelVariant kernel = dexel_kernel_variants().front();
  return kernel;
}

/// One tile while sweeps are taken out of it. Material that stands on the design and material above gaps have
/// bounds of their own: a cutter that finishes below an overhang meets the first only.
class TileCut {
 public:
  TileCut(const Material& material, size_t tile, const SweepChain& chain)
      : material_(material), above_(material.above[tile]), chain_(chain), tile_(material.field.tiles[tile]) {
    double highest = -std::numeric_limits<double>::infinity();
    for (uint32_t n = 0; n < tile_.count; ++n) highest = std::max(highest, material.heights[ray(n)]);
    set_bounds(highest);
  }
  ~TileCut() {
    if (loaded_) store();
  }
  TileCut(const TileCut&) = delete;
  TileCut& operator=(const TileCut&) = delete;

  bool misses(const SweepRun& run) const {
    return (run_misses(run, ball_, chain_.cutter) || run_above(tile_, run, highest_)) &&
           (extent_above_.empty() || run_misses(run, ball_above_, chain_.cutter));
  }

  /// Calls visit(n) for the runs of the stretches that may meet the tile.
  template <typename Visit>
  void each_run(const Visit& visit) const {
    for (size_t k = 0; k < chain_.stretches.size(); ++k) {
      if (misses(chain_.stretches[k])) continue;
      const size_t end = std::min((k + 1) * kRunsPerStretch, chain_.runs.size());
      for (size_t n = k * kRunsPerStretch; n < end; ++n) visit(n);
    }
  }

  void cut_by(const SweepRun& run) {
    for (size_t g = run.begin / kSweepsPerGroup; g * kSweepsPerGroup < run.end; ++g) {
      const SweepRun& group = chain_.groups[g];
      if (misses(group)) continue;
      for (size_t n = group.begin; n < group.end; ++n) cut_by(n);
    }
  }

  /// The run whose tip passes nearest to the tile's middle, among those that may meet it; runs.size() when
  /// none.
  size_t nearest_run() const {
    const Vec3 middle = tile_.origin + tile_.frame.transpose() * (0.5 * (tile_.low + tile_.high));
    size_t nearest = chain_.runs.size();
    double least = std::numeric_limits<double>::infinity();
    each_run([&](size_t n) {
      const double distance2 = (chain_.runs[n].tip - middle).squaredNorm();
      if (distance2 >= least || misses(chain_.runs[n])) return;
      least = distance2;
      nearest = n;
    });
    return nearest;
  }

  uint64_t pairs() const { return pairs_; }

 private:
  size_t ray(uint32_t n) const { return material_.field.order[tile_.begin + std::min(n, tile_.count - 1)]; }

  void set_bounds(double highest) {
    highest_ = highest;
    ball_ = ball_around(tile_, {-kSkin, std::max(highest, 0.0)});
    extent_above_ = {};
    for (const MaterialAbove& m : above_) {
      extent_above_.low = std::min(extent_above_.low, m.low);
      extent_above_.high = std::max(extent_above_.high, m.high);
    }
    if (!extent_above_.empty()) ball_above_ = ball_around(tile_, extent_above_);
  }

  void load() {
    for (uint32_t n = 0; n < kTileRays; ++n) {
      const size_t i = ray(n);
      const Vec3 &point = material_.field.points[i], &normal = material_.field.normals[i];
      w_.index[n] = i;
      w_.rays.px[n] = point.x();
      w_.rays.py[n] = point.y();
      w_.rays.pz[n] = point.z();
      w_.rays.nx[n] = normal.x();
      w_.rays.ny[n] = normal.y();
      w_.rays.nz[n] = normal.z();
      w_.standing.heights[n] = material_.heights[i];
      w_.standing.blocks[n] = material_.blocks[i];
      w_.tops[n] = top_of_ray(material_.heights[i], above_, n);
    }
    loaded_ = true;
  }

  void store() {
    for (uint32_t n = 0; n < tile_.count; ++n) {
      material_.heights[w_.index[n]] = w_.standing.heights[n];
      material_.blocks[w_.index[n]] = static_cast<uint32_t>(w_.standing.blocks[n]);
    }
  }

  void cut_by(size_t sweep) {
    const SweepMap& map = chain_.maps[sweep];
    const CutterSolid& cutter = chain_.cutter;
    const bool above = !extent_above_.empty() && !sweep_misses(map, ball_above_, cutter) &&
                       !beyond_top(tile_, map, extent_above_, cutter.height);
    if (!above && (sweep_misses(map, ball_, cutter) || plane_above(tile_, map, highest_))) return;
    if (!above && !chain_.cylinder && pieces_above(tile_, map, cutter, highest_)) return;
    if (!loaded_) load();
    pairs_ += kTileRays;
    if (!kernel_.plane_reaches(w_.rays, map, above_.empty() ? w_.standing.heights : w_.tops)) return;
    if (!cut_rays(sweep, above)) return;
    double highest = w_.standing.heights[0];
    for (uint32_t n = 1; n < tile_.count; ++n) highest = std::max(highest, w_.standing.heights[n]);
    set_bounds(highest);
  }

  /// Takes the sweep out of the rays; true when anything changed.
  bool cut_rays(size_t sweep, bool above) {
    const SweepMap& map = chain_.maps[sweep];
    if (!chain_.cylinder || !above_.empty() || !disc_holds(map, ball_, chain_.cutter))
      return cut_one_by_one(sweep, above);
    const Lowering lowering =
        kernel_.cut_by_disc(w_.rays, map, chain_.cutter.radius, chain_.sweeps[sweep].block, w_.standing);
    return (lowering.left && cut_one_by_one(sweep, above)) || lowering.changed;
  }

  bool cut_one_by_one(size_t sweep, bool above) {
    kernel_.kernel(w_.rays, chain_.maps[sweep], chain_.cutter.radius, w_.found);
    bool changed = false;
    for (uint32_t n = 0; n < tile_.count; ++n) {
      const double limit = above ? w_.tops[n] : w_.standing.heights[n];
      if (w_.found.bound[n] <= limit + kBoundSlack) changed |= cut_ray(n, sweep, limit);
    }
    return changed;
  }

  /// `limit`: no material of this ray above it can be met.
  bool cut_ray(uint32_t n, size_t sweep, double limit) {
    const RayPassage passage{material_.field.points[w_.index[n]], material_.field.normals[w_.index[n]],
                             chain_.maps[sweep]};
    const CutterSolid& cutter = chain_.cutter;
    bool changed = false;
    if (w_.found.exact[n] != kNoHeight && chain_.cylinder) {
      const double low = w_.found.exact[n];
      if (low > limit || (low > w_.standing.heights[n] && misses_above(n, passage))) return false;
      return remove(cut_from(low, passage, cutter.pieces.front(), limit), sweep, n, limit);
    }
    for (const cutter::ConvexPiece& piece : cutter.pieces) {
      const RayInterval interval = cut_of_piece(passage, piece, limit);
      if (interval.hit()) changed |= remove(interval, sweep, n, limit);
    }
    return changed;
  }

  bool misses_above(uint32_t n, const RayPassage& passage) const {
    const auto intervals = above_ray(above_, n);
    if (intervals.empty()) return true;
    return beyond_cutter(passage, chain_.cutter, {intervals.front().low, intervals.back().high});
  }

  /// Where a cut ends that is known to touch nothing above `limit`: an interval that ends above its limit is
  /// told as endless (cut_of_piece), and must not take what stands above a gap with it.
  double end_below_gap(double high, uint32_t n, double limit) const {
    for (const MaterialAbove& m : above_ray(above_, n))
      if (m.low > limit) return std::min(high, std::nextafter(m.low, limit));
    return high;
  }

  bool remove(const RayInterval& interval, size_t sweep, uint32_t n, double limit) {
    const RayField& field = material_.field;
    const uint32_t ray = w_.index[n];
    // A cut of another face of the part.
    if (interval.high < 0.0 &&
        (interval.low < -kSkin || !field.answers_for(field.points[ray], field.normals[ray], interval.high)))
      return false;
    const RayCut cut{interval.low, end_below_gap(interval.high, n, limit), chain_.sweeps[sweep].block};
    StandingMaterial standing{w_.standing.heights[n], static_cast<uint32_t>(w_.standing.blocks[n])};
    const bool first_gap = above_.empty();
    if (!remove_material(cut, n, standing, above_)) return false;
    w_.standing.heights[n] = standing.height;
    w_.standing.blocks[n] = standing.block;
    if (above_.empty()) return true;
    if (first_gap) std::copy_n(w_.standing.heights, kTileRays, w_.tops);
    w_.tops[n] = top_of_ray(standing.height, above_, n);
    return true;
  }

  const Material& material_;
  std::vector<MaterialAbove>& above_;
  const SweepChain& chain_;
  const RayTile& tile_;
  double highest_ = 0.0;  ///< of what stands on the design
  Ball ball_{};           ///< around that, shrinks with the material
  Extent extent_above_;
  Ball ball_above_{};
  const DexelKernelVariant& kernel_ = fastest_kernel();
  Workspace w_;
  bool loaded_ = false;
  uint64_t pairs_ = 0;
};

SweepRun make_run(const SweepChain& chain, size_t begin, size_t end) {
  const Sweep& middle = chain.sweeps[begin + (end - begin) / 2];
  SweepRun run{begin, end, chain.maps[begin + (end - begin) / 2].R0t, middle.start.tip_W};
  for (size_t n = begin; n < end; ++n) {
    for (const ToolPose* pose : {&chain.sweeps[n].start, &chain.sweeps[n].end}) {
      run.tip_spread = std::max(run.tip_spread, (pose->tip_W - middle.start.tip_W).norm());
      run.rise = std::max(run.rise, middle.start.axis_W.dot(middle.start.tip_W - pose->tip_W));
      run.axis_spread = std::max(run.axis_spread, (pose->axis_W - middle.start.axis_W).norm());
    }
  }
  return run;
}

}  // namespace

SweepChain make_chain(std::span<const Sweep> sweeps, const CutterSolid& cutter) {
  SweepChain chain{sweeps, cutter, std::vector<SweepMap>(sweeps.size()), {}, {}, {}, cutter.is_cylinder()};
  parallel_chunks(sweeps.size(), kMapsPerTask, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n) chain.maps[n] = sweep_map(sweeps[n]);
  });
  const auto divide = [&](size_t length, std::vector<SweepRun>& runs) {
    for (size_t n = 0; n < sweeps.size(); n += length)
      runs.push_back(make_run(chain, n, std::min(n + length, sweeps.size())));
  };
  divide(kRunsPerStretch * kSweepsPerRun, chain.stretches);
  divide(kSweepsPerRun, chain.runs);
  divide(kSweepsPerGroup, chain.groups);
  return chain;
}

uint64_t cut_tile(const Material& material, size_t tile, const SweepChain& chain) {
  TileCut cut(material, tile, chain);
  const size_t first = cut.nearest_run();
  if (first == chain.runs.size()) return 0;
  cut.cut_by(chain.runs[first]);
  cut.each_run([&](size_t n) {
    if (n != first && !cut.misses(chain.runs[n])) cut.cut_by(chain.runs[n]);
  });
  return cut.pairs();
}

}  // namespace swarf::stock
