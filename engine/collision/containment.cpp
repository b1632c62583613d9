#include "collision/containment.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "base/parallel.h"
#include "base/units.h"

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

/// Depth in a convex profile: to the nearest of its sides, bottom and top. 0 outside.
double depth_in_solid(const RevolvedSolid& solid, const Vec3& point) {
  const double z = (point - solid.foot).dot(solid.axis);
  const double rho = (point - solid.foot - z * solid.axis).norm();
  double depth = std::min(z - solid.corners.front().y(), solid.corners.back().y() - z);
  for (size_t i = 0; i + 1 < solid.corners.size(); ++i) {
    const Vec2 along = solid.corners[i + 1] - solid.corners[i];
    const Vec2 outward = Vec2(along.y(), -along.x()).normalized();
    if (along.norm() > 0.0) depth = std::min(depth, outward.dot(solid.corners[i] - Vec2(rho, z)));
  }
  return std::max(0.0, depth);
}

template <class Visit>
void each_corner(const Body& body, const Visit& visit) {
  for (const Triangle& triangle : body.triangles) {
    for (const Vec3& point : triangle) visit(point);
  }
  for (const RevolvedSolid& solid : body.solids) {
    const Vec3 x = solid.axis.unitOrthogonal(), y = solid.axis.cross(x);
    for (const Vec2& corner : solid.corners) {
      for (int i = 0; i < 8; ++i) {
        const double turn = 0.25 * kPi * i;
        visit(solid.foot + corner.y() * solid.axis + corner.x() * (std::cos(turn) * x + std::sin(turn) * y));
      }
    }
  }
}

}  // namespace

bool one_holds_other(const Encounter& pair, const AxisValues& q) {
  return holds_shell(*pair.a, *pair.b, pair.b_from_a.pose(q)) ||
         holds_shell(*pair.b, *pair.a, pair.a_from_b.pose(q));
}

struct BodyDepth::Surface {
  std::once_flag once;
  std::unique_ptr<mesh::SignedDistance> distance;  ///< null: an open mesh, or none
};

namespace {

std::unique_ptr<mesh::SignedDistance> surface_of(const Body& body) {
  const auto has_area = [](const Triangle& t) { return (t[1] - t[0]).cross(t[2] - t[0]).norm() > 0.0; };
  if (!body.closed || std::none_of(body.triangles.begin(), body.triangles.end(), has_area)) return nullptr;
  return std::make_unique<mesh::SignedDistance>(mesh_of(body.triangles));
}

}  // namespace

BodyDepth::BodyDepth(const Body& body) : body_(&body), surface_(std::make_shared<Surface>()) {}

double BodyDepth::depth(const Vec3& point) const {
  Looked nothing;
  return depth_beyond(-1.0, point, nothing);
}

double BodyDepth::depth_beyond(double least, const Vec3& point, Looked& last) const {
  if (body_->nodes.empty()) return 0.0;
  const BodyNode& root = body_->nodes.front();
  const double in_box = (root.half - (point - root.centre).cwiseAbs()).minCoeff();
  if (in_box < 0.0 || in_box <= least) return 0.0;
  double depth = 0.0;
  for (const RevolvedSolid& solid : body_->solids) depth = std::max(depth, depth_in_solid(solid, point));
  if (last.to_surface_mm + (point - last.point).norm() <= std::max(least, depth)) return depth;
  // Isolated: while its tree is built in parallel, this thread takes up no other pair that would wait for it.
  std::call_once(surface_->once, [&] { isolated([&] { surface_->distance = surface_of(*body_); }); });
  if (surface_->distance == nullptr) return depth;
  const double distance = surface_->distance->at(point).distance_mm;
  last = {point, std::abs(distance)};
  return std::max(depth, -distance);
}

Depth overlap_depth(const Encounter& pair, const BodyDepth& in_a, const BodyDepth& in_b, const AxisValues& q,
                    double least) {
  Depth deepest{least, Vec3::Zero()};
  bool found = false;
  const auto look = [&](const Body& corners_of, const BodyDepth& in, const Pose& carried, int link) {
    BodyDepth::Looked last;
    each_corner(corners_of, [&](const Vec3& corner) {
      const Vec3 point = carried * corner;
      const double depth = in.depth_beyond(deepest.depth_mm, point, last);
      if (depth <= deepest.depth_mm) return;
      deepest = {depth, link_pose(*pair.scene, link, q) * point};
      found = true;
    });
  };
  look(*pair.b, in_a, pair.b_from_a.pose(q), pair.a->link);
  look(*pair.a, in_b, pair.a_from_b.pose(q), pair.b->link);
  return found ? deepest : Depth{};
}

}  // namespace swarf::collision
