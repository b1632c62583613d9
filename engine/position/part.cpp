#include "position/part.h"

namespace swarf::position {

Rest Part::rest(const ToolProfile& profile, const GuideLine& line, Near& near) const {
  Rest best;
  for (const auto& target : targets) target->raise(profile, line, best, near);
  if (!floor_mm) return best;
  if (!(line.axis_W.z() > 0.0)) return best;
  // Heights of the plane over the line's x and y: those on the axis, and how they change.
  const Vec2 slope = -Vec2(line.x_W.z(), line.y_W.z()) / line.axis_W.z();
  const double on_axis = (*floor_mm - line.point_W.z()) / line.axis_W.z();
  const double height = on_axis + profile.lift(slope.norm());
  if (best.height >= height) return best;
  best = {};
  best.height = height;
  best.what = Touched::kFace;
  best.gradient = slope;
  const double rho = profile.touching(slope.norm()).low;
  const Vec2 at = slope.norm() > 0.0 ? Vec2(rho * slope.normalized()) : Vec2(0.0, 0.0);
  best.contact_W = line.world({at.x(), at.y(), on_axis + slope.dot(at)});
  return best;
}

}  // namespace swarf::position
