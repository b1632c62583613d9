// Exact distance from points to a triangle mesh.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "base/frames.h"
#include "mesh/tri_mesh.h"

namespace swarf::mesh {

/// Where on a triangle (a, b, c) a point lies.
enum class Feature : uint8_t { kFace, kEdgeAB, kEdgeBC, kEdgeCA, kA, kB, kC };

/// Nearest point of the triangle (a, b, c) to `p`, by the Voronoi regions of its features
/// (Ericson, Real-Time Collision Detection, 5.1.5). A degenerate triangle acts as its edges. `feature` (may
/// be null) receives where it lies.
Vec3 closest_point_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c,
                               Feature* feature = nullptr);

/// The point of a mesh that lies nearest to a given one.
struct NearestPoint {
  Vec3 point = Vec3::Zero();
  double distance_mm = 0.0;  ///< +infinity for a mesh without triangles
  uint32_t triangle = 0;     ///< of several the one with the least index
  Feature feature = Feature::kFace;
};

/// Distances to the triangles of a mesh, which is borrowed and must outlive it. Embree's tree finds the
/// candidates in single precision, with a radius that is wider by its rounding; the distances themselves are
/// double, so results are those of a loop over all triangles.
class MeshDistance {
 public:
  explicit MeshDistance(const TriMesh& mesh);
  ~MeshDistance();
  MeshDistance(const MeshDistance&) = delete;
  MeshDistance& operator=(const MeshDistance&) = delete;

  /// The nearest point no farther than `within_mm` (a good guess makes the search short); without one its
  /// distance is +infinity.
  NearestPoint nearest(const Vec3& p, double within_mm = std::numeric_limits<double>::infinity()) const;

  /// Calls visit(triangle) for every triangle that may lie within `radius_mm` of p, in no particular order:
  /// all that do, and some that are a little farther.
  void each_near(const Vec3& p, double radius_mm, const std::function<void(uint32_t)>& visit) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

/// From each of the points to the mesh, mm. Parallel.
std::vector<double> distances(std::span<const std::array<float, 3>> points, const TriMesh& mesh);

}  // namespace swarf::mesh
