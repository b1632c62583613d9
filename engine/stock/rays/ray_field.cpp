#include "stock/rays/ray_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "stock/rays/surface_dexels.h"
#include "stock/rays/surface_foot.h"

namespace swarf::stock {
namespace {

Foot foot_on_surface(const surface::Surface& surface, double u, double v) {
  const surface::Derivatives d = surface.derivatives(u, v);
  return {d.S, surface::outward_normal(surface, d, {u, v}), u, v};
}

/// (u,v) of a ray displaced by a tangent vector: the normal equations of Su du + Sv dv = tangent.
Vec2 parameters_along(const surface::Derivatives& d, const Vec3& tangent) {
  const double E = d.Su.squaredNorm(), F = d.Su.dot(d.Sv), G = d.Sv.squaredNorm();
  const double a = d.Su.dot(tangent), b = d.Sv.dot(tangent);
  const double det = E * G - F * F;
  return {(G * a - F * b) / det, (E * b - F * a) / det};
}

/// (b, c) for which b B + c C comes nearest to x; none where B and C do not span a plane.
Vec2 nearest_shares(const Vec3& B, const Vec3& C, const Vec3& x) {
  const double E = B.squaredNorm(), F = B.dot(C), G = C.squaredNorm(), det = E * G - F * F;
  if (!(det > 1e-14 * E * G)) return Vec2::Zero();
  return {(G * B.dot(x) - F * C.dot(x)) / det, (E * C.dot(x) - F * B.dot(x)) / det};
}

/// Shares of two sides of a triangle, brought into it.
Vec2 within_triangle(const Vec2& l) {
  const Vec2 positive = l.cwiseMax(0.0);
  return positive / std::max(1.0, positive.sum());
}

std::array<Vec3, 3> mesh_corners(const TriMesh& mesh, uint32_t triangle) {
  const auto corner = [&](size_t k) {
    const auto& p = mesh.positions[mesh.triangles[triangle][k]];
    return Vec3(p[0], p[1], p[2]);
  };
  return {corner(0), corner(1), corner(2)};
}

/// Whether the design, near the facet that is nearest, keeps this far away from a point: never false where
/// the whole design does. The facets decide, where they can.
bool keeps_away(const DesignMesh& design, const Vec3& point, double least_mm) {
  const mesh::NearestPoint near = design.distance.nearest(point);
  const double stray = design.under != nullptr ? design.under->chord_mm : 0.0;
  if (near.distance_mm - stray >= least_mm) return true;
  if (near.distance_mm + stray < least_mm) return false;
  return design.nearest_on(near.triangle, point).distance_mm >= least_mm;
}

}  // namespace

Foot RayField::between(uint32_t a, uint32_t b, double t) const {
  if (surface == nullptr) {
    constexpr double kReach = 1.2;  // of the way between the rays: the facets bend aside
    const Vec3 foot = points[a] + t * (points[b] - points[a]);
    const Vec3 along = normals[a] + t * (normals[b] - normals[a]);
    const double radius = kReach * (points[b] - points[a]).norm();
    const auto met = sheets->meet(facet_of[a], points[a], radius, foot, along);
    const FacetPlace place = met ? *met : sheets->nearest(facet_of[a], points[a], radius, foot);
    return {place.point, place.normal};
  }
  const size_t nu = u_lines.size();
  const double ua = u_lines[a % nu], va = v_lines[a / nu];
  return foot_on_surface(*surface, ua + t * (u_lines[b % nu] - ua), va + t * (v_lines[b / nu] - va));
}

std::optional<Foot> RayField::displaced(uint32_t ray, const Vec3& tangent_mm) const {
  if (surface != nullptr) {
    const size_t nu = u_lines.size();
    const double u = u_lines[ray % nu], v = v_lines[ray / nu];
    const Vec2 step = parameters_along(surface->derivatives(u, v), tangent_mm);
    const Vec2 at = Vec2(u, v) + step;
    if (at.minCoeff() < 0.0 || at.maxCoeff() > 1.0) return std::nullopt;
    return foot_on_surface(*surface, at.x(), at.y());
  }
  // Facets that bend away from the tangent plane are met farther out; of the displacement and of the pitch.
  constexpr double kOut = 1.5, kLeast = 0.1;
  const double radius = kOut * tangent_mm.norm() + kLeast * pitch_mm;
  const auto met = sheets->meet(facet_of[ray], points[ray], radius, points[ray] + tangent_mm, normals[ray]);
  if (!met) return std::nullopt;
  return Foot{met->point, met->normal};
}

DesignMesh::Place DesignMesh::nearest_on(uint32_t triangle, const Vec3& point) const {
  const auto [a, b, c] = mesh_corners(mesh, triangle);
  const Vec3 on_facet = mesh::closest_point_on_triangle(point, a, b, c);
  if (under == nullptr || !under->is_curved(triangle))
    return {on_facet, {}, (point - on_facet).norm(), triangle};
  const surface::FacetOnSurface& on = under->facets[triangle];
  const SurfaceFoot foot = surface_foot(*under->surfaces[static_cast<size_t>(on.surface)], on.uv,
                                        within_triangle(nearest_shares(b - a, c - a, on_facet - a)), point);
  return {foot.point, foot.uv, foot.distance_mm, triangle};
}

DesignMesh::Place DesignMesh::nearest(const Vec3& point, double within_mm) const {
  const mesh::NearestPoint near = distance.nearest(point, within_mm);
  if (under == nullptr || !std::isfinite(near.distance_mm))
    return {near.point, {}, near.distance_mm, near.triangle};
  Place best = nearest_on(near.triangle, point);
  distance.each_near(point, near.distance_mm + 2.0 * under->chord_mm, [&](uint32_t triangle) {
    if (triangle == near.triangle) return;
    const auto [a, b, c] = mesh_corners(mesh, triangle);
    const double facet_mm = (mesh::closest_point_on_triangle(point, a, b, c) - point).norm();
    if (facet_mm - under->chord_mm > best.distance_mm) return;
    const Place place = nearest_on(triangle, point);
    if (std::pair(place.distance_mm, triangle) < std::pair(best.distance_mm, best.triangle)) best = place;
  });
  return best;
}

double RayField::own_depth(const Vec3& point, const Vec3& normal, double depth_mm, double share) const {
  if (design == nullptr || depth_mm <= 0.0) return depth_mm;
  constexpr int kHalvings = 40;
  const auto is_flat = [&] {
    const auto& facet = design->mesh.triangles[design->distance.nearest(point).triangle];
    const auto vertex = [&](size_t k) {
      const auto& p = design->mesh.positions[facet[k]];
      return Vec3(p[0], p[1], p[2]);
    };
    const Vec3 across = (vertex(1) - vertex(0)).cross(vertex(2) - vertex(0));
    return std::abs(across.dot(normal)) >= (1.0 - 1e-9) * across.norm();
  };
  // Surfaces have their own normals everywhere.
  const double least = design->under != nullptr || is_flat() ? kOwnShare : kOwnShareLeaning;
  const auto is_own = [&](double s) {
    return keeps_away(*design, point - s * normal, least * s - kFloatMesh);
  };
  // Far beyond the part the distance is nearly the depth again: what is not own on the way ends it.
  constexpr double kThinnest = 0.1;  // mm
  double low = 0.0, high = std::numeric_limits<double>::infinity();
  for (double s = depth_mm;; s *= 0.5) {
    if (!is_own(s)) high = s;
    if (s <= kThinnest) break;
  }
  if (high > depth_mm) return depth_mm;
  // mm; over faces each look takes several feet.
  const double rounding = 1e-9;
  for (int i = 0; i < kHalvings && high - low > std::max(rounding, share * high); ++i) {
    const double middle = 0.5 * (low + high);
    (is_own(middle) ? low : high) = middle;
  }
  return low;
}

bool RayField::answers_for(const Vec3& point, const Vec3& normal, double high) const {
  return high >= 0.0 || (high >= -kSkin && own_depth(point, normal, -high) >= -high);
}

void add_tile(RayField& field, uint32_t begin) {
  RayTile tile{begin, static_cast<uint32_t>(field.order.size()) - begin};
  const auto ray = [&](uint32_t n) { return field.order[begin + n]; };
  Vec3 mean = Vec3::Zero();
  for (uint32_t n = 0; n < tile.count; ++n) mean += field.normals[ray(n)];
  const double length = mean.norm();
  if (length > 0.0) {
    mean /= length;
  } else {
    mean =
        field.normals[ray(0)];  // normals that cancel: any axis serves, the spread says how little it tells
  }
  int least = 0;
  mean.cwiseAbs().minCoeff(&least);
  const Vec3 e1 = mean.cross(Vec3::Unit(least)).normalized();
  tile.origin = field.points[ray(0)];
  tile.frame.row(0) = e1;
  tile.frame.row(1) = mean.cross(e1);
  tile.frame.row(2) = mean;
  for (uint32_t n = 0; n < tile.count; ++n) {
    const Vec3 local = tile.frame * (field.points[ray(n)] - tile.origin);
    tile.low = tile.low.cwiseMin(local);
    tile.high = tile.high.cwiseMax(local);
    tile.normal_spread = std::max(tile.normal_spread, (field.normals[ray(n)] - mean).norm());
  }
  field.tiles.push_back(tile);
}

}  // namespace swarf::stock
