#include "stock/dexel_tiles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "stock/convex_contact.h"
#include "stock/dexel_kernel.h"
#include "stock/ray_height.h"
#include "stock/sweep_distance.h"

namespace swarf::stock {
namespace {

constexpr size_t kSweepsPerRun = 32;
constexpr size_t kMapsPerTask = 1024;
/// Bounds are compared with this slack, so that their own rounding never decides; mm.
constexpr double kBoundSlack = 1e-9;

/// Distance to the cylinder around the standing cutter from a point in its frame; 1-Lipschitz.
double hull_distance(const Vec3& X, const CutterSolid& cutter) {
  return std::max({X.head<2>().norm() - cutter.radius, -X.z(), X.z() - cutter.height});
}

/// A ball that holds every point of the tile's rays between kSkin below the design and the highest material.
struct Ball {
  Vec3 centre;
  double radius;
};

Ball material_ball(const RayTile& tile) {
  const double top = std::max(tile.highest, 0.0);
  const double low = tile.low.z() - kSkin, high = tile.high.z() + top;
  const Vec3 feet = 0.5 * (tile.low + tile.high);
  const Vec3 local(feet.x(), feet.y(), 0.5 * (low + high));
  const double sideways =
      std::hypot(0.5 * (tile.high.x() - tile.low.x()), 0.5 * (tile.high.y() - tile.low.y()));
  const double fan = tile.normal_spread * std::max(top, kSkin);
  return {tile.origin + tile.frame.transpose() * local, std::hypot(sideways + fan, 0.5 * (high - low) + fan)};
}

bool run_misses(const SweepRun& run, const Ball& ball, const CutterSolid& cutter) {
  const Vec3 offset = ball.centre - run.tip;
  const double spread = run.tip_spread + run.axis_spread * offset.norm();
  return hull_distance(run.Rt * offset, cutter) - spread > ball.radius + kBoundSlack;
}

bool sweep_misses(const SweepMap& map, const Ball& ball, const CutterSolid& cutter) {
  const Vec3 X = map.start(ball.centre);
  const double travel = (map.end(ball.centre) - X).norm();
  return hull_distance(X, cutter) - travel > ball.radius + kBoundSlack;
}

/// Lowest height that the bottom plane of one pose can leave in the tile, or -infinity where the bound does
/// not apply. For feet below the plane s = -a.(x - tip) / (a.n) >= -a.(x - tip), because a.n <= 1.
double plane_bound(const RayTile& tile, const Vec3& axis, const Vec3& tip) {
  const Vec3 a = tile.frame * axis;
  const bool tool_side = a.z() > tile.normal_spread;  // a.n > 0 for every ray of the tile
  if (!tool_side) return -std::numeric_limits<double>::infinity();
  const double nearest =
      axis.dot(tile.origin - tip) + a.cwiseProduct(tile.low).cwiseMax(a.cwiseProduct(tile.high)).sum();
  return nearest <= 0.0 ? -nearest : -std::numeric_limits<double>::infinity();
}

bool plane_above(const RayTile& tile, const SweepMap& map, double highest) {
  return std::min(plane_bound(tile, map.R0t.row(2).transpose(), map.tip0),
                  plane_bound(tile, map.R1t.row(2).transpose(), map.tip1)) > highest + kBoundSlack;
}

/// A tile's rays and heights by component; places beyond the grid's edge repeat the last ray.
struct Workspace {
  TileRays rays;
  TileHeights found;
  double heights[kTileRays];
  uint32_t blocks[kTileRays];
  size_t index[kTileRays];
  bool loaded = false;
};

void load(const RayField& field, const RayTile& tile, Workspace& w) {
  for (int n = 0; n < kTileRays; ++n) {
    const int iu = tile.iu + std::min(n % kTileSide, tile.nu - 1);
    const int iv = tile.iv + std::min(n / kTileSide, tile.nv - 1);
    const size_t i = static_cast<size_t>(iv) * field.row + iu;
    w.index[n] = i;
    w.rays.px[n] = field.points[i].x();
    w.rays.py[n] = field.points[i].y();
    w.rays.pz[n] = field.points[i].z();
    w.rays.nx[n] = field.normals[i].x();
    w.rays.ny[n] = field.normals[i].y();
    w.rays.nz[n] = field.normals[i].z();
    w.heights[n] = field.heights[i];
    w.blocks[n] = field.blocks[i];
  }
  w.loaded = true;
}

void store(const RayField& field, const Workspace& w) {
  for (int n = 0; n < kTileRays; ++n) {
    field.heights[w.index[n]] = w.heights[n];
    field.blocks[w.index[n]] = w.blocks[n];
  }
}

/// A cut counts when it comes down to the design, or ends no deeper than kSkin below it.
bool belongs_to_ray(double height, const RayField& field, size_t ray, const SweepMap& map,
                    const CutterSolid& cutter) {
  if (height >= -kSkin) return true;
  if (!cutter.is_cylinder()) return swept_contact(field.points[ray], map, cutter).distance_mm <= 0.0;
  const Vec3 P = map.start(field.points[ray]), D = map.end(field.points[ray]) - P;
  const MovingPoint<double> foot{P.x(), P.y(), P.z(), D.x(), D.y(), D.z()};
  return swept_distance<double, true>(foot, cutter.radius, cutter.height) <= 0.0;
}

/// Keeps the lower of two (height, block) pairs, compared in that order: the order of sweeps cannot matter.
bool lower(double height, uint32_t block, Workspace& w, int n) {
  if (height > w.heights[n] || (height == w.heights[n] && block >= w.blocks[n])) return false;
  w.heights[n] = height;
  w.blocks[n] = block;
  return true;
}

bool apply_sweep(const RayField& field, const SweepChain& chain, size_t sweep, Workspace& w) {
  const uint32_t block = chain.sweeps[sweep].block;
  const SweepMap& map = chain.maps[sweep];
  static const DexelKernel kernel = dexel_kernel_variants().front().kernel;
  kernel(w.rays, map, chain.cutter.radius, w.found);
  const bool flat_end = chain.cutter.is_cylinder();  // of other cutters the kernel knows the bound alone
  bool changed = false;
  for (int n = 0; n < kTileRays; ++n) {
    if (w.found.bound[n] > w.heights[n] + kBoundSlack) continue;
    double height = w.found.exact[n];
    if (height == kNoHeight || !flat_end) {
      height = ray_height(field.points[w.index[n]], field.normals[w.index[n]], map, chain.cutter);
    }
    if (height > w.heights[n] || !belongs_to_ray(height, field, w.index[n], map, chain.cutter)) continue;
    changed |= lower(height, block, w, n);
  }
  return changed;
}

/// The run whose tip passes nearest to the tile's middle, among those that may meet it; runs.size() when
/// none.
size_t nearest_run(const RayTile& tile, const Ball& ball, const SweepChain& chain) {
  const Vec3 middle = tile.origin + tile.frame.transpose() * (0.5 * (tile.low + tile.high));
  size_t nearest = chain.runs.size();
  double least = std::numeric_limits<double>::infinity();
  for (size_t n = 0; n < chain.runs.size(); ++n) {
    const double distance2 = (chain.runs[n].tip - middle).squaredNorm();
    if (distance2 >= least || run_misses(chain.runs[n], ball, chain.cutter)) continue;
    least = distance2;
    nearest = n;
  }
  return nearest;
}

/// Lowers the tile by the sweeps of one run; the ball shrinks with the material.
uint64_t cut_by_run(const RayField& field, RayTile& tile, const SweepChain& chain, const SweepRun& run,
                    Workspace& w, Ball& ball) {
  uint64_t pairs = 0;
  for (size_t n = run.begin; n < run.end; ++n) {
    if (sweep_misses(chain.maps[n], ball, chain.cutter)) continue;
    if (plane_above(tile, chain.maps[n], tile.highest)) continue;
    if (!w.loaded) load(field, tile, w);
    pairs += kTileRays;
    if (!apply_sweep(field, chain, n, w)) continue;
    tile.highest = *std::max_element(w.heights, w.heights + kTileRays);
    ball = material_ball(tile);
  }
  return pairs;
}

SweepRun make_run(const SweepChain& chain, size_t begin, size_t end) {
  const Sweep& middle = chain.sweeps[begin + (end - begin) / 2];
  SweepRun run{begin, end, chain.maps[begin + (end - begin) / 2].R0t, middle.start.tip_W, 0.0, 0.0};
  for (size_t n = begin; n < end; ++n) {
    for (const ToolPose* pose : {&chain.sweeps[n].start, &chain.sweeps[n].end}) {
      run.tip_spread = std::max(run.tip_spread, (pose->tip_W - middle.start.tip_W).norm());
      run.axis_spread = std::max(run.axis_spread, (pose->axis_W - middle.start.axis_W).norm());
    }
  }
  return run;
}

}  // namespace

RayTile make_tile(const std::vector<Vec3>& points, const std::vector<Vec3>& normals, int row, TileSpan span) {
  RayTile tile{span.iu, span.iv, span.nu, span.nv};
  const auto at = [&](int i, int j) { return static_cast<size_t>(span.iv + j) * row + span.iu + i; };
  Vec3 mean = Vec3::Zero();
  for (int j = 0; j < span.nv; ++j) {
    for (int i = 0; i < span.nu; ++i) mean += normals[at(i, j)];
  }
  mean.normalize();
  int least = 0;
  mean.cwiseAbs().minCoeff(&least);
  const Vec3 e1 = mean.cross(Vec3::Unit(least)).normalized();
  tile.origin = points[at(0, 0)];
  tile.frame.row(0) = e1;
  tile.frame.row(1) = mean.cross(e1);
  tile.frame.row(2) = mean;
  for (int j = 0; j < span.nv; ++j) {
    for (int i = 0; i < span.nu; ++i) {
      const Vec3 local = tile.frame * (points[at(i, j)] - tile.origin);
      tile.low = tile.low.cwiseMin(local);
      tile.high = tile.high.cwiseMax(local);
      tile.normal_spread = std::max(tile.normal_spread, (normals[at(i, j)] - mean).norm());
    }
  }
  return tile;
}

double highest_of(const RayTile& tile, const std::vector<double>& heights, int row) {
  double highest = -std::numeric_limits<double>::infinity();
  for (int j = 0; j < tile.nv; ++j) {
    const auto first = heights.begin() + static_cast<std::ptrdiff_t>(tile.iv + j) * row + tile.iu;
    highest = std::max(highest, *std::max_element(first, first + tile.nu));
  }
  return highest;
}

SweepChain make_chain(std::span<const Sweep> sweeps, const CutterSolid& cutter) {
  SweepChain chain{sweeps, cutter, std::vector<SweepMap>(sweeps.size()), {}};
  parallel_chunks(sweeps.size(), kMapsPerTask, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n) chain.maps[n] = sweep_map(sweeps[n]);
  });
  for (size_t n = 0; n < sweeps.size(); n += kSweepsPerRun) {
    chain.runs.push_back(make_run(chain, n, std::min(n + kSweepsPerRun, sweeps.size())));
  }
  return chain;
}

uint64_t cut_tile(const RayField& field, RayTile& tile, const SweepChain& chain) {
  Workspace w;
  Ball ball = material_ball(tile);
  const size_t first = nearest_run(tile, ball, chain);
  if (first == chain.runs.size()) return 0;
  uint64_t pairs = cut_by_run(field, tile, chain, chain.runs[first], w, ball);
  for (size_t n = 0; n < chain.runs.size(); ++n) {
    if (n == first || run_misses(chain.runs[n], ball, chain.cutter)) continue;
    pairs += cut_by_run(field, tile, chain, chain.runs[n], w, ball);
  }
  if (w.loaded) store(field, w);
  return pairs;
}

}  // namespace swarf::stock
