#include "stock/contact/convex_contact.h"

#include <algorithm>
#include <limits>

#include "stock/sweep/convex_motion.h"

namespace swarf::stock {

SweepContact swept_contact(const Vec3& point_W, const SweepMap& map, const CutterSolid& cutter) {
  const Vec3 P = map.start(point_W), D = map.end(point_W) - P;
  SweepContact contact{std::numeric_limits<double>::infinity()};
  for (size_t n = 0; n < cutter.pieces.size(); ++n) {
    const Nearest nearest = nearest_instant(cutter.pieces[n], P, D);
    if (nearest.value >= contact.distance_mm) continue;
    // X(t) is a mean of two rigid maps of the point; its transpose carries gradients back.
    const Vec3 gradient = map.R0t.transpose() * ((1.0 - nearest.t) * nearest.normal) +
                          map.R1t.transpose() * (nearest.t * nearest.normal);
    constexpr double kRidge = 1e-9;
    const double length = gradient.norm();
    contact = {nearest.value, nearest.t, n, length > kRidge ? Vec3(gradient / length) : Vec3(Vec3::Zero())};
  }
  return contact;
}

}  // namespace swarf::stock
