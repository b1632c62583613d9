#include "stock/ray_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace swarf::stock {
namespace {

Foot foot_on_surface(const surface::Surface& surface, double u, double v) {
  const surface::Derivatives d = surface.derivatives(u, v);
  return {d.S, surface::outward_normal(surface, d), u, v};
}

/// (u,v) of a ray displaced by a tangent vector: the normal equations of Su du + Sv dv = tangent.
Vec2 parameters_along(const surface::Derivatives& d, const Vec3& tangent) {
  const double E = d.Su.squaredNorm(), F = d.Su.dot(d.Sv), G = d.Sv.squaredNorm();
  const double a = d.Su.dot(tangent), b = d.Sv.dot(tangent);
  const double det = E * G - F * F;
  return {(G * a - F * b) / det, (E * b - F * a) / det};
}

/// Where the line `point` + s `along` meets one triangle of the field, with the normal in between.
std::optional<Foot> foot_on_triangle(const RayField& field, uint32_t triangle, const Vec3& point,
                                     const Vec3& along) {
  constexpr double kOnEdge = 1e-9;  // share of the triangle: a line through an edge meets one of its sides
  const auto& t = field.triangles[triangle];
  const Vec3 &a = field.points[t[0]], ab = field.points[t[1]] - a, ac = field.points[t[2]] - a;
  const Vec3 h = along.cross(ac);
  const double det = ab.dot(h);
  if (!(std::abs(det) > std::numeric_limits<double>::min())) return std::nullopt;
  const Vec3 offset = point - a;
  const double wb = offset.dot(h) / det, wc = along.dot(offset.cross(ab)) / det;
  if (!(wb >= -kOnEdge && wc >= -kOnEdge && wb + wc <= 1.0 + kOnEdge)) return std::nullopt;
  const Vec3 normal =
      (1.0 - wb - wc) * field.normals[t[0]] + wb * field.normals[t[1]] + wc * field.normals[t[2]];
  return Foot{a + wb * ab + wc * ac, normal.normalized()};
}

}  // namespace

Foot RayField::between(uint32_t a, uint32_t b, double t) const {
  if (surface == nullptr) {
    return {points[a] + t * (points[b] - points[a]),
            (normals[a] + t * (normals[b] - normals[a])).normalized()};
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
  const Vec3 start = points[ray] + tangent_mm;
  std::optional<Foot> nearest;
  double least = std::numeric_limits<double>::infinity();
  const auto look_at = [&](uint32_t triangle) {
    const auto foot = foot_on_triangle(*this, triangle, start, normals[ray]);
    if (!foot || (foot->point - start).squaredNorm() >= least) return;
    least = (foot->point - start).squaredNorm();
    nearest = foot;
  };
  for (uint32_t i = star_begin[ray]; i < star_begin[ray + 1]; ++i) {
    for (const uint32_t corner : triangles[star[i]]) {
      for (uint32_t k = star_begin[corner]; k < star_begin[corner + 1]; ++k) look_at(star[k]);
    }
  }
  return nearest;
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
