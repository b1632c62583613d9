// What of a part is wrong whatever limit somebody would have set.
#pragma once

#include "measure/metrics.h"
#include "sim/job/scene.h"

namespace swarf::sim {

/// Of what the stock lacks where [accept] has no limit of gouges, um: facets of stock and design that stand
/// for one round face lie so near to each other (brep::kEdgeChord on both sides).
inline constexpr double kMissingAllowed = 10.0;

enum class UnlimitedGouge { kNone, kMissing, kCut };

/// What fails without a limit; of both what is more.
inline UnlimitedGouge unlimited_gouge(const measure::SurfaceMetrics& surface) {
  const bool missing = surface.missing_max_um > kMissingAllowed;
  if (surface.gouge_max_um > kGougeAllowed && !(missing && surface.missing_max_um >= surface.gouge_max_um))
    return UnlimitedGouge::kCut;
  return missing ? UnlimitedGouge::kMissing : UnlimitedGouge::kNone;
}

}  // namespace swarf::sim
