// A point of the work against the volume that a cutter sweeps: signed distance, instant and normal, in double
// precision for meshing and checks. The hot loops have their own kernels (leaf_kernel, convex_leaf_kernel).
#pragma once

#include "base/frames.h"
#include "stock/sweep/sweep.h"
#include "stock/sweep/sweep_map.h"

namespace swarf::stock {

struct SweepContact {
  double distance_mm = 0.0;  ///< min over t of F: negative inside the sweep; within 1e-12 mm of the minimum
  double t = 0.0;            ///< instant at which the point comes nearest to the cutter
  size_t piece = 0;          ///< of the cutter
  /// Gradient of the distance, unit vector, W: it points out of the swept volume, into the material. Where
  /// the minimum is a kink of F (a sharp edge passes) it is the mean of both sides' gradients that is
  /// perpendicular to the motion, which is the normal of the surface the edge sweeps. Zero where the distance
  /// has a ridge, deep inside the sweep.
  Vec3 normal_W = Vec3::Zero();
};

SweepContact swept_contact(const Vec3& point_W, const SweepMap& map, const CutterSolid& cutter);

}  // namespace swarf::stock
