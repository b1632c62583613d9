#include "stock/surface_dexels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/check.h"
#include "base/parallel.h"
#include "stock/dexel_kernel.h"
#include "stock/dexel_tiles.h"

namespace swarf::stock {
namespace {

constexpr size_t kRowsPerTask = 8;
constexpr size_t kTilesPerTask = 4;
/// Samples per iso-parametric curve and curves per direction when the grid's size is chosen.
constexpr int kLengthSamples = 64;

/// Length of the longest of a few iso-parametric curves.
double longest_curve(const surface::Surface& surface, bool along_u) {
  constexpr int kCurves = 8;
  double longest = 0.0;
  for (int curve = 0; curve <= kCurves; ++curve) {
    const double fixed = static_cast<double>(curve) / kCurves;
    const auto at = [&](int i) {
      const double t = static_cast<double>(i) / kLengthSamples;
      return along_u ? surface.point(t, fixed) : surface.point(fixed, t);
    };
    double length = 0.0;
    for (int i = 0; i < kLengthSamples; ++i) length += (at(i + 1) - at(i)).norm();
    longest = std::max(longest, length);
  }
  return longest;
}

int rays_along(const surface::Surface& surface, bool along_u, double pitch_mm) {
  return std::max(2, static_cast<int>(std::ceil(longest_curve(surface, along_u) / pitch_mm)) + 1);
}

/// Height at which the ray leaves the box for good. A design point outside the box lacks material: the height
/// is that of the box below it, or minus the distance to the box when the ray misses it.
double height_of_box(const Box& box, const Vec3& point, const Vec3& normal) {
  double enter = -std::numeric_limits<double>::infinity(), leave = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 3; ++a) {
    if (normal[a] == 0.0) {
      if (point[a] < box.lower[a] || point[a] > box.upper[a])
        leave = -std::numeric_limits<double>::infinity();
      continue;
    }
    const double s0 = (box.lower[a] - point[a]) / normal[a], s1 = (box.upper[a] - point[a]) / normal[a];
    enter = std::max(enter, std::min(s0, s1));
    leave = std::min(leave, std::max(s0, s1));
  }
  constexpr double kOnFace =
      1e-9;  // mm; design edges often lie on the box, and rounding must not move them out
  const bool hit = enter <= leave && enter <= kOnFace;
  return hit ? leave : -(point - point.cwiseMax(box.lower).cwiseMin(box.upper)).norm();
}

}  // namespace

SurfaceDexels::SurfaceDexels(surface::SurfacePtr surface, int nu, int nv)
    : surface_(std::move(surface)), nu_(nu), nv_(nv) {
  const size_t count = static_cast<size_t>(nu_) * nv_;
  points_.resize(count);
  normals_.resize(count);
  heights_.assign(count, 0.0);
  blocks_.assign(count, kUncut);
  parallel_chunks(nv_, kRowsPerTask, [&](size_t begin, size_t end) {
    for (size_t iv = begin; iv < end; ++iv) {
      for (int iu = 0; iu < nu_; ++iu) {
        const surface::Derivatives d = surface_->derivatives(u(iu), v(static_cast<int>(iv)));
        points_[iv * nu_ + iu] = d.S;
        normals_[iv * nu_ + iu] = surface::outward_normal(*surface_, d);
      }
    }
  });
  make_tiles();
}

SurfaceDexels::SurfaceDexels(const surface::SurfacePtr& surface, double pitch_mm, const Box& stock_box)
    : SurfaceDexels(surface, rays_along(*surface, true, pitch_mm), rays_along(*surface, false, pitch_mm)) {
  SWARF_CHECK(pitch_mm > 0.0, "dexels need a pitch");
  for (size_t n = 0; n < points_.size(); ++n) heights_[n] = height_of_box(stock_box, points_[n], normals_[n]);
  refresh_highest();
}

void SurfaceDexels::make_tiles() {
  for (int iv = 0; iv < nv_; iv += kTileSide) {
    for (int iu = 0; iu < nu_; iu += kTileSide) {
      const int width = std::min(kTileSide, nu_ - iu), height = std::min(kTileSide, nv_ - iv);
      tiles_.push_back(make_tile(points_, normals_, nu_, {iu, iv, width, height}));
    }
  }
}

void SurfaceDexels::refresh_highest() {
  for (RayTile& tile : tiles_) tile.highest = highest_of(tile, heights_, nu_);
}

void SurfaceDexels::cut(std::span<const Sweep> sweeps, const CutterSolid& cutter) {
  const SweepChain chain = make_chain(sweeps, cutter);
  std::vector<uint64_t> updates((tiles_.size() + kTilesPerTask - 1) / kTilesPerTask, 0);
  const RayField field{points_, normals_, heights_, blocks_, nu_};
  parallel_chunks(tiles_.size(), kTilesPerTask, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n) updates[begin / kTilesPerTask] += cut_tile(field, tiles_[n], chain);
  });
  for (const uint64_t count : updates) ray_updates_ += count;
}

}  // namespace swarf::stock
