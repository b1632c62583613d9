#include "collision/containment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "base/parallel.h"

namespace swarf::collision {
namespace {

bool holds_shell(const Body& outer, const Body& inner, const Pose& inner_in_outer) {
  if (!outer.closed) return false;
  for (const Vec3& point : inner.shells) {
    if (holds_point(outer, inner_in_outer * point)) return true;
  }
  return false;
}

/// The triangles as a mesh.
TriMesh mesh_of(const std::vector<Triangle>& triangles) {
  TriMesh mesh;
  for (const Triangle& triangle : triangles) {
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (const Vec3& p : triangle) {
      mesh.positions.push_back(
          {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/// Depth in a convex profile, where `inside` tells how far a point lies behind the side through `corner` with
/// the normal `outward` (rho, z): the least of its sides, bottom and top; below 0 outside.
template <class Inside>
double least_of_sides(const RevolvedSolid& solid, const Inside& inside) {
  double depth =
      std::min(inside(Vec2(0.0, -1.0), solid.corners.front()), inside(Vec2(0.0, 1.0), solid.corners.back()));
  for (size_t i = 0; i + 1 < solid.corners.size(); ++i) {
    const Vec2 along = solid.corners[i + 1] - solid.corners[i];
    if (along.norm() > 0.0)
      depth = std::min(depth, inside(Vec2(along.y(), -along.x()).normalized(), solid.corners[i]));
  }
  return depth;
}

double depth_in_solid(const RevolvedSolid& solid, const Vec3& point) {
  const double z = (point - solid.foot).dot(solid.axis);
  const double rho = (point - solid.foot - z * solid.axis).norm();
  return least_of_sides(
      solid, [&](const Vec2& outward, const Vec2& corner) { return outward.dot(corner - Vec2(rho, z)); });
}

/// Of every place of the points' hull: beside a plane that touches the side where `middle` is nearest to it.
double hull_depth_in_solid(const RevolvedSolid& solid, const Vec3& middle, std::span<const Vec3> points) {
  const Vec3 across = (middle - solid.foot) - (middle - solid.foot).dot(solid.axis) * solid.axis;
  const Vec3 radial = across.norm() > 0.0 ? Vec3(across.normalized()) : solid.axis.unitOrthogonal();
  return least_of_sides(solid, [&](const Vec2& outward, const Vec2& corner) {
    double most = -std::numeric_limits<double>::infinity();
    for (const Vec3& point : points) {
      const Vec2 at((point - solid.foot).dot(radial), (point - solid.foot).dot(solid.axis));
      most = std::max(most, outward.dot(corner - at));
    }
    return most;
  });
}

}  // namespace

bool one_holds_other(const Encounter& pair, const AxisValues& q) {
  return holds_shell(*pair.a, *pair.b, pair.b_from_a.pose(q)) ||
         holds_shell(*pair.b, *pair.a, pair.a_from_b.pose(q));
}

namespace {
constexpr double kRoundingMm = 1e-5;  // of float positions
}

struct BodyDepth::Surface {
  std::once_flag once;
  std::unique_ptr<mesh::SignedDistance> distance;  ///< null: an open mesh, or none
  bool convex = false;
};

namespace {

std::unique_ptr<mesh::SignedDistance> surface_of(const Body& body) {
  const auto has_area = [](const Triangle& t) { return (t[1] - t[0]).cross(t[2] - t[0]).norm() > 0.0; };
  if (!body.closed || std::none_of(body.triangles.begin(), body.triangles.end(), has_area)) return nullptr;
  return std::make_unique<mesh::SignedDistance>(mesh_of(body.triangles));
}

/// No corner lies before a facet by more than the rounding of float positions. Large meshes are not asked.
bool is_convex(const mesh::SignedDistance& surface) {
  constexpr size_t kMostFacets = 256;
  const TriMesh& mesh = surface.mesh();
  if (mesh.triangles.size() > kMostFacets) return false;
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 at = surface.corner(t, 0);
    for (const auto& p : mesh.positions)
      if (surface.face_normal(t).dot(Vec3(p[0], p[1], p[2]) - at) > kRoundingMm) return false;
  }
  return true;
}

/// Of a convex mesh: no place of the points' hull lies deeper than its points behind any one facet's plane.
double behind_all_planes(const mesh::SignedDistance& surface, std::span<const Vec3> points) {
  double least = std::numeric_limits<double>::infinity();
  for (uint32_t t = 0; t < surface.mesh().triangles.size(); ++t) {
    const Vec3 at = surface.corner(t, 0), &normal = surface.face_normal(t);
    double behind = -std::numeric_limits<double>::infinity();
    for (const Vec3& point : points) behind = std::max(behind, normal.dot(at - point));
    least = std::min(least, behind);
  }
  return least + kRoundingMm;
}

}  // namespace

BodyDepth::BodyDepth(const Body& body) : body_(&body), surface_(std::make_shared<Surface>()) {}

double BodyDepth::depth(const Vec3& point) const {
  if (body_->nodes.empty()) return 0.0;
  const BodyNode& root = body_->nodes.front();
  if (((point - root.centre).cwiseAbs() - root.half).maxCoeff() > 0.0) return 0.0;
  return std::max(0.0, signed_depth(point));
}

const mesh::SignedDistance* BodyDepth::surface() const {
  // Isolated: while its tree is built in parallel, this thread takes up no other pair that would wait for it.
  std::call_once(surface_->once, [&] {
    isolated([&] { surface_->distance = surface_of(*body_); });
    surface_->convex = surface_->distance != nullptr && is_convex(*surface_->distance);
  });
  return surface_->distance.get();
}

double BodyDepth::signed_depth(const Vec3& point) const {
  constexpr double kNowhere = -std::numeric_limits<double>::infinity();
  if (body_->nodes.empty()) return kNowhere;
  const BodyNode& root = body_->nodes.front();
  const double beyond = ((point - root.centre).cwiseAbs() - root.half).maxCoeff();
  if (beyond > 0.0) return -beyond;
  double depth = kNowhere;
  for (const RevolvedSolid& solid : body_->solids) depth = std::max(depth, depth_in_solid(solid, point));
  if (const mesh::SignedDistance* const distance = surface())
    depth = std::max(depth, -distance->at(point).distance_mm);
  return depth;
}

double BodyDepth::hull_bound(const Vec3& middle, std::span<const Vec3> points) const {
  double bound = -std::numeric_limits<double>::infinity();
  for (const RevolvedSolid& solid : body_->solids)
    bound = std::max(bound, hull_depth_in_solid(solid, middle, points));
  const mesh::SignedDistance* const distance = surface();
  if (distance == nullptr) return bound;
  if (surface_->convex) return std::max(bound, behind_all_planes(*distance, points));
  const uint32_t facet = distance->at(middle).triangle;
  for (const Vec3& point : points) {
    const Vec3 foot = mesh::closest_point_on_triangle(point, distance->corner(facet, 0),
                                                      distance->corner(facet, 1), distance->corner(facet, 2));
    bound = std::max(bound, (point - foot).norm());
  }
  return bound;
}

}  // namespace swarf::collision
