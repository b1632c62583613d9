#include "toolpath/orientation.h"

#include <cmath>

#include "toolpath/tool_path.h"

namespace swarf::toolpath {

Lean lean_of(double lead, double tilt) {
  const double forward = std::sin(lead);
  const double left = std::cos(lead) * std::sin(tilt);
  return {std::atan2(std::hypot(forward, left), std::cos(lead) * std::cos(tilt)), std::atan2(left, forward)};
}

// The rim contact does not tend to the centre contact as the lean tends to zero: even the slightest lean
// lifts the whole bottom off the surface except one rim point. Hence the explicit case for zero lean.
ToolPose pose_in_contact(const Vec3& contact, const Vec3& normal, const Vec3& unit_feed, double lead,
                         double tilt, const ContactEnd& end) {
  if (lead == 0.0 && tilt == 0.0) return {contact, normal};
  const Vec3 left = normal.cross(unit_feed);
  const Vec3 axis =
      std::cos(lead) * (std::cos(tilt) * normal + std::sin(tilt) * left) + std::sin(lead) * unit_feed;
  // Lowest point of the rim: -n projected into the bottom plane.
  const Vec3 to_contact = (normal.dot(axis) * axis - normal).normalized();
  return {contact - end.flat_mm * to_contact + end.corner_mm * (normal - axis), axis};
}

}  // namespace swarf::toolpath
