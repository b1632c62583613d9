#include "position/triangle_rest.h"

#include <algorithm>
#include <cmath>

#include "position/edge_rest.h"

namespace swarf::position {
namespace {

/// A facet nearer to the axis' direction has no slope that means anything; its sides hold all it says.
constexpr double kUprightCosine = 1e-14;
/// Above this slope the facet's own place is subject to rounding: its sides are asked too.
constexpr double kSteepFacet = 1e6;
/// Of the coordinates, per slope: above what rounding may do to the height of a plane.
constexpr double kPlaneSlack = 1e-12;

double cross(const Vec3& u, double x, double y) {
  return u.x() * y - u.y() * x;
}

/// Where the plane of the triangle is touched, about the axis, and how it is turned.
struct PlaneTouch {
  bool upright = true;
  double slope = 0.0;
  double turn = 1.0;  ///< -1 when the triangle is seen from below
  double x = 0.0, y = 0.0, rho = 0.0;
  double height = 0.0;  ///< that the plane gives the tip
};

PlaneTouch touch_plane(const ToolProfile& profile, const LocalTriangle& t) {
  Vec3 n = (t.b - t.a).cross(t.c - t.a);
  PlaneTouch touch;
  if (std::abs(n.z()) <= kUprightCosine * n.norm()) return touch;
  touch.upright = false;
  if (n.z() < 0.0) {
    touch.turn = -1.0;
    n = -n;
  }
  const double side = std::sqrt(n.x() * n.x() + n.y() * n.y());
  touch.slope = side / n.z();
  touch.rho = profile.touching(touch.slope).low;
  if (side > 0.0) {
    touch.x = -touch.rho * n.x() / side;
    touch.y = -touch.rho * n.y() / side;
  }
  touch.height = t.a.z() + (n.x() * (t.a.x() - touch.x) + n.y() * (t.a.y() - touch.y)) / n.z() -
                 profile.height(touch.rho);
  return touch;
}

/// Twice the areas that the place makes with the sides from a, b and c: below 0 where it lies beyond one.
struct SideAreas {
  double of_a, of_b, of_c;
  bool inside() const { return of_a > 0.0 && of_b > 0.0 && of_c > 0.0; }
};
SideAreas side_areas(const LocalTriangle& t, const PlaneTouch& touch) {
  const auto beside = [&](const Vec3& from, const Vec3& to) {
    return touch.turn * cross(to - from, touch.x - from.x(), touch.y - from.y());
  };
  return {beside(t.a, t.b), beside(t.b, t.c), beside(t.c, t.a)};
}

/// Weighted means of the corners: a point of the triangle, whatever rounding has done to the place.
TriangleRest rest_on_facet(const ToolProfile& profile, const LocalTriangle& t, const SideAreas& areas,
                           double top) {
  const double sum = areas.of_a + areas.of_b + areas.of_c;
  TriangleRest rest;
  rest.what = Touched::kFace;
  rest.contact = (areas.of_b / sum) * t.a + (areas.of_c / sum) * t.b + (areas.of_a / sum) * t.c;
  const double rho = rest.contact.head<2>().norm();
  rest.height = std::min(rest.contact.z(), top) - profile.height(std::min(rho, profile.radius()));
  return rest;
}

void raise_by_side(const ToolProfile& profile, const LocalTriangle& t, int side, TriangleRest& rest) {
  const int next = (side + 1) % 3;
  const Vec3 &p = t.corner(side), &q = t.corner(next);
  const EdgeRest edge = rest_on_edge(profile, p, q);
  if (!(edge.height > rest.height)) return;
  rest.height = edge.height;
  rest.what = edge.part > 0.0 && edge.part < 1.0 ? Touched::kEdge : Touched::kVertex;
  rest.place = edge.part == 1.0 ? next : side;
  rest.contact = edge.part == 1.0 ? q : Vec3(p + edge.part * (q - p));
}

/// Rounding of the height of a plane of this slope through points so far off, generously.
double plane_slack(const LocalTriangle& t, double slope) {
  const double reach = t.a.cwiseAbs().sum() + t.b.cwiseAbs().sum() + t.c.cwiseAbs().sum();
  return kPlaneSlack * (1.0 + slope) * (1.0 + reach);
}

}  // namespace

TriangleRest rest_on_triangle(const ToolProfile& profile, const LocalTriangle& t, double floor) {
  TriangleRest rest;
  const double top = std::max({t.a.z(), t.b.z(), t.c.z()});
  if (top <= floor) return rest;
  const PlaneTouch touch = touch_plane(profile, t);
  const bool trusted = !touch.upright && touch.slope < kSteepFacet;
  if (trusted && touch.height + plane_slack(t, touch.slope) <= floor) return rest;
  SideAreas areas{-1.0, -1.0, -1.0};
  if (!touch.upright) {
    areas = side_areas(t, touch);
    if (areas.inside()) rest = rest_on_facet(profile, t, areas, top);
    if (areas.inside() && trusted) return rest;
  }
  if (!trusted || areas.of_a <= 0.0) raise_by_side(profile, t, 0, rest);
  if (!trusted || areas.of_b <= 0.0) raise_by_side(profile, t, 1, rest);
  if (!trusted || areas.of_c <= 0.0) raise_by_side(profile, t, 2, rest);
  return rest;
}

Vec2 triangle_gradient(const ToolProfile& profile, const LocalTriangle& t, const TriangleRest& rest) {
  if (rest.what == Touched::kVertex) return gradient_at(profile, rest.contact, Vec3::Zero());
  if (rest.what == Touched::kEdge)
    return gradient_at(profile, rest.contact, t.corner((rest.place + 1) % 3) - t.corner(rest.place));
  const Vec3 n = (t.b - t.a).cross(t.c - t.a);
  return -n.head<2>() / n.z();
}

}  // namespace swarf::position
