// Where a line passes the facets of a mesh, in double precision.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/frames.h"
#include "mesh/tri_mesh.h"

namespace swarf::mesh {

/// A tree of boxes over the facets, which are copied.
class MeshLines {
 public:
  explicit MeshLines(const TriMesh& mesh);

  /// Appends the s of every facet that the line point + s way (of length 1) passes, in no order; a facet is
  /// made larger by a billionth of its size, so that no line slips through between two of them. Facets along
  /// the line are left out: those beside them tell.
  void add_hits(const Vec3& point, const Vec3& way, std::vector<double>& hits) const;

  /// How often the mesh, which must be closed, winds around the point: a whole number but for rounding unless
  /// the point lies on it. A ray counts what it leaves less what it enters; where it passes an edge within
  /// rounding another is sent, and after three the solid angles of all facets are summed.
  double winding(const Vec3& point) const;

 private:
  struct Node {
    Box box;
    uint32_t begin, end;  ///< of facets_
    uint32_t second;      ///< child; the first one follows the node. 0: a leaf
  };
  struct Facet {
    Vec3 a, ab, ac;
  };
  uint32_t build(uint32_t begin, uint32_t end);
  /// Calls visit(facet) for all that the line may pass, until it returns false.
  template <typename Visit>
  void each_along(const Vec3& point, const Vec3& way, const Visit& visit) const;

  std::vector<Facet> facets_;
  std::vector<Node> nodes_;
};

}  // namespace swarf::mesh
