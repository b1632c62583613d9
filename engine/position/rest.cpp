#include "position/rest.h"

namespace swarf::position {

GuideLine upright(double x, double y) {
  GuideLine line;
  line.point_W = {x, y, 0.0};
  return line;
}

GuideLine guide_line(const Vec3& point_W, const Vec3& axis_W) {
  GuideLine line;
  line.point_W = point_W;
  line.axis_W = axis_W.normalized();
  line.x_W = line.axis_W.unitOrthogonal();
  line.y_W = line.axis_W.cross(line.x_W);
  return line;
}

}  // namespace swarf::position
