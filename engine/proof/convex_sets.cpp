#include "proof/convex_sets.h"

#include <cmath>

#include "mesh/mesh_distance.h"
#include "stock/contact/convex_contact.h"
#include "stock/sweep/convex_motion.h"
#include "stock/sweep/sweep_distance.h"
#include "stock/sweep/sweep_map.h"

namespace swarf::proof {
namespace {

/// mm: values of sweeps are known this closely, never too low.
constexpr double kSweepGap = 1e-9;

double to_facet(const std::array<Vec3, 3>& facet, const Vec3& x) {
  return (x - mesh::closest_point_on_triangle(x, facet[0], facet[1], facet[2])).norm();
}

}  // namespace

SweepSet::SweepSet(const stock::Sweep& sweep, const stock::CutterSolid& cutter, size_t piece,
                   const Vec3& near)
    : cutter_(&cutter), piece_(piece) {
  const stock::SweepMap map = stock::sweep_map(sweep);
  if (sweep.start.axis_W == sweep.end.axis_W) {
    rows_ = map.R0t;
    origin_ = -(map.R0t * map.tip0);
    way_ = map.R0t * (map.tip0 - map.tip1);
    moves_ = way_.squaredNorm() > 0.0;
    return;
  }
  const Vec3 start = map.start(near), way = map.end(near) - start;
  const double t = stock::nearest_instant(cutter.pieces[piece], start, way, 0.0, 1.0, kSweepGap).t;
  rows_ = (1.0 - t) * map.R0t + t * map.R1t;
  origin_ = -((1.0 - t) * (map.R0t * map.tip0) + t * (map.R1t * map.tip1));
  way_ = Vec3::Zero();
}

double SweepSet::value(const Vec3& x) const {
  const Vec3 p = rows_ * x + origin_;
  const cutter::ConvexPiece& piece = cutter_->pieces[piece_];
  if (!moves_) return cutter::signed_distance(piece, p.head<2>().norm(), p.z());
  if (cutter_->is_cylinder())
    return stock::swept_distance<double, true>({p.x(), p.y(), p.z(), way_.x(), way_.y(), way_.z()},
                                               piece.radius, piece.high);
  return stock::nearest_instant(piece, p, way_, 0.0, 1.0, kSweepGap).value;
}

double NearerSet::value(const Vec3& x) const {
  // Strictly nearer: of two facets in one place neither answers for the other.
  constexpr double kShare = 1e-9, kStrict = 1e-9;
  return to_facet(facet, x) - (1.0 - kShare) * height(x) + kStrict;
}

double WithinSet::value(const Vec3& x) const {
  return to_facet(facet, x) - mm;
}

double value(const ConvexSet& set, const Vec3& x) {
  return std::visit([&](const auto& one) { return one.value(x); }, set);
}

Vec3 gradient(const ConvexSet& set, const Vec3& x) {
  constexpr double kStep = 1e-6;  // mm
  Vec3 slope;
  for (int k = 0; k < 3; ++k)
    slope[k] = value(set, x + kStep * Vec3::Unit(k)) - value(set, x - kStep * Vec3::Unit(k));
  const double length = slope.norm();
  return length > 0.0 ? Vec3(slope / length) : Vec3::UnitZ();
}

}  // namespace swarf::proof
