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

/// A square of neighbouring rays, cut together: an oriented box around their feet and a cone around their
/// normals.
struct RayTile {
  int iu = 0, iv = 0, nu = 0, nv = 0;            ///< first ray and size
  Vec3 origin = Vec3::Zero();                    ///< of the frame below, W
  Mat3 frame = Mat3::Identity();                 ///< rows e1, e2, mean normal
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< feet in the frame, mm
  double normal_spread = 0.0;                    ///< greatest |normal - mean normal|
  double highest = 0.0;                          ///< greatest height in the tile, mm
};

/// Heights over the design surface along its outward normal; index i = iv * nu + iu.
/// A height is the top of the material that still stands on the design: the lowest point of the ray that any
/// sweep reached. A cut that leaves the design's skin standing, more than kSkin below it, belongs to another
/// face of the part and is not seen by the ray.
class SurfaceDexels {
 public:
  /// Grid of about `pitch_mm` over the unit square. Rays start at the stock's surface: initial height is
  /// where the ray leaves `stock_box`, 0 or less if the design point lies outside it.
  SurfaceDexels(const surface::SurfacePtr& surface, double pitch_mm, const Box& stock_box);

  /// Lowers the heights by the sweeps; parallel, order-independent, ties keep the smaller block id.
  void cut(std::span<const Sweep> sweeps, const CutterSolid& cutter);

  /// Writes the heights and their blocks; the file is replaced whole. Throws InputError when it cannot be.
  void save(const std::string& path) const;
  /// Reads what save() wrote for the same surface. Throws InputError for a file that is cut off, damaged or
  /// belongs to another surface.
  static SurfaceDexels load(const std::string& path, surface::SurfacePtr surface);

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
  /// Pairs of a ray and a sweep that were evaluated; pairs ruled out by bounds of a whole tile do not count.
  uint64_t ray_updates() const { return ray_updates_; }

 private:
  /// Rays and tiles of a grid; heights are still to be set.
  SurfaceDexels(surface::SurfacePtr surface, int nu, int nv);
  void make_tiles();
  void refresh_highest();

  surface::SurfacePtr surface_;
  int nu_ = 0, nv_ = 0;
  std::vector<Vec3> points_, normals_;
  std::vector<double> heights_;
  std::vector<uint32_t> blocks_;
  std::vector<RayTile> tiles_;
  uint64_t ray_updates_ = 0;
};

/// Depth in mm below the design down to which a cut is met even when it does not reach the design itself.
inline constexpr double kSkin = 1.0;

/// Height over `point` along `normal` at which the swept cutter is first met from below, i.e. the height that
/// the sweep leaves behind; +infinity when the ray misses. Exact for the sweep's definition (ray_height.h).
double ray_height(const Vec3& point, const Vec3& normal, const Sweep& sweep, const CutterSolid& cutter);

}  // namespace swarf::stock
