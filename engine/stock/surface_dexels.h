// Surface dexels: rays along the normals of the design on a (u,v) grid, met analytically by the sweeps.
// They measure scallops and gouges far below the voxel size (toolchain 3.6).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/frames.h"
#include "stock/sweep.h"
#include "surface/surface.h"

namespace swarf::stock {

inline constexpr uint32_t kUncut = 0xffffffffu;

/// Heights over the design surface along its outward normal; index i = iv * nu + iu.
class SurfaceDexels {
 public:
  /// Grid of about `pitch_mm` over the unit square. Rays start at the stock's surface: initial height is
  /// where the ray leaves `stock_box`, 0 or less if the design point lies outside it.
  SurfaceDexels(surface::SurfacePtr surface, double pitch_mm, const Box& stock_box);

  /// Lowers the heights by the sweeps; parallel, order-independent, ties keep the smaller block id.
  void cut(std::span<const Sweep> sweeps, const CutterSolid& cutter);

  int nu() const { return nu_; }
  int nv() const { return nv_; }
  double u(int iu) const { return static_cast<double>(iu) / (nu_ - 1); }
  double v(int iv) const { return static_cast<double>(iv) / (nv_ - 1); }
  const surface::Surface& surface() const { return *surface_; }
  const std::vector<Vec3>& points() const { return points_; }
  const std::vector<Vec3>& normals() const { return normals_; }
  const std::vector<double>& heights_mm() const {
    return heights_;
  }  ///< material above (+) or cut below (-) the design
  const std::vector<uint32_t>& blocks() const { return blocks_; }  ///< Sweep::block that set it, kUncut: none
  uint64_t ray_updates() const { return ray_updates_; }

 private:
  surface::SurfacePtr surface_;
  int nu_ = 0, nv_ = 0;
  std::vector<Vec3> points_, normals_;
  std::vector<double> heights_;
  std::vector<uint32_t> blocks_;
  uint64_t ray_updates_ = 0;
};

/// Height over `point` along `normal` at which the swept cutter is first met from below, i.e. the height that
/// the sweep leaves behind; +infinity when the ray misses. Exact for the sweep's definition.
double ray_height(const Vec3& point, const Vec3& normal, const Sweep& sweep, const CutterSolid& cutter);

}  // namespace swarf::stock
