// What of a part stands too high whatever limit somebody would have set.
#pragma once

#include "base/units.h"
#include "sim/job/scene.h"
#include "sim/run/result.h"

namespace swarf::sim {

struct HighestLeft {
  double um = 0.0;
  Vec3 place = Vec3::Zero();  ///< W, mm
  uint32_t block = stock::kUncut;
};

/// Of a body the highest material anywhere. Of patches what stands on them: above a gap the stock may stand
/// elsewhere on the same ray.
inline HighestLeft highest_left(const Job& job, const Result& result) {
  const measure::SurfaceMetrics& surface = result.main.surface;
  if (job.design_mesh) return {surface.excess_max_um, surface.excess_top, surface.excess_block};
  HighestLeft most;
  for (const stock::SurfaceDexels& dexels : result.main.dexels) {
    for (size_t n = 0; n < dexels.heights_mm().size(); ++n) {
      const double um = um_from_mm(dexels.heights_mm()[n]);
      if (um > most.um) most = {um, dexels.field().points[n], dexels.blocks()[n]};
    }
  }
  return most;
}

}  // namespace swarf::sim
