#include "sim/run/missing_material.h"

#include "base/units.h"
#include "measure/metrics.h"
#include "sim/job/design_place.h"

namespace swarf::sim {

void raise_missing(const Job& job, measure::SurfaceMetrics& surface) {
  const DesignBeyond beyond = design_beyond(job);
  if (um_from_mm(beyond.mm) <= surface.missing_max_um) return;
  surface.missing_max_um = um_from_mm(beyond.mm);
  surface.missing_place = beyond.place;
}

}  // namespace swarf::sim
