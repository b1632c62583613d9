#include "position/rest.h"

namespace swarf::position {

GuideLine upright(double x, double y) {
  GuideLine line;
  line.point_W = {x, y, 0.0};
  return line;
}

GuideLine turned_line(const Vec3& point_W, const Vec3& a) {
  constexpr double kStraightDown = 1e-12;
  GuideLine line;
  line.point_W = point_W;
  line.axis_W = a;
  const double lift = 1.0 + a.z();
  if (lift < kStraightDown) {
    line.y_W = -Vec3::UnitY();
    line.axis_W = -Vec3::UnitZ();
    return line;
  }
  line.x_W = Vec3(1.0 - a.x() * a.x() / lift, -a.x() * a.y() / lift, -a.x());
  line.y_W = Vec3(-a.x() * a.y() / lift, 1.0 - a.y() * a.y() / lift, -a.y());
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
