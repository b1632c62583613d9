#include "collision/space_time.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace swarf::collision {
namespace {

MotionBounds motion_bounds(const RelativeMotion& motion, const Body& body, const AxisSegment& segment) {
  const BodyNode& root = body.nodes.front();
  return motion.bounds(segment, root.centre, root.radius);
}

/// Distance of a box from the least box that holds two others, which `slack` makes larger on every side.
double box_gap(const Vec3& still, const Vec3& still_half, const Vec3& c0, const Vec3& e0, const Vec3& c1,
               const Vec3& e1, const Vec3& slack) {
  const Vec3 low = (c0 - e0).cwiseMin(c1 - e1), high = (c0 + e0).cwiseMax(c1 + e1);
  const Vec3 below = low - (still + still_half), above = (still - still_half) - high;
  return (below.cwiseMax(above) - slack).cwiseMax(0.0).norm();
}

}  // namespace

SpaceTime::SpaceTime(const Encounter& pair, const AxisSegment& segment) : pair_(pair), segment_(segment) {
  SWARF_CHECK(!pair.a->nodes.empty() && !pair.b->nodes.empty(), "an empty body is near nothing");
  SWARF_CHECK(segment.q0.allFinite() && segment.q1.allFinite() && segment.stray.allFinite(),
              "axis values are numbers");
  const MotionBounds of_b = motion_bounds(pair.b_from_a, *pair.b, segment);
  const MotionBounds of_a = motion_bounds(pair.a_from_b, *pair.a, segment);
  const bool a_moves = of_a.slack(0.125) < of_b.slack(0.125);
  still_ = a_moves ? pair.b : pair.a;
  moving_ = a_moves ? pair.a : pair.b;
  motion_ = a_moves ? &pair.a_from_b : &pair.b_from_a;
  bounds_ = a_moves ? of_a : of_b;
}

double SpaceTime::travel(int32_t at) const {
  return bounds_.speed * (span(at).t1 - span(at).t0);
}

bool SpaceTime::is_leaf_pair(const Triple& triple) const {
  return still_->nodes[static_cast<size_t>(triple.still)].child < 0 &&
         moving_->nodes[static_cast<size_t>(triple.moving)].child < 0;
}

Span SpaceTime::make_span(double t0, double t1, const Pose& first, const Pose& last) const {
  Span span;
  span.t0 = t0;
  span.t1 = t1;
  span.first = first;
  span.last = last;
  span.turned_first = first.linear().cwiseAbs();
  span.turned_last = last.linear().cwiseAbs();
  span.aligned = first.linear() == Mat3::Identity();
  if (!span.aligned) span.turned_between = (first.linear().transpose() * last.linear()).cwiseAbs();
  span.square = (t1 - t0) * (t1 - t0) / 8.0;
  for (int k = 0; k < 3; ++k) {
    span.slack[k] = bounds_.slack(Vec3::Unit(k), span.square);
    if (!span.aligned) span.slack_turned[k] = bounds_.slack(Vec3(first.linear().col(k)), span.square);
  }
  return span;
}

Triple SpaceTime::root() {
  const Pose first = motion_->pose(segment_.q0);
  const bool moves = segment_.q0 != segment_.q1;
  spans_.assign(1, make_span(0.0, moves ? 1.0 : 0.0, first, moves ? motion_->pose(segment_.q1) : first));
  return {bound(0, 0, spans_[0]), 0, 0, 0};
}

void SpaceTime::halve_span(int32_t at) {
  const Span whole = span(at);
  const double middle = 0.5 * (whole.t0 + whole.t1);
  const Pose between = motion_->pose(segment_.at(middle));
  spans_[static_cast<size_t>(at)].child = static_cast<int32_t>(spans_.size());
  spans_.push_back(make_span(whole.t0, middle, whole.first, between));
  spans_.push_back(make_span(middle, whole.t1, between, whole.last));
}

double SpaceTime::bound(int32_t still, int32_t moving, const Span& span) const {
  const BodyNode& a = still_->nodes[static_cast<size_t>(still)];
  const BodyNode& b = moving_->nodes[static_cast<size_t>(moving)];
  const Vec3 c0 = span.first * b.centre, c1 = span.last * b.centre;
  const Vec3 e0 = span.turned_first * b.half;
  double gap = box_gap(a.centre, a.half, c0, e0, c1, span.turned_last * b.half, span.slack);
  if (!span.aligned) {
    const auto back = span.first.linear().transpose();
    gap = std::max(gap, box_gap(back * a.centre, span.turned_first.transpose() * a.half, back * c0, b.half,
                                back * c1, span.turned_between * b.half, span.slack_turned));
  }
  return gap;
}

void SpaceTime::add_part(int32_t still, int32_t moving, int32_t at, double least,
                         std::vector<Triple>& parts) const {
  parts.push_back({std::max(least, bound(still, moving, span(at))), still, moving, at});
}

void SpaceTime::split_time(const Triple& triple, std::vector<Triple>& parts) {
  if (span(triple.span).child < 0) halve_span(triple.span);
  const int32_t child = span(triple.span).child;
  for (int32_t half = child; half < child + 2; ++half) {
    add_part(triple.still, triple.moving, half, triple.lower, parts);
  }
}

void SpaceTime::split(const Triple& triple, std::vector<Triple>& parts) {
  const BodyNode& a = still_->nodes[static_cast<size_t>(triple.still)];
  const BodyNode& b = moving_->nodes[static_cast<size_t>(triple.moving)];
  const Span& during = span(triple.span);
  const double way = (during.last * b.centre - during.first * b.centre).norm() + bounds_.slack(during.square);
  const bool divides = during.t1 > during.t0;
  if (divides && way > a.radius + b.radius) return split_time(triple, parts);
  const bool first = b.child < 0 || (a.child >= 0 && a.radius >= b.radius);
  const int32_t child = first ? a.child : b.child;
  for (int32_t part = child; part < child + 2; ++part) {
    add_part(first ? part : triple.still, first ? triple.moving : part, triple.span, triple.lower, parts);
  }
}

LeafDistance SpaceTime::leaf_distance(uint32_t still, uint32_t moving, int32_t at, double enough) const {
  const Span& during = span(at);
  const bool divides = during.t1 > during.t0;
  const ConvexView other = view_of(*moving_, moving, during.first, divides ? &during.last : nullptr);
  const ConvexDistance found =
      convex_distance(view_of(*still_, still), other, enough, {&bounds_, during.square});
  LeafDistance leaf;
  leaf.lower = found.lower;
  leaf.stray = bounds_.slack(found.normal, 0.0);
  leaf.sagitta = bounds_.slack(during.square) - bounds_.slack(0.0);
  leaf.t = during.t0 + found.t * (during.t1 - during.t0);
  leaf.home_still = found.home_a;
  leaf.home_moving = found.home_b;
  leaf.upper = found.upper;
  if (divides && leaf.lower <= enough) {
    leaf.upper = (found.home_a - motion_->pose(segment_.at(leaf.t)) * found.home_b).norm();
  }
  return leaf;
}

LeafDistance SpaceTime::leaf_distance(const Triple& triple, double enough) const {
  return leaf_distance(still_->nodes[static_cast<size_t>(triple.still)].primitive,
                       moving_->nodes[static_cast<size_t>(triple.moving)].primitive, triple.span, enough);
}

void SpaceTime::tell_points(const LeafDistance& found, Vec3& point_a, Vec3& point_b) const {
  const AxisValues q = segment_.at(found.t);
  point_a = link_pose(*pair_.scene, pair_.a->link, q) * (a_moves() ? found.home_moving : found.home_still);
  point_b = link_pose(*pair_.scene, pair_.b->link, q) * (a_moves() ? found.home_still : found.home_moving);
}

PrimitivePair SpaceTime::pair_of(const Triple& triple) const {
  const uint32_t still = still_->nodes[static_cast<size_t>(triple.still)].primitive;
  const uint32_t moving = moving_->nodes[static_cast<size_t>(triple.moving)].primitive;
  return a_moves() ? PrimitivePair{moving, still} : PrimitivePair{still, moving};
}

}  // namespace swarf::collision
