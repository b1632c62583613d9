#include "position/part.h"

namespace swarf::position {

Rest Part::rest(const ToolProfile& profile, const GuideLine& line, Near& near) const {
  Rest best;
  for (const auto& target : targets) target->raise(profile, line, best, near);
  if (!floor_mm) return best;
  const double height = *floor_mm - line.point_W.z();
  if (best.height >= height) return best;
  best = {};
  best.height = height;
  best.what = Touched::kFace;
  best.contact_W = line.world({0.0, 0.0, height});
  return best;
}

}  // namespace swarf::position
