#include "collision/body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/disjoint_sets.h"
#include "base/parallel.h"
#include "collision/winding.h"
#include "mesh/mesh_check.h"

namespace swarf::collision {
namespace {

struct Leaf {
  Box box;
  uint32_t primitive;
};

BodyNode node_of(const Box& box) {
  BodyNode node;
  node.centre = box.centre();
  node.half = 0.5 * box.size();
  // What the halving of the box may have rounded away.
  node.half.array() += 4e-16 * (node.centre.cwiseAbs() + node.half).maxCoeff();
  node.radius = node.half.norm();
  return node;
}

Box box_of(std::span<const Leaf> leaves) {
  Box box = leaves.front().box;
  for (const Leaf& leaf : leaves) {
    box.lower = box.lower.cwiseMin(leaf.box.lower);
    box.upper = box.upper.cwiseMax(leaf.box.upper);
  }
  return box;
}

/// Halves the leaves at the middle of their centres along the longest side of their box.
size_t halve_leaves(std::span<Leaf> leaves) {
  Box centres{leaves.front().box.centre(), leaves.front().box.centre()};
  for (const Leaf& leaf : leaves) {
    centres.lower = centres.lower.cwiseMin(leaf.box.centre());
    centres.upper = centres.upper.cwiseMax(leaf.box.centre());
  }
  int axis = 0;
  centres.size().maxCoeff(&axis);
  const size_t middle = leaves.size() / 2;
  const auto before = [axis](const Leaf& a, const Leaf& b) {
    const double one = a.box.lower[axis] + a.box.upper[axis], other = b.box.lower[axis] + b.box.upper[axis];
    return one != other ? one < other : a.primitive < b.primitive;
  };
  std::nth_element(leaves.begin(), leaves.begin() + static_cast<ptrdiff_t>(middle), leaves.end(), before);
  return middle;
}

void grow_tree(std::vector<BodyNode>& nodes, size_t at, std::span<Leaf> leaves) {
  nodes[at] = node_of(box_of(leaves));
  if (leaves.size() == 1) {
    nodes[at].primitive = leaves.front().primitive;
    return;
  }
  const size_t middle = halve_leaves(leaves), child = nodes.size();
  nodes[at].child = static_cast<int32_t>(child);
  nodes.resize(child + 2);
  grow_tree(nodes, child, leaves.first(middle));
  grow_tree(nodes, child + 1, leaves.subspan(middle));
}

void make_tree(Body& body) {
  std::vector<Leaf> leaves;
  for (const Triangle& triangle : body.triangles) {
    leaves.push_back({bounds(triangle), static_cast<uint32_t>(leaves.size())});
  }
  for (const RevolvedSolid& solid : body.solids) {
    leaves.push_back({bounds(solid), static_cast<uint32_t>(leaves.size())});
  }
  if (leaves.empty()) return;
  body.nodes.reserve(2 * leaves.size());
  body.nodes.resize(1);
  grow_tree(body.nodes, 0, leaves);
}

Vec3 position(const TriMesh& mesh, uint32_t vertex) {
  const auto& p = mesh.positions[vertex];
  return {p[0], p[1], p[2]};
}

void check_body_mesh(const std::string& name, const TriMesh& mesh) {
  for (const auto& triangle : mesh.triangles) {
    for (const uint32_t vertex : triangle) {
      if (vertex >= mesh.positions.size()) {
        throw InputError(
            "body-index", {},
            fmt::format("{}: a triangle names vertex {} of {}", name, vertex, mesh.positions.size()),
            "give a mesh whose triangles name vertices that are there");
      }
      if (!position(mesh, vertex).allFinite()) {
        throw InputError("body-not-finite", {},
                         fmt::format("{}: vertex {} is not a finite number", name, vertex),
                         "give a mesh with finite positions in mm");
      }
    }
  }
}

void check_solid(const std::string& name, const RevolvedSolid& solid) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(
        "body-bad-profile", {}, fmt::format("{}: {}", name, why),
        "give corners (radius, height) in mm from the lowest to the highest, around a unit axis");
  };
  if (solid.corners.empty()) refuse("a solid of revolution without corners");
  if (!solid.foot.allFinite() || !(std::abs(solid.axis.norm() - 1.0) <= 1e-9)) {
    refuse("its foot or axis is not finite, or the axis not of length 1");
  }
  double height = -INFINITY;
  for (const Vec2& corner : solid.corners) {
    const bool good = corner.allFinite() && corner.x() >= 0.0 && corner.y() >= height;
    if (!good) refuse(fmt::format("corner ({}, {}) of a solid of revolution", corner.x(), corner.y()));
    height = corner.y();
  }
}

/// One corner of each part whose triangles hang together.
std::vector<Vec3> points_of_shells(const TriMesh& mesh) {
  const std::vector<uint32_t> number = mesh::position_numbers(mesh.positions);
  DisjointSets sets(mesh.positions.size());
  for (const auto& t : mesh.triangles) {
    sets.join(number[t[0]], number[t[1]]);
    sets.join(number[t[0]], number[t[2]]);
  }
  std::vector<Vec3> points;
  std::vector<uint8_t> seen(mesh.positions.size(), 0);
  for (const auto& t : mesh.triangles) {
    uint8_t& known = seen[sets.root(number[t[0]])];
    if (known == 0) points.push_back(position(mesh, t[0]));
    known = 1;
  }
  return points;
}

bool in_solid(const RevolvedSolid& solid, const Vec3& point) {
  const double z = (point - solid.foot).dot(solid.axis);
  const double rho = (point - solid.foot - z * solid.axis).norm();
  // The profile is the hull of its corners and of their feet on the axis; support in each direction of the
  // half plane would do, a walk over the corners by height is exact for frustums in order of height.
  for (size_t i = 0; i + 1 < solid.corners.size(); ++i) {
    const Vec2 &low = solid.corners[i], &high = solid.corners[i + 1];
    if (z < low.y() || z > high.y() || high.y() <= low.y()) continue;
    const double share = (z - low.y()) / (high.y() - low.y());
    if (rho <= low.x() + share * (high.x() - low.x())) return true;
  }
  return false;
}

}  // namespace

Body mesh_body(std::string name, BodyKind kind, int link, const TriMesh& mesh, const Pose& placed) {
  check_body_mesh(name, mesh);
  Body body;
  body.name = std::move(name);
  body.kind = kind;
  body.link = link;
  body.closed = !mesh.triangles.empty() && mesh::check_closed(mesh).empty();
  const auto corner = [&](uint32_t vertex) -> Vec3 { return placed * position(mesh, vertex); };
  for (const auto& t : mesh.triangles) body.triangles.push_back({corner(t[0]), corner(t[1]), corner(t[2])});
  for (const Vec3& point : points_of_shells(mesh)) body.shells.push_back(placed * point);
  make_tree(body);
  return body;
}

Body solid_body(std::string name, BodyKind kind, int link, std::vector<RevolvedSolid> solids_M) {
  for (const RevolvedSolid& solid : solids_M) check_solid(name, solid);
  Body body;
  body.name = std::move(name);
  body.kind = kind;
  body.link = link;
  body.closed = true;
  body.solids = std::move(solids_M);
  for (const RevolvedSolid& solid : body.solids) {
    body.shells.push_back(solid.foot + solid.corners.front().y() * solid.axis);
  }
  make_tree(body);
  return body;
}

std::vector<Body> link_bodies(const machine::MachineScene& scene, const std::function<bool(int)>& wanted) {
  std::vector<int> links;
  for (size_t i = 0; i < scene.links.size(); ++i) {
    const auto link = static_cast<int>(i);
    if (!scene.links[i].mesh.triangles.empty() && (!wanted || wanted(link))) links.push_back(link);
  }
  std::vector<Body> bodies(links.size());
  parallel_chunks(links.size(), 1, [&](size_t i, size_t) {
    const machine::Link& link = scene.links[static_cast<size_t>(links[i])];
    bodies[i] = mesh_body(link.name, BodyKind::kLink, links[i], link.mesh);
  });
  return bodies;
}

Body work_body(const machine::MachineScene& scene, std::string name, BodyKind kind, const TriMesh& mesh_W) {
  return mesh_body(std::move(name), kind, scene.work_link, mesh_W, scene.model.X_MW);
}

Body tool_body(const machine::MachineScene& scene, const kinematics::MachineModel& with_tool,
               std::string name, std::span<const ToolFrustum> frustums) {
  std::vector<RevolvedSolid> solids;
  for (const ToolFrustum& part : frustums) {
    solids.push_back(frustum(with_tool.tip_M, with_tool.tool_axis_M, part.low, part.high, part.low_radius,
                             part.high_radius));
  }
  return solid_body(std::move(name), BodyKind::kToolPart, scene.tool_link, std::move(solids));
}

bool holds_point(const Body& body, const Vec3& point) {
  for (const RevolvedSolid& solid : body.solids) {
    if (in_solid(solid, point)) return true;
  }
  if (!body.closed || body.nodes.empty()) return false;
  const BodyNode& root = body.nodes.front();
  if (((point - root.centre).cwiseAbs() - root.half).maxCoeff() > 0.0) return false;
  return winding_number(body, point) > 0.5;
}

}  // namespace swarf::collision
