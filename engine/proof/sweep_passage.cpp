#include "proof/sweep_passage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "collision/convex_distance.h"
#include "stock/sweep/sweep_map.h"

namespace swarf::proof {
namespace {

using FacetCorners = std::array<Vec3, 3>;

/// A turning sweep is not divided below this share of its time.
constexpr double kShortest = 1.0 / 256.0;
/// Directions that a body keeps.
constexpr size_t kKept = 10;

/// Angle between two axes, rad.
double turn_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Greatest d . x over a body that stands in the tool's frame; d of length 1.
double reach_at_home(const MeridianProfile& profile, const Vec3& d) {
  return profile.greatest({d.head<2>().norm(), d.z()});
}

/// A body over a part of a sweep's time.
class SpanBody {
 public:
  SpanBody(const stock::Sweep& sweep, const MeridianProfile& profile, double t0, double t1)
      : profile_(profile),
        solid_(profile.solid()),
        turn_(turn_between(sweep.start.axis_W, sweep.end.axis_W)) {
    const stock::SweepMap map = stock::sweep_map(sweep);
    const std::array<double, 2> times{t0, t1};
    for (size_t i = 0; i < 2; ++i) {
      const double t = times[i];
      ends_[i] = at(sweep, t);
      rows_[i] = (1.0 - t) * map.R0t + t * map.R1t;
      origin_[i] = -((1.0 - t) * (map.R0t * map.tip0) + t * (map.R1t * map.tip1));
    }
    if (turn_ == 0.0) return;
    double lever = 0.0;
    for (const Vec2& ring : solid_.corners) lever = std::max(lever, ring.norm());
    stray_mm_ = stock::motion_bound(map, lever);
    const double part = turn_ * (t1 - t0);
    sagitta_per_lever_ = part * part / 8.0;
    sagitta_mm_ = sagitta_per_lever_ * lever;
  }

  bool turns() const { return turn_ > 0.0; }
  /// In the work's frame.
  Box box() const {
    Box box = collision::bounds({ends_[0].tip_W, ends_[0].axis_W, solid_.corners});
    const Box other = collision::bounds({ends_[1].tip_W, ends_[1].axis_W, solid_.corners});
    const Vec3 wide = Vec3::Constant(stray_mm_ + sagitta_mm_);
    return {box.lower.cwiseMin(other.lower) - wide, box.upper.cwiseMax(other.upper) + wide};
  }
  /// Whether n . x >= limit all over it; n of length 1 in the work's frame.
  bool is_beyond(const Vec3& n, double limit_mm) const {
    bool is_near = false;
    for (const ToolPose& end : ends_) {
      const Vec2 down(n.cross(end.axis_W).norm(), -n.dot(end.axis_W));
      const double least = n.dot(end.tip_W) - profile_.greatest(down) - stray_mm_;
      if (least < limit_mm) return false;
      is_near = is_near || least - sagitta_mm_ < limit_mm;
    }
    return !is_near || least_along(n) >= limit_mm;
  }
  /// What the body may stray from the motion on straight lines in the tool's frame, mm.
  double stray_mm() const { return stray_mm_; }
  /// A direction of the tool's frame at one end, in the work's frame, and what is added to its products.
  struct Along {
    Vec3 way;
    double offset;
  };
  Along along(const Vec3& d, size_t end) const { return {rows_[end].transpose() * d, d.dot(origin_[end])}; }
  /// The direction from the body to a facet, in the tool's frame, of a plane that parts them.
  std::optional<Vec3> parting(const FacetCorners& facet) const {
    collision::ConvexView tool, flat;
    tool.solid = &solid_;
    flat.poses = 2;
    for (size_t k = 0; k < 3; ++k) {
      flat.home[k] = facet[k];
      for (size_t i = 0; i < 2; ++i) flat.corners[3 * i + k] = rows_[i] * facet[k] + origin_[i];
    }
    const collision::ConvexDistance apart = collision::convex_distance(tool, flat, stray_mm_);
    if (!(apart.lower > stray_mm_)) return std::nullopt;
    return Vec3(-apart.normal);
  }
  /// A point of it, far from the tip.
  Vec3 top() const { return ends_[0].tip_W + solid_.corners.back().y() * ends_[0].axis_W; }

 private:
  /// Least n . x over it, with the sagitta of each ring.
  double least_along(const Vec3& n) const {
    double least = std::numeric_limits<double>::infinity();
    for (const ToolPose& end : ends_) {
      const double along = n.dot(end.axis_W), across = n.cross(end.axis_W).norm(), tip = n.dot(end.tip_W);
      for (const Vec2& ring : solid_.corners)
        least =
            std::min(least, tip + along * ring.y() - across * ring.x() - sagitta_per_lever_ * ring.norm());
    }
    return least - stray_mm_;
  }
  ToolPose at(const stock::Sweep& sweep, double t) const {
    const Vec3 tip = sweep.start.tip_W + t * (sweep.end.tip_W - sweep.start.tip_W);
    if (turn_ == 0.0) return {tip, sweep.start.axis_W};
    const Vec3 axis =
        std::sin((1.0 - t) * turn_) * sweep.start.axis_W + std::sin(t * turn_) * sweep.end.axis_W;
    return {tip, axis.normalized()};
  }

  const MeridianProfile& profile_;
  const collision::RevolvedSolid& solid_;
  double turn_;  ///< of the whole sweep, rad
  std::array<ToolPose, 2> ends_;
  std::array<Mat3, 2> rows_;    ///< work's to tool's frame
  std::array<Vec3, 2> origin_;  ///< of the work's frame, in the tool's
  double stray_mm_ = 0.0, sagitta_mm_ = 0.0, sagitta_per_lever_ = 0.0;
};

/// Looks for planes between one body and facets.
class Parting {
 public:
  /// `reaches`: known directions, of the body at home.
  Parting(const SpanBody& body, const MeridianProfile& profile, std::vector<Reach>& reaches)
      : body_(body), profile_(profile), reaches_(reaches), box_(body.box()), ends_(body.turns() ? 2 : 1) {
    for (const Reach& reach : reaches) planes_.push_back(plane_of(reach));
  }

  bool is_clear(const FacetGroup& group) const {
    if (!do_meet(box_, group.box)) return true;
    if (body_.is_beyond(group.normal, group.top_mm)) return true;
    // More of them cost more than they save.
    constexpr size_t kTried = 4;
    const Vec3 middle = 0.5 * (group.box.lower + group.box.upper), half = group.box.upper - middle;
    const auto lies_beyond = [&](const Plane& plane) {
      for (size_t i = 0; i < ends_; ++i) {
        const SpanBody::Along& end = plane.ends[i];
        if (plane.reach_mm > end.way.dot(middle) - end.way.cwiseAbs().dot(half) + end.offset) return false;
      }
      return true;
    };
    const auto end = planes_.begin() + static_cast<std::ptrdiff_t>(std::min(kTried, planes_.size()));
    return std::any_of(planes_.begin(), end, lies_beyond);
  }

  bool is_clear(const FacetCorners& facet, const Vec3& normal) {
    for (size_t n = 0; n < planes_.size(); ++n) {
      if (!lies_beyond(planes_[n], facet)) continue;
      move_to_front(reaches_, n);
      move_to_front(planes_, n);
      return true;
    }
    if (body_.is_beyond(normal, normal.dot(facet[0]))) return true;
    const std::optional<Vec3> direction = body_.parting(facet);
    if (!direction) return false;
    const Reach reach{*direction, reach_at_home(profile_, *direction)};
    reaches_.insert(reaches_.begin(), reach);
    planes_.insert(planes_.begin(), plane_of(reach));
    if (reaches_.size() > kKept) {
      reaches_.pop_back();
      planes_.pop_back();
    }
    return true;
  }

 private:
  struct Plane {
    double reach_mm;
    std::array<SpanBody::Along, 2> ends;
  };

  Plane plane_of(const Reach& reach) const {
    Plane plane{reach.mm + body_.stray_mm(),
                {body_.along(reach.direction, 0), body_.along(reach.direction, 1)}};
    // Without a turn both ends see a facet in one direction.
    if (ends_ == 1) plane.ends[0].offset = std::min(plane.ends[0].offset, plane.ends[1].offset);
    return plane;
  }
  bool lies_beyond(const Plane& plane, const FacetCorners& facet) const {
    for (size_t i = 0; i < ends_; ++i) {
      const SpanBody::Along& end = plane.ends[i];
      const double least = std::min({end.way.dot(facet[0]), end.way.dot(facet[1]), end.way.dot(facet[2])});
      if (plane.reach_mm > least + end.offset) return false;
    }
    return true;
  }
  template <typename List>
  static void move_to_front(List& list, size_t n) {
    const auto at = list.begin() + static_cast<std::ptrdiff_t>(n);
    std::rotate(list.begin(), at, at + 1);
  }

  const SpanBody& body_;
  const MeridianProfile& profile_;
  std::vector<Reach>& reaches_;
  Box box_;
  size_t ends_;                ///< of a plane, that count
  std::vector<Plane> planes_;  ///< of reaches_
};

Meeting meets_span(const SolidDesign& design, const SpanBody& body, Parting parting) {
  uint32_t met = kInside;
  const bool blocked = design.tree().any(
      [&](const FacetGroup& group) { return parting.is_clear(group); },
      [&](uint32_t facet) {
        met = facet;
        const mesh::SignedDistance& all = design.distance();
        const FacetCorners corners{all.corner(facet, 0), all.corner(facet, 1), all.corner(facet, 2)};
        return !parting.is_clear(corners, all.face_normal(facet));
      });
  if (blocked) return met;
  if (design.distance().at(body.top()).distance_mm < 0.0) return kInside;
  return std::nullopt;
}

}  // namespace

MeridianProfile::MeridianProfile(const collision::RevolvedSolid& solid) : solid_(&solid) {
  const auto turns_right = [&](const Vec2& c) {
    const Vec2 &a = outer_[outer_.size() - 2], &b = outer_.back();
    const Vec2 ab = b - a, bc = c - b;
    return ab.x() * bc.y() - ab.y() * bc.x() <= 0.0;
  };
  for (const Vec2& corner : solid.corners) {
    while (outer_.size() >= 2 && turns_right(corner)) outer_.pop_back();
    outer_.push_back(corner);
  }
}

double MeridianProfile::greatest(const Vec2& d) const {
  // From the lowest corner to the highest the products rise, then fall.
  size_t low = 0, high = outer_.size() - 1;
  while (low < high) {
    const size_t middle = (low + high) / 2;
    if (d.dot(outer_[middle + 1] - outer_[middle]) > 0.0)
      low = middle + 1;
    else
      high = middle;
  }
  return d.dot(outer_[low]);
}

Meeting SweepPassage::meets(const stock::Sweep& sweep, const collision::RevolvedSolid& solid) {
  const auto known = bodies_.try_emplace(&solid, solid).first;
  const MeridianProfile& profile = known->second.profile;
  std::vector<Reach>& reaches = known->second.reaches;
  if (reaches.empty())
    for (const Vec3& d : {Vec3(-Vec3::UnitZ()), Vec3(Vec3::UnitZ())})
      reaches.push_back({d, reach_at_home(profile, d)});
  std::vector<std::array<double, 2>> spans{{0.0, 1.0}};
  while (!spans.empty()) {
    const auto [t0, t1] = spans.back();
    spans.pop_back();
    const SpanBody body(sweep, profile, t0, t1);
    const Meeting met = meets_span(design_, body, Parting(body, profile, reaches));
    if (!met) continue;
    if (!body.turns() || t1 - t0 < kShortest) return met;
    const double middle = 0.5 * (t0 + t1);
    spans.push_back({middle, t1});
    spans.push_back({t0, middle});
  }
  return std::nullopt;
}

}  // namespace swarf::proof
