// Exact distance from points to a triangle mesh.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/frames.h"
#include "mesh/tri_mesh.h"

namespace swarf::mesh {

/// Nearest point of the triangle (a, b, c) to `p`, by the Voronoi regions of its features
/// (Ericson, Real-Time Collision Detection, 5.1.5). A degenerate triangle acts as its edges.
Vec3 closest_point_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// The point of a mesh that lies nearest to a given one.
struct NearestPoint {
  Vec3 point = Vec3::Zero();
  double distance_mm = 0.0;  ///< +infinity for a mesh without triangles
  uint32_t triangle = 0;
};

/// A bounding-volume tree over the triangles of a mesh, which is borrowed and must outlive it.
class MeshDistance {
 public:
  explicit MeshDistance(const TriMesh& mesh);

  NearestPoint nearest(const Vec3& p) const;

 private:
  struct Node {
    Eigen::Vector3f lower, upper;
    uint32_t first =
        0;  ///< leaf: first triangle in order_; inner: index of the right child, the left one follows
    uint32_t count = 0;  ///< 0: inner node
  };
  void build(uint32_t begin, uint32_t end, const std::vector<Eigen::Vector3f>& centres);
  void grow(Node& node, uint32_t begin, uint32_t end) const;
  void search_leaf(const Node& leaf, const Vec3& p, double& best, NearestPoint& nearest) const;
  Vec3 vertex(uint32_t triangle, int corner) const;

  const TriMesh& mesh_;
  std::vector<uint32_t> order_;
  std::vector<Node> nodes_;
};

/// The largest distance from any of the points to the mesh, mm; 0 for no points. Parallel.
double max_distance(std::span<const std::array<float, 3>> points, const TriMesh& mesh);

}  // namespace swarf::mesh
