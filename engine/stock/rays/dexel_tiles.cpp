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

constexpr size_t kSweepsPerGroup = 8, kGroupsPerRun = 4, kRunsPerLeg = 8, kLegsPerStretch = 4;
constexpr size_t kSweepsPerRun = kGroupsPerRun * kSweepsPerGroup, kSweepsPerLeg = kRunsPerLeg * kSweepsPerRun;
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

  /// The nearest run first: it brings the heights down, and the bounds then rule out nearly all the others.
  void cut() {
    const size_t first = nearest_run();
    if (first == chain_.runs.size()) return;
    std::vector<NearGroup> near;
    add_groups(first, near);
    cut_by(near);
    near.clear();
    const auto skips = [&](const SweepRun& part) { return misses(part); };
    for (size_t k = 0; k < chain_.stretches.size(); ++k)
      each_run(k, skips, [&](size_t n) {
        if (n != first) add_groups(n, near);
      });
    cut_by(near);
  }

  uint64_t pairs() const { return pairs_; }

 private:
  struct NearGroup {
    double distance2;  ///< of its tip from the tile's middle
    size_t group;
    bool operator<(const NearGroup& other) const {
      return distance2 != other.distance2 ? distance2 < other.distance2 : group < other.group;
    }
  };

  double distance2(const SweepRun& run) const { return (run.tip - middle_).squaredNorm(); }

  /// Calls visit(n) for the runs of a stretch, without those in parts of it that `skips` tells.
  template <typename Skips, typename Visit>
  void each_run(size_t stretch, const Skips& skips, const Visit& visit) const {
    if (skips(chain_.stretches[stretch])) return;
    const size_t legs = std::min((stretch + 1) * kLegsPerStretch, chain_.legs.size());
    for (size_t l = stretch * kLegsPerStretch; l < legs; ++l) {
      if (skips(chain_.legs[l])) continue;
      for (size_t n = l * kRunsPerLeg; n < std::min((l + 1) * kRunsPerLeg, chain_.runs.size()); ++n)
        if (!skips(chain_.runs[n])) visit(n);
    }
  }

  /// No tip of the part comes nearer to the tile's middle; mm.
  double least_distance(const SweepRun& part) const {
    return std::max(0.0, std::sqrt(distance2(part)) - part.tip_spread);
  }

  size_t nearest_stretch() const {
    size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (size_t k = 0; k < chain_.stretches.size(); ++k) {
      const double found = least_distance(chain_.stretches[k]);
      if (found >= least) continue;
      least = found;
      nearest = k;
    }
    return nearest;
  }

  /// The run whose tip passes nearest to the tile's middle, among those that may meet it; runs.size() when
  /// none.
  size_t nearest_run() const {
    size_t nearest = chain_.runs.size();
    double least = std::numeric_limits<double>::infinity();
    const auto skips = [&](const SweepRun& part) { return least_distance(part) > least || misses(part); };
    const auto visit = [&](size_t n) {
      const double distance = std::sqrt(distance2(chain_.runs[n]));
      if (distance >= least) return;
      least = distance;
      nearest = n;
    };
    if (chain_.runs.empty()) return nearest;
    const size_t first = nearest_stretch();
    each_run(first, skips, visit);
    for (size_t k = 0; k < chain_.stretches.size(); ++k)
      if (k != first) each_run(k, skips, visit);
    return nearest;
  }

  void add_groups(size_t run, std::vector<NearGroup>& near) const {
    for (size_t g = run * kGroupsPerRun; g < std::min((run + 1) * kGroupsPerRun, chain_.groups.size()); ++g)
      if (!misses(chain_.groups[g])) near.push_back({distance2(chain_.groups[g]), g});
  }

  /// The nearest group first.
  void cut_by(std::vector<NearGroup>& near) {
    std::sort(near.begin(), near.end());
    for (const NearGroup& one : near) {
      const SweepRun& group = chain_.groups[one.group];
      if (!misses(group)) cut_by(group);
    }
  }

  void cut_by(const SweepRun& group) {
    const size_t count = group.end - group.begin;
    uint32_t reaching = (1U << count) - 1;
    const bool at_once = chain_.cylinder && above_.empty();
    if (at_once) {
      if (!loaded_) load();
      pairs_ += kTileRays * count;
      reaching = kernel_.planes_reach(w_.rays, std::span(chain_.maps).subspan(group.begin, count),
                                      w_.standing.heights);
    }
    for (size_t k = 0; k < count; ++k)
      if ((reaching >> k & 1U) != 0) cut_by(group.begin + k);
  }

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
    if (kernel_.planes_reach(w_.rays, {&map, 1}, above_.empty() ? w_.standing.heights : w_.tops) == 0) return;
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
  const Vec3 middle_ = tile_.origin + tile_.frame.transpose() * (0.5 * (tile_.low + tile_.high));
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
  SweepChain chain{
      sweeps, cutter, std::vector<SweepMap>(sweeps.size()), {}, {}, {}, {}, cutter.is_cylinder()};
  parallel_chunks(sweeps.size(), kMapsPerTask, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n) chain.maps[n] = sweep_map(sweeps[n]);
  });
  const auto divide = [&](size_t length, std::vector<SweepRun>& runs) {
    for (size_t n = 0; n < sweeps.size(); n += length)
      runs.push_back(make_run(chain, n, std::min(n + length, sweeps.size())));
  };
  divide(kLegsPerStretch * kSweepsPerLeg, chain.stretches);
  divide(kSweepsPerLeg, chain.legs);
  divide(kSweepsPerRun, chain.runs);
  divide(kSweepsPerGroup, chain.groups);
  return chain;
}

uint64_t cut_tile(const Material& material, size_t tile, const SweepChain& chain) {
  TileCut cut(material, tile, chain);
  cut.cut();
  return cut.pairs();
}

}  // namespace swarf::stock
