#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "base/check.h"
#include "base/parallel.h"
#include "base/units.h"
#include "measure/measure.h"
#include "measure/near_sweeps.h"
#include "stock/contact/convex_contact.h"
#include "stock/sweep/sweep_map.h"

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
/// Of the rays' heights, mm.
constexpr double kRayRounding = 1e-6;

/// Samples beyond the bound of their slopes that are looked at by the sweeps themselves, the worst first;
/// each costs as much as all the slopes of a row.
constexpr size_t kMostExact = 1024;
constexpr size_t kExactPerTask = 16;

struct Sample {
  double distance = 0.0, bound = 0.0;  ///< mm
  bool used = false;
  double beyond() const { return distance - bound; }
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

/// Positive outside, mm; of a box that to the plane of the face that is left farthest, or nearest from
/// within.
double beyond_faces(const stock::RawShape& raw, const Vec3& point) {
  if (!raw.is_box()) return raw.distance_mm(point);
  const Box& box = raw.box();
  return -std::min((point - box.lower).minCoeff(), (box.upper - point).minCoeff());
}

/// The level set is neither at the raw stock's faces nor beyond them what the sweeps make of it: a ray that
/// was cut right through ends outside.
bool well_inside(const stock::RawShape& raw, const Vec3& point, double distance) {
  return beyond_faces(raw, point) <= -distance;
}

/// What the slopes between the rays promise: no more than an estimate, because a cusp between two rays, or a
/// pass that no ray of a coarse grid has met, does not show in them.
Sample compare(const Grid& grid, const stock::Stock& stock, int iu, int iv, double tolerance_mm) {
  const size_t n = grid.at(iu, iv);
  const double voxel = stock.voxel_mm();
  const Vec3 point = grid.surface_point(n);
  const auto local = look_around(grid, iu, iv);
  Sample sample;
  if (!local || !well_inside(stock.raw(), point, kFaceVoxels * voxel)) return sample;
  const double slope = std::hypot(local->slope_u, local->slope_v);
  if (slope > kWall) return sample;
  sample.used = true;
  sample.distance = std::abs(stock.distance_mm(point));
  sample.bound =
      tolerance_mm + 0.5 * std::sqrt(3.0) * voxel * slope + 3.0 / 8.0 * voxel * voxel * local->curvature;
  return sample;
}

/// What an exact level set of the sweeps would show, in double precision.
class ExactLevel {
 public:
  ExactLevel(const stock::Stock& stock, std::span<const stock::Sweep> sweeps, const SweepCutters& cutters)
      : stock_(stock), sweeps_(sweeps), cutters_(cutters), near_(sweeps, cutters) {}

  /// Of the level set's own grid points around a point of the surface, joined as Stock::distance_mm joins
  /// them. The point lies at least two voxels inside the box.
  double at(const Vec3& point) const {
    const double h = stock_.voxel_mm(), diagonal = std::sqrt(3.0) * h;
    // A corner is no farther away than the diagonal and lies no deeper than that: only a sweep within twice
    // as much of the point can raise it.
    std::vector<Swept> reaching;
    for (const uint32_t n : near_.around(point, 2.0 * diagonal)) {
      const Swept one{stock::sweep_map(sweeps_[n]), &cutters_[sweeps_[n].block]};
      if (stock::swept_contact(point, one.map, *one.solid).distance_mm < 2.0 * diagonal)
        reaching.push_back(one);
    }
    const Vec3 index = point / h, cell = index.array().floor(), f = index - cell;
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 side(corner >> 2, corner >> 1 & 1, corner & 1);
      const Vec3 weight = side.cwiseProduct(f) + (Vec3::Ones() - side).cwiseProduct(Vec3::Ones() - f);
      sum += weight.prod() * value(reaching, h * (cell + side));
    }
    return sum;
  }

 private:
  struct Swept {
    stock::SweepMap map;
    const stock::CutterSolid* solid;
  };
  double value(const std::vector<Swept>& sweeps, const Vec3& point) const {
    double highest = beyond_faces(stock_.raw(), point);
    for (const Swept& one : sweeps)
      highest = std::max(highest, -stock::swept_contact(point, one.map, *one.solid).distance_mm);
    return highest;
  }

  const stock::Stock& stock_;
  std::span<const stock::Sweep> sweeps_;
  const SweepCutters& cutters_;
  NearSweeps near_;
};

/// Samples beyond their bound: the level set at this very point is what the sweeps make of it, within the
/// tolerance, or the check fails. Those that are too many are not compared.
void look_exactly(const Grid& grid, const stock::Stock& stock, const ExactLevel& exact, double tolerance_mm,
                  std::vector<Sample>& samples) {
  std::vector<size_t> open;
  for (size_t n = 0; n < samples.size(); ++n) {
    if (samples[n].used && samples[n].beyond() > 0.0) open.push_back(n);
  }
  std::stable_sort(open.begin(), open.end(),
                   [&](size_t a, size_t b) { return samples[a].beyond() > samples[b].beyond(); });
  for (size_t k = kMostExact; k < open.size(); ++k) samples[open[k]].used = false;
  open.resize(std::min(open.size(), kMostExact));
  parallel_chunks(open.size(), kExactPerTask, [&](size_t begin, size_t end) {
    for (size_t k = begin; k < end; ++k) {
      Sample& sample = samples[open[k]];
      const Vec3 point = grid.surface_point(open[k]);
      const double expected = exact.at(point), off = std::abs(stock.distance_mm(point) - expected);
      if (off <= tolerance_mm) {
        sample.bound = std::abs(expected) + tolerance_mm;
      } else {
        sample.distance = off;
        sample.bound = tolerance_mm;
      }
    }
  });
}

}  // namespace

CrossCheck cross_check(const stock::Stock& stock, const stock::SurfaceDexels& dexels,
                       std::span<const stock::Sweep> sweeps, const SweepCutters& cutters,
                       double sweep_bound_mm) {
  SWARF_CHECK(dexels.field().surface != nullptr, "the cross check knows the slopes of grids only");
  const Grid grid{dexels};
  const double tolerance = sweep_bound_mm + stock.rounding_mm() + kRayRounding;
  std::vector<Sample> samples(dexels.heights_mm().size());
  parallel_chunks(static_cast<size_t>(dexels.nv()), kRowsPerTask, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) {
      const int iv = static_cast<int>(row);
      for (int iu = 0; iu < dexels.nu(); ++iu) {
        samples[grid.at(iu, iv)] = compare(grid, stock, iu, iv, tolerance);
      }
    }
  });
  look_exactly(grid, stock, ExactLevel(stock, sweeps, cutters), tolerance, samples);
  CrossCheck check;
  std::vector<double> distances;
  Sample worst;
  for (const Sample& sample : samples) {
    if (!sample.used) continue;
    distances.push_back(sample.distance);
    check.bound_um = std::max(check.bound_um, um_from_mm(sample.bound));
    if (sample.beyond() > worst.beyond()) worst = sample;
  }
  check.holds = worst.beyond() <= 0.0;
  check.samples = distances.size();
  check.excluded = samples.size() - distances.size();
  if (distances.empty()) return check;
  check.mean_abs_um = um_from_mm(std::accumulate(distances.begin(), distances.end(), 0.0) /
                                 static_cast<double>(distances.size()));
  std::sort(distances.begin(), distances.end());
  check.p99_um = um_from_mm(distances[(distances.size() - 1) * 99 / 100]);
  check.max_um = um_from_mm(check.holds ? distances.back() : worst.distance);
  if (!check.holds) check.bound_um = um_from_mm(worst.bound);
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
