#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "base/check.h"
#include "base/parallel.h"
#include "base/units.h"
#include "measure/measure.h"

namespace swarf::measure {
namespace {

constexpr size_t kRowsPerTask = 8;
/// Rays looked at on each side for the local slope: a cusp between two rays shows its slope beside them.
constexpr int kWindow = 2;
/// Steeper steps between rays are walls (the flank's, or the border of what was cut), which the level set
/// rounds.
constexpr double kWall = 0.25;
/// The level set rounds the edges between the block's faces and the cut within this many voxels.
constexpr double kFaceVoxels = 2.0;
/// Floats of distances within the band and of coordinates in the tool frame, mm.
constexpr double kFloatRounding = 2e-5;

struct Sample {
  double distance = 0.0, bound = 0.0;  ///< mm
  bool used = false;
};

struct Grid {
  const stock::SurfaceDexels& dexels;
  size_t at(int iu, int iv) const {
    return static_cast<size_t>(iv) * static_cast<size_t>(dexels.nu()) + static_cast<size_t>(iu);
  }
  Vec3 surface_point(size_t n) const {
    return dexels.points()[n] + dexels.heights_mm()[n] * dexels.normals()[n];
  }
  /// Height change per mm between two neighbouring rays.
  double slope(size_t a, size_t b) const {
    return std::abs(dexels.heights_mm()[a] - dexels.heights_mm()[b]) /
           (dexels.points()[a] - dexels.points()[b]).norm();
  }
  double curvature(size_t a, size_t b) const {
    return (dexels.normals()[a] - dexels.normals()[b]).norm() /
           (dexels.points()[a] - dexels.points()[b]).norm();
  }
};

struct Local {
  double slope_u = 0.0, slope_v = 0.0, curvature = 0.0;
};

/// What the rays around (iu, iv) show; nothing when one of them was not cut.
std::optional<Local> look_around(const Grid& grid, int iu, int iv) {
  Local local;
  const int nu = grid.dexels.nu(), nv = grid.dexels.nv();
  for (int j = std::max(0, iv - kWindow); j <= std::min(nv - 1, iv + kWindow); ++j) {
    for (int i = std::max(0, iu - kWindow); i <= std::min(nu - 1, iu + kWindow); ++i) {
      const size_t n = grid.at(i, j);
      if (grid.dexels.blocks()[n] == stock::kUncut) return std::nullopt;
      if (i + 1 < nu) {
        local.slope_u = std::max(local.slope_u, grid.slope(n, grid.at(i + 1, j)));
        local.curvature = std::max(local.curvature, grid.curvature(n, grid.at(i + 1, j)));
      }
      if (j + 1 < nv) {
        local.slope_v = std::max(local.slope_v, grid.slope(n, grid.at(i, j + 1)));
        local.curvature = std::max(local.curvature, grid.curvature(n, grid.at(i, j + 1)));
      }
    }
  }
  return local;
}

bool near_face(const Box& box, const Vec3& point, double distance) {
  return std::min((point - box.lower).cwiseAbs().minCoeff(), (box.upper - point).cwiseAbs().minCoeff()) <
         distance;
}

Sample compare(const Grid& grid, const stock::Stock& stock, int iu, int iv, double sweep_bound_mm) {
  const size_t n = grid.at(iu, iv);
  const double voxel = stock.voxel_mm();
  const Vec3 point = grid.surface_point(n);
  const auto local = look_around(grid, iu, iv);
  Sample sample;
  if (!local || near_face(stock.box(), point, kFaceVoxels * voxel)) return sample;
  const double slope = std::hypot(local->slope_u, local->slope_v);
  if (slope > kWall) return sample;
  sample.used = true;
  sample.distance = std::abs(stock.distance_mm(point));
  sample.bound = sweep_bound_mm + 0.5 * std::sqrt(3.0) * voxel * slope +
                 3.0 / 8.0 * voxel * voxel * local->curvature + kFloatRounding;
  return sample;
}

}  // namespace

CrossCheck cross_check(const stock::Stock& stock, const stock::SurfaceDexels& dexels, double sweep_bound_mm) {
  SWARF_CHECK(dexels.field().surface != nullptr, "the cross check knows the slopes of grids only");
  const Grid grid{dexels};
  std::vector<Sample> samples(dexels.heights_mm().size());
  parallel_chunks(static_cast<size_t>(dexels.nv()), kRowsPerTask, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) {
      const int iv = static_cast<int>(row);
      for (int iu = 0; iu < dexels.nu(); ++iu) {
        samples[grid.at(iu, iv)] = compare(grid, stock, iu, iv, sweep_bound_mm);
      }
    }
  });
  CrossCheck check;
  std::vector<double> distances;
  for (const Sample& sample : samples) {
    if (!sample.used) continue;
    distances.push_back(sample.distance);
    check.bound_um = std::max(check.bound_um, um_from_mm(sample.bound));
    check.holds &= sample.distance <= sample.bound;
  }
  check.samples = distances.size();
  check.excluded = samples.size() - distances.size();
  if (distances.empty()) return check;
  check.mean_abs_um = um_from_mm(std::accumulate(distances.begin(), distances.end(), 0.0) /
                                 static_cast<double>(distances.size()));
  std::sort(distances.begin(), distances.end());
  check.p99_um = um_from_mm(distances[(distances.size() - 1) * 99 / 100]);
  check.max_um = um_from_mm(distances.back());
  return check;
}

std::optional<CrossCheck> combine(const std::vector<CrossCheck>& parts) {
  std::optional<CrossCheck> worst;
  size_t samples = 0, excluded = 0;
  for (const CrossCheck& part : parts) {
    samples += part.samples;
    excluded += part.excluded;
    if (part.samples == 0) continue;
    const bool worse = !worst || (part.holds == worst->holds ? part.max_um > worst->max_um : !part.holds);
    if (worse) worst = part;
  }
  if (!worst) return worst;
  worst->samples = samples;
  worst->excluded = excluded;
  return worst;
}

}  // namespace swarf::measure
