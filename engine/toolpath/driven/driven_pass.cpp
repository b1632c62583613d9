#include "toolpath/driven/driven_pass.h"

namespace swarf::toolpath {

position::GuideLine PlaneGuide::line(double x) const {
  const Vec2 at = curve_.point(x);
  position::GuideLine line = plane_;
  line.point_W += at.x() * plane_.x_W + at.y() * plane_.y_W;
  return line;
}

TipPoint tip_at(const DrivenPass& pass, double x, position::Near& near) {
  const position::GuideLine line = pass.guide->line(x);
  TipPoint at;
  at.rest = pass.on->part.rest(pass.on->profile, line, near);
  at.pose = {line.point_W + at.rest.height * line.axis_W, line.axis_W};
  return at;
}

}  // namespace swarf::toolpath
