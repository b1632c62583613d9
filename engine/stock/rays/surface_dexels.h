// Surface dexels: rays along the outward normals of a design, met analytically by the sweeps. They measure
// scallops and gouges far below the voxel size (theory 6), on any design (ray_field.h).
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "base/frames.h"
#include "base/ranks.h"
#include "stock/raw/raw_shape.h"
#include "stock/rays/ray_field.h"
#include "stock/rays/ray_material.h"
#include "stock/sweep/sweep.h"
#include "surface/surface.h"

namespace swarf::stock {

inline constexpr uint32_t kUncut = 0xffffffffu;
/// Material above a gap thinner than this is the rounding of two cuts that share an end; mm.
inline constexpr double kSliver = 1e-6;

/// Material over the design along its outward normal.
/// A height is the top of the material that still stands on the design: the lowest point of the ray that any
/// sweep reached. Material that an undercut left above a gap is kept as further intervals. A cut that leaves
/// the design's skin standing (RayField::answers_for) belongs to another face of the part and is not seen by
/// the ray.
class SurfaceDexels {
 public:
  /// Rays start at the stock's surface: the initial height is where the ray leaves `stock_box`, 0 or less if
  /// the design point lies outside it; and never beyond the ray's entry in `ranges_mm` (free_ranges.h),
  /// unless that is empty.
  SurfaceDexels(RayFieldPtr field, const Box& stock_box, std::span<const double> ranges_mm);
  /// The same for any raw stock: what stands on the design is the material that the ray begins in, and what
  /// it meets further up are intervals above gaps, all up to the ray's range.
  SurfaceDexels(RayFieldPtr field, const RawShape& raw, std::span<const double> ranges_mm);
  /// A surface that stands alone: rays_on_surface, with its own free_ranges.
  SurfaceDexels(const surface::SurfacePtr& surface, double pitch_mm, const Box& stock_box);

  /// Removes the sweeps; parallel, order-independent, ties keep the smaller block id.
  /// `share`: of the tiles of rays, in turn; the others stay as they are.
  void cut(std::span<const Sweep> sweeps, const CutterSolid& cutter, Share share = {});
  /// The material on the share's tiles, for the same rays of another process.
  Bytes tiles_of(Share share) const;
  /// Takes over what tiles_of() has told; false: it told of other rays, and nothing is changed.
  bool take_tiles(const Bytes& told, Share share);

  /// Takes back what each ray lost beyond RayField::own_depth: other faces answer for it. After the last cut.
  void limit_depths();

  /// Writes the material and its blocks; the file is replaced whole. Throws InputError when it cannot be.
  void save(const std::string& path) const;
  /// Reads what save() wrote for the same surface. Throws InputError for a file that is cut off, damaged or
  /// belongs to another surface.
  static SurfaceDexels load(const std::string& path, const surface::SurfacePtr& surface);
  /// The same for rays that the caller has made again, by the same call.
  static SurfaceDexels load(const std::string& path, RayFieldPtr field);

  const RayField& field() const { return *field_; }
  const RayFieldPtr& field_ptr() const { return field_; }
  /// Parametric designs only: the grid of the rays; ray iv * nu + iu.
  int nu() const { return static_cast<int>(field_->u_lines.size()); }
  int nv() const { return static_cast<int>(field_->v_lines.size()); }
  double u(int iu) const { return field_->u_lines[static_cast<size_t>(iu)]; }
  double v(int iv) const { return field_->v_lines[static_cast<size_t>(iv)]; }
  const surface::Surface& surface() const { return *field_->surface; }

  const std::vector<Vec3>& points() const { return field_->points; }
  const std::vector<Vec3>& normals() const { return field_->normals; }
  const std::vector<double>& heights_mm() const {
    return heights_;
  }  ///< material above (+) or cut below (-) the design
  const std::vector<uint32_t>& blocks() const { return blocks_; }  ///< Sweep::block that set it, kUncut: none
  /// Calls visit(ray, interval) for every piece of material above a gap, tile by tile, from low to high.
  void each_above(const std::function<void(uint32_t ray, const MaterialAbove&)>& visit) const;
  /// Pairs of a ray and a sweep that were evaluated; pairs ruled out by bounds of a whole tile do not count.
  uint64_t ray_updates() const { return ray_updates_; }

 private:
  /// Rays whose material is still to be set.
  explicit SurfaceDexels(RayFieldPtr field);
  void fill_tile(size_t tile, const RawShape& raw, std::span<const double> ranges_mm);

  RayFieldPtr field_;
  std::vector<double> heights_;
  std::vector<uint32_t> blocks_;
  std::vector<std::vector<MaterialAbove>> above_;  ///< per tile
  uint64_t ray_updates_ = 0;
};

/// Depth in mm below the design down to which a cut is met even when it does not reach the design itself.
inline constexpr double kSkin = 1.0;

/// Height over `point` along `normal` at which the swept cutter is first met from below, i.e. the height that
/// the sweep leaves behind; +infinity when the ray misses. Exact for the sweep's definition (ray_height.h).
double ray_height(const Vec3& point, const Vec3& normal, const Sweep& sweep, const CutterSolid& cutter);

}  // namespace swarf::stock
