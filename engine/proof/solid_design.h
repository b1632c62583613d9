// The design as a closed body of facets, with the places outside it sorted by the feature they are nearest
// to.
//
// Every point outside the body has a nearest point on it: inside a facet, on an edge or at a vertex. The
// points whose nearest one is the same feature lie in a prism over the facet, in a wedge between the normals
// of the edge's two facets, or in the normal cone of the vertex. Only edges and vertices that stand out of
// the body have such regions. So the prisms, wedges and cones of all features hold every point outside the
// body.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/frames.h"
#include "mesh/signed_distance.h"
#include "mesh/tri_mesh.h"

namespace swarf::proof {

/// The region over one feature: points p + s m, with p in the hull of `feet` and m in the hull of `ways`.
struct FeatureCell {
  std::vector<Vec3> feet;  ///< a facet's three corners, an edge's two ends, a vertex; W, mm
  std::vector<Vec3> ways;  ///< unit; a facet's normal, two normals, three normals
};

class SolidDesign {
 public:
  /// `chord_mm`: no place of the true design is farther from the facets, and none of the facets from it.
  SolidDesign(const TriMesh& mesh, double chord_mm);
  ~SolidDesign();
  SolidDesign(const SolidDesign&) = delete;
  SolidDesign& operator=(const SolidDesign&) = delete;

  const mesh::SignedDistance& distance() const { return distance_; }
  double chord_mm() const { return chord_mm_; }
  size_t facets() const { return distance_.mesh().triangles.size(); }
  /// Appends the facets whose boxes meet `box`, in rising order.
  void find(const Box& box, std::vector<uint32_t>& found) const;
  /// The regions of all features, wedges and cones divided until their ways turn by no more than kMostTurn.
  std::vector<FeatureCell> cells() const;
  static constexpr double kMostTurn = 0.4;  ///< rad

 private:
  struct Tree;
  mesh::SignedDistance distance_;
  double chord_mm_;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace swarf::proof
